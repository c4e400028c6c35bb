"""Stability maps of a bench list: error of one stepper or peer over step, or tolerance, and local rate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np
import pandas as pd
from pydantic import Field

from frictionlab.bench.charts import LimitOfSteps, StabilityPicture, stability_figure
from frictionlab.bench.contenders import FILLED
from frictionlab.bench.result import SectionResult, Tell, one_of
from frictionlab.bench.stability_problems import PROBLEMS, StabilityProblem
from frictionlab.bench.stability_solvers import MAPPED_PEERS, MAPPED_STEPPERS, REGIONS, MappedSolver, MapPoint
from frictionlab.values.quantities import Record

STEPS, TOLERANCES, RATES = (8.0, 4096.0), (1e-9, 1e-1), (1.0, 1e3)
"""Ends of the grid."""
CAPTION = (
    "Colour is the true error of the mean friction at each step (or tolerance) and local rate; hatched: wrong, and "
    "told so (refused, failed, or within the error stated), crosses: wrong without a word; red: where the step taken "
    "times the rate is at (adaptive: near) its limit, dashed as predicted, dots as measured. Integrated: {what}."
)
COLUMNS = [
    *("problem", "setting", "value", "rate", "step", "step_times_rate", "predicted_limit", "measured_limit"),
    *("status", "error", "stated", "region", "reason"),
]


@dataclass(frozen=True)
class StabilitySection:
    """One stepper or peer on some problems, n settings by n rates."""

    mapped: MappedSolver
    problems: tuple[StabilityProblem, ...]
    grid: int

    @property
    def name(self) -> str:
        """That of its files."""
        return f"stability_{self.mapped.name}"

    def measure(self, tell: Tell) -> SectionResult:
        """Map every problem that it can take."""
        missing, maps = self.mapped.missing(), list[StabilityPicture]()
        for problem in () if missing else self.problems:
            if problem.name in self.mapped.problems:
                tell(f"{self.name}: {problem.name}")
                maps.append(self._map(problem))
        left_out = {} if maps else {self.name: missing or "takes none of these problems"}
        table = pd.concat([each.points for each in maps])[COLUMNS] if maps else pd.DataFrame()
        title = f"Stability of {self.mapped.name}"
        return SectionResult(
            self.name,
            title,
            table.replace([math.inf, -math.inf], math.nan),
            "\n".join([f"{self.name}, {line(each)}" for each in maps] or [": ".join(*left_out.items())]),
            partial(stability_figure, title, maps),
            CAPTION.format(what=self.mapped.integrated),
            left_out=left_out,
            style={"hatch.linewidth": 0.5, "savefig.dpi": 200},
        )

    def _map(self, problem: StabilityProblem) -> StabilityPicture:
        mapped, rates = self.mapped, np.geomspace(*RATES, self.grid)
        settings = np.geomspace(*(STEPS if mapped.setting == "steps" else TOLERANCES), self.grid)
        if mapped.setting == "steps":  # each once
            settings = np.unique(np.round(settings))
        points = [mapped.point(problem, rate, at) for rate in rates.tolist() for at in settings.tolist()]
        return StabilityPicture(
            problem.title,
            problem.rate_text,
            table_of_points(problem.name, mapped.setting, points, limit := mapped.limit(problem.memory)),
            limit,
        )


def table_of_points(problem: str, setting: str, points: list[MapPoint], limit: LimitOfSteps) -> pd.DataFrame:
    """A row for each point, with the limits of its step."""
    table = pd.DataFrame(points).assign(region=[point.region for point in points])
    return table.assign(
        problem=problem,
        setting=setting,
        step_times_rate=table["step"] * table["rate"],
        predicted_limit=limit.predicted,
        measured_limit=limit.measured,
    )


def line(drawn: StabilityPicture) -> str:
    """Regions counted, limits predicted and measured."""
    found, limit = drawn.points["region"].value_counts(), drawn.limit
    counts = ", ".join(f"{found.get(region, 0)} {region.replace('_', ' ')}" for region in REGIONS)
    bound = f"step*rate at most {limit.measured:.3f} (predicted {limit.predicted:.3f})"
    if math.isinf(limit.predicted) and math.isinf(limit.measured):
        bound = "no step is too long"
    return f"{drawn.points['problem'].iloc[0]}: {len(drawn.points)} points: {counts}; {bound}"


class StabilityMaps(Record):
    """Which steppers and peers, all where neither is named; on which problems; a grid of how many by how many."""

    steppers: Annotated[tuple[Annotated[Any, one_of(MAPPED_STEPPERS)], ...], FILLED] = ()
    peers: Annotated[tuple[Annotated[Any, one_of(MAPPED_PEERS)], ...], FILLED] = ()
    problems: Annotated[tuple[Annotated[Any, one_of(PROBLEMS)], ...], FILLED] = (*PROBLEMS.values(),)
    grid: Annotated[int, Field(strict=True, ge=2)] = 70
    """Settings, and rates: about 5,000 points a stepper and problem."""

    def sections(self) -> list[StabilitySection]:
        """One for each stepper and peer."""
        named = (*self.steppers, *self.peers) or (*MAPPED_STEPPERS.values(), *MAPPED_PEERS.values())
        return [StabilitySection(each, self.problems, self.grid) for each in named]
