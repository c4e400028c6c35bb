"""Stability maps of a bench list: error of one stepper or peer over step, or tolerance, and local rate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np
import pandas as pd
from pydantic import Field

from frictionlab.bench.charts import stability_figure
from frictionlab.bench.contenders import FILLED, one_of
from frictionlab.bench.result import SectionResult, Tell, nothing_measured
from frictionlab.bench.stability_problems import PROBLEMS, StabilityProblem
from frictionlab.bench.stability_solvers import MAPPED_PEERS, MAPPED_STEPPERS, REGIONS, MappedSolver
from frictionlab.values.quantities import Record

STEPS, TOLERANCES, RATES = (8.0, 4096.0), (1e-9, 1e-1), (1.0, 1e3)
"""Ends of the grid."""
STABILITY_CAPTION = (
    "Colour is the true error of the mean friction at each step (or tolerance) and local rate; hatched: wrong, and "
    "told so (refused, failed, or within the error stated), crosses: wrong without a word; red: where the step taken "
    "times the rate is at (adaptive: near) its limit, dashed as predicted, dots as measured. Integrated: {what}."
)
_FOR_THE_FIGURE = ["title", "rate_text", "held", "held_limit"]


@dataclass(frozen=True)
class StabilitySection:
    """One stepper or peer on some problems, n settings by n rates."""

    mapped: MappedSolver
    problems: tuple[StabilityProblem, ...]
    grid: int

    @property
    def name(self) -> str:
        """Return the name of its files."""
        return f"stability_{self.mapped.name}"

    def measure(self, tell: Tell) -> SectionResult:
        """Map every problem that it can take."""
        missing, maps, title = self.mapped.missing(), [], f"Stability of {self.mapped.name}"
        for problem in () if missing else self.problems:
            if problem.name in self.mapped.problems:
                tell(f"{self.name}: {problem.name}")
                maps.append(self._map(problem))
        if not maps:
            return nothing_measured(self.name, title, missing or "takes none of these problems")
        table, style = pd.concat(maps), {"hatch.linewidth": 0.5, "savefig.dpi": 200}
        shown = table.drop(columns=_FOR_THE_FIGURE).replace([math.inf, -math.inf], math.nan)
        said = "\n".join(line(self.name, each) for each in maps)
        caption = STABILITY_CAPTION.format(what=self.mapped.integrated)
        figure = partial(stability_figure, title, table)
        return SectionResult(self.name, title, shown, said, figure, caption, style=style)

    def _map(self, problem: StabilityProblem) -> pd.DataFrame:
        """A row for each point, with the limits of its step."""
        mapped, rates = self.mapped, np.geomspace(*RATES, self.grid)
        settings = np.geomspace(*(STEPS if mapped.setting == "steps" else TOLERANCES), self.grid)
        if mapped.setting == "steps":  # each once
            settings = np.unique(np.round(settings))
        points = [mapped.point(problem, rate, at) for rate in rates.tolist() for at in settings.tolist()]
        found, measured = pd.DataFrame(points), mapped.measured(problem.memory)
        told: dict[str, Any] = {"problem": problem.name, "setting": mapped.setting}
        told |= {name: found[name] for name in ("value", "rate", "step")}
        told |= {"step_times_rate": found["step"] * found["rate"]}
        told |= {"predicted_limit": mapped.predicted, "measured_limit": measured}
        told |= {name: found[name] for name in ("status", "error", "stated")}
        told |= {"region": [point.region for point in points], "reason": found["reason"]}
        told |= {"title": problem.title, "rate_text": problem.rate_text}
        return pd.DataFrame(told | {"held": found["held"], "held_limit": mapped.held})


def line(name: str, table: pd.DataFrame) -> str:
    """Regions counted on one problem, limits predicted and measured."""
    found, first = table["region"].value_counts(), table.iloc[0]
    counts = ", ".join(f"{found.get(region, 0)} {region.replace('_', ' ')}" for region in REGIONS)
    bound = f"step*rate at most {first['measured_limit']:.3f} (predicted {first['predicted_limit']:.3f})"
    if math.isinf(first["predicted_limit"]) and math.isinf(first["measured_limit"]):
        bound = "no step is too long"
    return f"{name}, {first['problem']}: {len(table)} points: {counts}; {bound}"


class StabilityMaps(Record):
    """Steppers and peers that are mapped, all where neither is named, on these problems; grid: points an axis."""

    steppers: Annotated[tuple[Annotated[Any, one_of(MAPPED_STEPPERS)], ...], FILLED] = ()
    peers: Annotated[tuple[Annotated[Any, one_of(MAPPED_PEERS)], ...], FILLED] = ()
    problems: Annotated[tuple[Annotated[Any, one_of(PROBLEMS)], ...], FILLED] = (*PROBLEMS.values(),)
    grid: Annotated[int, Field(strict=True, ge=2)] = 70
    """Settings, and rates: about 5,000 points a stepper and problem."""

    def sections(self) -> list[StabilitySection]:
        """One for each stepper and peer."""
        named = (*self.steppers, *self.peers) or (*MAPPED_STEPPERS.values(), *MAPPED_PEERS.values())
        return [StabilitySection(each, self.problems, self.grid) for each in named]
