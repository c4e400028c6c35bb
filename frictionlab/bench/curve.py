"""Curves of a bench: error and time per point of every method and peer, a row for each setting."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np
import pandas as pd
from pydantic import AfterValidator, model_validator

from frictionlab.bench.blocks import Block, refuse_other_sweeps
from frictionlab.bench.charts import curve_figure
from frictionlab.bench.contenders import Contender, Reference, Setting
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.result import SectionResult, Tell
from frictionlab.bench.solve import first_run, known_means, solve_points, time_task, whole_task
from frictionlab.bench.texts import curve_summary
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method, ReducedModel
from frictionlab.scene.scene import Scene
from frictionlab.study.study import Study
from frictionlab.values.quantities import Floats

STATUSES = ("ok", "refused", "failed", "not_unique")
ANSWERED = ("ok", "not_unique")
"""Points that are worth timing."""
CAPTION = (
    "Lower is nearer the reference, further left is cheaper: read what each error costs along a level line."
)


def _of_a_file(name: str) -> str:
    if not re.fullmatch(r"\w[\w.-]*", name):
        raise ValueError("names a file: use letters, digits, points, - and _")
    return name


class CurveBlock(Block):
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
    references: tuple[Reference, ...]
    repeats: int
    seconds: float

    @property
    def speeds(self) -> list[float]:
        """The belt speeds."""
        return [scene.belt_speed for scene in self.scenes]

    def known(self) -> list[tuple[Reference, pd.DataFrame]]:
        """Every reference with what it knows of each point."""
        return [(each, known_means(each, self.scenes, self.law)) for each in self.references]


def workloads(
    study: Study, references: tuple[Reference, ...], repeats: int, seconds: float
) -> Iterator[tuple[str, Workload]]:
    """The curve of each law, by its label."""
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
            rows.append(measured_row(self.work, known, contender, setting, first))
        law = "coulomb" if self.work.law.constant_sliding_friction() else type(self.work.law).__name__
        table = pd.DataFrame([{"scene": self.name, "law": law.lower()} | row for row in rows])
        return SectionResult(
            self.name,
            self.title,
            table.astype({"covered": "Int64"}),
            curve_summary(self.name, table),
            partial(curve_figure, f"{self.name}: {self.title}".removesuffix(": "), table, least_known(known)),
            CAPTION,
            "curve",
            [self._span(), *_reference_lines(known, table)],
            missing,
        )

    def _span(self) -> str:
        speeds = self.work.speeds
        return f"{len(speeds)} belt speeds from {speeds[0]:g} to {speeds[-1]:g}."


def least_known(known: Sequence[tuple[Reference, pd.DataFrame]]) -> float:
    """The largest error of any reference, NaN without one."""
    return float(pd.concat([found["error"] for _, found in known]).max())


def _reference_lines(known: Sequence[tuple[Reference, pd.DataFrame]], table: pd.DataFrame) -> list[str]:
    """Who is measured against what, how well that is known, and how far the references are apart."""
    lines = []
    for reference, found in known:
        users = table.loc[table["reference"] == reference.label, "solver"].unique()
        if len(users):
            error = found["error"].max()
            lines.append(f"Reference of {', '.join(users)}: {reference.label}, known to {error:.1e}.")
    for i, (one, found) in enumerate(known):
        for other, before in known[:i]:
            apart = (found["mean"] - before["mean"]).abs().max()
            lines.append(f"{other.label} and {one.label} differ by at most {apart:.1e}.")
    return lines


def chosen(size: int, points: int | None) -> list[int]:
    """So many places, spread evenly from the first to the last."""
    if points is None or points >= size:
        return list(range(size))
    return sorted({round(place) for place in np.linspace(0, size - 1, points).tolist()})


def measured_row(
    work: Workload,
    known: Sequence[tuple[Reference, pd.DataFrame]],
    contender: Contender,
    setting: Setting,
    first: bool = False,
) -> dict[str, Any]:
    """A row of a table: errors against the first reference of another kind that knows a point, times [us] a point."""
    solver, places = setting.solver, chosen(len(work.scenes), contender.points)
    scenes = [work.scenes[place] for place in places]
    found = solve_points(solver, scenes, work.law, setting.tolerance)
    others = [(each, values) for each, values in known if each.kind != contender.kind]
    trusted = next((each for each in others if each[1]["mean"][places].notna().any()), None)
    counts = Counter(found["status"])
    row = {
        "solver": contender.label,
        "side": contender.side,
        "quantity": setting.quantity,
        "value": setting.value,
        "points": len(places),
        **{status: counts[status] for status in STATUSES},
        **_errors(found, None if trusted is None else trusted[1].loc[places].reset_index(), contender.side),
        **_prices(
            work,
            [scene for scene, told in zip(scenes, found["status"], strict=True) if told in ANSWERED],
            setting,
        ),
        "first_run_s": math.nan,
        "reference": trusted[0].label if trusted else "",
        "reference_error": trusted[1]["error"].max() if trusted else math.nan,
    }
    if first and row["ok"] and isinstance(solver, Method):
        row["first_run_s"] = first_run(solver, scenes, work.law, setting.tolerance)
    return row | {"reason": _reason(found, row)}


def _errors(found: pd.DataFrame, trusted: pd.DataFrame | None, side: str) -> dict[str, Any]:
    """Errors of the points that are ok and known to the reference; covered: of how many what is stated covers it."""
    stated, nothing = found["error"].max(), {"largest_error": math.nan, "median_error": math.nan}
    if trusted is None or not (good := (found["status"] == "ok") & trusted["mean"].notna()).any():
        return nothing | {"stated_error": stated, "covered": None}
    off = (found["mean"] - trusted["mean"]).abs()[good]
    covered = int((off <= (found["error"] + trusted["error"])[good]).sum())
    told = {"largest_error": off.max(), "median_error": off.median(), "stated_error": stated}
    return told | {"covered": covered if side == "method" else None}


def _reason(found: pd.DataFrame, row: dict[str, Any]) -> str:
    """The most frequent reason of a point without a number, or why there is no error."""
    reasons = Counter(found.loc[found["status"] != "ok", "reason"])
    if reasons:
        return str(reasons.most_common(1)[0][0])
    if row["largest_error"] == row["largest_error"]:
        return ""
    return "the reference has no value" if row["reference"] else "no independent reference"


def _prices(work: Workload, scenes: list[Scene], setting: Setting) -> dict[str, Any]:
    """Times per point [us]: of mean friction with its error, of every column, of a reduced model without its error.

    Of a peer the first two are the same. Of a prescribed slip a reduced model leaves nothing out.
    """
    solver, law, tolerance = setting.solver, work.law, setting.tolerance
    spent = dict.fromkeys(("mean", "all", "model"), np.array([]))

    def timed(task: Callable[[], object]) -> Floats:
        task()
        return time_task(task, work.repeats, work.seconds)

    if scenes:
        spent["mean"] = spent["all"] = time_task(
            lambda: solver.solve(scenes, law, tolerance), work.repeats, work.seconds
        )
        if not isinstance(solver, Peer):
            spent["all"] = timed(whole_task(solver, scenes, law, tolerance))
        if isinstance(solver, ReducedModel) and scenes[0].degrees_of_freedom > 0:
            spent["model"] = timed(lambda: solver.model_means(scenes, law))
    told = {
        key: each for name, times in spent.items() for key, each in times_of(name, times, len(scenes)).items()
    }
    return told | {"error_us": told["mean_us"] - told["model_us"]}


def times_of(name: str, spent: Floats, points: int) -> dict[str, float]:
    """Least time and quartiles per point [us], and how many times were taken."""
    least, *quartiles = np.percentile(spent, (0, 25, 50, 75)) / points if spent.size else [math.nan] * 4
    told = {f"{name}_us_q{i}": 1e6 * float(quartile) for i, quartile in enumerate(quartiles, 1)}
    return {f"{name}_us": 1e6 * float(least), **told, f"{name}_repeats": spent.size}
