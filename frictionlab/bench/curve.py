"""Curves of a bench: error and time per point of every method and peer, a row for each setting."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from typing import Annotated, Any

import numpy as np
import pandas as pd
from pydantic import AfterValidator, model_validator

from frictionlab.bench.blocks import BenchBlock, refuse_other_sweeps
from frictionlab.bench.charts import curve_figure
from frictionlab.bench.contenders import BenchSetting, Contender, ReferenceSource
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.result import SectionResult, Tell
from frictionlab.bench.solve import first_run, known_means, solve_points, time_task, whole_task
from frictionlab.bench.texts import curve_summary
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method, ReducedModel
from frictionlab.scene.scene import Scene
from frictionlab.study.study import Study
from frictionlab.values.quantities import Floats

KnownReferences = Sequence[tuple[ReferenceSource, pd.DataFrame]]
"""References with mean and error at each point."""
BENCH_STATUSES = ("ok", "refused", "failed", "not_unique")
ANSWERED = ("ok", "not_unique")
"""Points that are worth timing."""
CURVE_CAPTION = (
    "Lower is nearer the reference, further left is cheaper: read what each error costs along a level line."
)


def _of_a_file(name: str) -> str:
    if not re.fullmatch(r"\w[\w.-]*", name):
        raise ValueError("names a file: use letters, digits, points, - and _")
    return name


class CurveBlock(BenchBlock):
    """An item of ``scenes``."""

    name: Annotated[str, AfterValidator(_of_a_file)]

    @model_validator(mode="after")
    def _sweeps_belt_speeds(self) -> CurveBlock:
        refuse_other_sweeps(self.study)
        return self


@dataclass(frozen=True)
class Workload:
    """Scenes that differ in belt speed alone, in ascending order, and the references of their errors.

    repeats, seconds: how long each setting may be timed: so many times, or so long if that is less.
    """

    scenes: tuple[Scene, ...]
    law: FrictionLaw
    references: tuple[ReferenceSource, ...]
    repeats: int
    seconds: float

    @property
    def speeds(self) -> list[float]:
        """Return the belt speeds."""
        return [scene.belt_speed for scene in self.scenes]

    def known(self) -> KnownReferences:
        """Every reference with what it knows of each point."""
        return [(each, known_means(each, self.scenes, self.law)) for each in self.references]


def workloads(
    study: Study, references: tuple[ReferenceSource, ...], repeats: int, seconds: float
) -> Iterator[tuple[str, Workload]]:
    """Yield the curve of each law, by its label."""
    for along in study.curves():
        scenes = sorted(along.scenes, key=lambda scene: scene.belt_speed)
        yield along.law_label, Workload(tuple(scenes), along.law, references, repeats, seconds)


@dataclass(frozen=True)
class BenchCurve:
    """A workload with a name; first_runs: whether the first setting of each method is timed without kernels, too."""

    name: str
    title: str
    work: Workload
    contenders: tuple[Contender, ...]
    first_runs: bool = False

    def measure(self, tell: Tell) -> SectionResult:
        """Measure every contender that is installed, at every setting."""
        missing = {each.label: why for each in self.contenders if (why := each.missing())}
        cases = [(each, at) for each in self.contenders if each.label not in missing for at in each.settings]
        tell(f"{self.name}: references (1 of {len(cases) + 1})")
        known, rows = self.work.known(), list[dict[str, Any]]()
        for contender, setting in cases:
            tell(f"{self.name}: {contender.label}, {setting} ({len(rows) + 2} of {len(cases) + 1})")
            first = self.first_runs and setting is contender.settings[0]
            rows.append(self._named() | measured_row(self.work, known, contender, setting, first))
        table, speeds = pd.DataFrame(rows), self.work.speeds
        notes = [f"{len(speeds)} belt speeds from {speeds[0]:g} to {speeds[-1]:g}."]
        if rows:
            table, notes = table.astype({"covered": "Int64"}), notes + _reference_lines(known, table)
        title = f"{self.name}: {self.title}".removesuffix(": ")
        figure = partial(curve_figure, title, table, largest_error(known))
        said = curve_summary(self.name, table)
        drawn = SectionResult(self.name, self.title, table, said, figure, CURVE_CAPTION)
        return replace(drawn, kind="curve", notes=notes, left_out=missing)

    def _named(self) -> dict[str, str]:
        law = self.work.law
        kind = "coulomb" if law.constant_sliding_friction() else type(law).__name__.lower()
        return {"scene": self.name, "law": kind}


def largest_error(known: KnownReferences) -> float:
    """Return the largest error of any reference, NaN without one."""
    return float(pd.concat([found["error"] for _, found in known]).max())


def _reference_lines(known: KnownReferences, table: pd.DataFrame) -> list[str]:
    """Tell who is measured against what, how well that is known, and how far the references are apart."""
    lines = []
    for reference, found in known:
        if users := table["solver"][table["reference"] == reference.label].unique().tolist():
            told = f"{reference.label}, known to {found['error'].max():.1e}"
            lines.append(f"Reference of {', '.join(users)}: {told}.")
    for (other, before), (one, found) in combinations(known, 2):
        apart = (found["mean"] - before["mean"]).abs().max()
        lines.append(f"{other.label} and {one.label} differ by at most {apart:.1e}.")
    return lines


def chosen(size: int, points: int | None) -> list[int]:
    """So many places, spread evenly from the first to the last."""
    if points is None or points >= size:
        return list(range(size))
    return sorted({round(place) for place in np.linspace(0, size - 1, points).tolist()})


def measured_row(
    work: Workload, known: KnownReferences, contender: Contender, setting: BenchSetting, first: bool = False
) -> dict[str, Any]:
    """A row of a table: errors against the first reference of another kind that knows a point, times [us] a point."""
    solver, places = setting.solver, chosen(len(work.scenes), contender.points)
    scenes = [work.scenes[place] for place in places]
    found = solve_points(solver, scenes, work.law, setting.tolerance)
    trusted = found.assign(mean=math.nan, error=math.nan)
    label, known_to = "", math.nan
    for reference, values in known:
        if reference.kind != contender.kind and values["mean"][places].notna().any():
            label, known_to = reference.label, values["error"].max()
            trusted = values.loc[places].reset_index(drop=True)
            break
    answered = [scene for scene, told in zip(scenes, found["status"], strict=True) if told in ANSWERED]
    row = {
        **{"solver": contender.label, "side": contender.side},
        **{"quantity": setting.quantity, "value": setting.value, "points": len(places)},
        **{status: int((found["status"] == status).sum()) for status in BENCH_STATUSES},
        **_errors(found, trusted, contender.side),
        **_prices(work, answered, setting),
        **{"first_run_s": math.nan, "reference": label, "reference_error": known_to},
    }
    if first and row["ok"] and isinstance(solver, Method):
        row["first_run_s"] = first_run(solver, scenes, work.law, setting.tolerance)
    return row | {"reason": _reason(found, row)}


def _errors(found: pd.DataFrame, trusted: pd.DataFrame, side: str) -> dict[str, Any]:
    """Errors of the points that are ok and known to the reference; covered: of how many what is stated covers it."""
    off = (found["mean"] - trusted["mean"]).abs().where(found["status"] == "ok")
    told = {"largest_error": off.max(), "median_error": off.median(), "stated_error": found["error"].max()}
    covered = int((off <= found["error"] + trusted["error"]).sum())
    return told | {"covered": covered if side == "method" and off.notna().any() else None}


def _reason(found: pd.DataFrame, row: dict[str, Any]) -> str:
    """Return the most frequent reason of a point without a number, or why there is no error."""
    reasons = Counter(found.loc[found["status"] != "ok", "reason"])
    if reasons:
        return str(reasons.most_common(1)[0][0])
    if row["largest_error"] == row["largest_error"]:
        return ""
    return "the reference has no value" if row["reference"] else "no independent reference"


def _prices(work: Workload, scenes: list[Scene], setting: BenchSetting) -> dict[str, Any]:
    """Times per point [us]: of mean friction with its error, of every column, of a reduced model without its error.

    Of a peer the first two are the same. Of a prescribed slip a reduced model leaves nothing out.
    """
    solver, law = setting.solver, work.law

    def timed(task: Callable[[], object], warm: bool = False) -> Floats:
        if not warm:
            task()
        return time_task(task, work.repeats, work.seconds)

    mean = whole = model = np.array([])
    if scenes:
        mean = whole = timed(lambda: solver.solve(scenes, law, setting.tolerance), warm=True)
        if not isinstance(solver, Peer):
            whole = timed(whole_task(solver, scenes, law, setting.tolerance))
        if isinstance(solver, ReducedModel) and scenes[0].degrees_of_freedom > 0:
            model = timed(lambda: solver.model_means(scenes, law))
    points = len(scenes)
    told = times_of("mean", mean, points) | times_of("all", whole, points) | times_of("model", model, points)
    return told | {"error_us": told["mean_us"] - told["model_us"]}


def times_of(name: str, spent: Floats, points: int) -> dict[str, float]:
    """Least time and quartiles per point [us], and how many times were taken."""
    least, *quartiles = np.percentile(spent, (0, 25, 50, 75)) / points if spent.size else [math.nan] * 4
    told = {f"{name}_us_q{i}": 1e6 * float(quartile) for i, quartile in enumerate(quartiles, 1)}
    return {f"{name}_us": 1e6 * float(least), **told, f"{name}_repeats": spent.size}
