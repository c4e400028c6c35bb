"""The order of a sequence of errors: the slope of log error over log setting where it no longer changes.

The order that theory gives each solver on each kind of motion, and why.

The section of a bench list that measures orders, and what it comes to.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from frictionlab.bench.measure import solve_points
from frictionlab.bench.order_solvers import MOTIONS, ORDER_SOLVERS, KindOfMotion, Refinement
from frictionlab.bench.record import FILLED, AtLeastOne, SectionResult, one_of
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.values.quantities import Floats, Record

SETTINGS_OF_A_SLOPE = 5
"""Settings that a local slope is fitted to: one pair of neighbours says little where errors are irregular."""
STEADY_SLOPES = 0.12
"""Most that local slopes may differ by where the range is asymptotic."""
FEWEST_SLOPES = 2
"""Local slopes of an asymptotic range; one more where they are those between neighbours."""
MOST_SETTINGS = 7
"""Of a fit: the finest ones."""
FLOOR_OF_ERRORS = 20.0
"""Errors below so many times what the reference is known to are left out."""


class Fit(NamedTuple):
    """An order, how far local slopes are from it at most, and the first and last setting it is fitted to.

    Not asymptotic: the slope through all errors above the floor; NaN, with an empty range, where fewer than two are.
    """

    order: float
    spread: float
    first: int
    last: int
    asymptotic: bool


NO_FIT = Fit(math.nan, math.nan, 0, 0, False)


def fit_order(sizes: Floats, errors: Floats, known: float) -> Fit:
    """The order of errors at sizes that shrink from each to the next; known: error of the reference."""
    first, last = _longest_run(np.isfinite(errors) & (errors > FLOOR_OF_ERRORS * known))
    if last - first < 1:
        return NO_FIT
    x, y = np.log(sizes), np.log(np.where(errors > 0.0, errors, 1.0))
    for points, fewest in ((SETTINGS_OF_A_SLOPE, FEWEST_SLOPES), (2, FEWEST_SLOPES + 1)):
        finest = range(max(first, last - MOST_SETTINGS + 1), last - points + 2)
        steady = _steady_at_the_end([_slope(x, y, at, at + points - 1) for at in finest])
        if len(steady) >= fewest:
            begin = last - points + 2 - len(steady)
            order = _slope(x, y, begin, last)
            return Fit(order, max(abs(slope - order) for slope in steady), begin, last, True)
    order, points = (
        _slope(x, y, first, last),
        SETTINGS_OF_A_SLOPE if last - first > SETTINGS_OF_A_SLOPE else 2,
    )
    slopes = [_slope(x, y, at, at + points - 1) for at in range(first, last - points + 2)]
    return Fit(order, max(abs(slope - order) for slope in slopes), first, last, False)


def _longest_run(good: np.ndarray) -> tuple[int, int]:
    """First and last of the longest stretch of good ones; (0, -1) for none."""
    best, start = (0, -1), 0
    for i, each in enumerate(good):
        start = start if each else i + 1
        best = max(best, (start, i), key=lambda run: run[1] - run[0])
    return best


def _slope(x: Floats, y: Floats, first: int, last: int) -> float:
    """By least squares."""
    return float(np.polyfit(x[first : last + 1], y[first : last + 1], 1)[0])


def _steady_at_the_end(slopes: list[float]) -> list[float]:
    """The last slopes that differ by little enough."""
    kept = list[float]()
    for slope in reversed(slopes):
        if max([*kept, slope]) - min([*kept, slope]) > STEADY_SLOPES:
            break
        kept.append(slope)
    return kept


class TheoryOfOrder(NamedTuple):
    """An order, NaN where errors fall otherwise than by a power, and the reason; plain: without a logarithm."""

    order: float
    reason: str
    plain: bool = True


_OWN = "of the formula itself: all is smooth"
_REVERSAL = "a reversal inside a step: the grid knows its sign, not its share"
_CORNER = "rates have a corner where slip reverses: second order is kept, no higher one"
_BLIND = "blind to stick: chatter of one step's impulse"
_ENDS = "projection: friction is continuous where stick begins and ends"
_LOGARITHM = "the dip grows with what it changes: h log 1/h, which looks like less or more than 1 for long"
_FASTER = "slip stays many widths from rest: faster than any power"
_WIDTH = "friction is off while slip is within a width of rest: a time in proportion to it"
_TOLERANCE = "the error follows the tolerance; steps adapt, so not smoothly"
_CLOSED_FORM = "closed form between events: rounding at any tolerance"

_OF_TWO_STAGES = {
    "bristle_dragged": TheoryOfOrder(2.0, _OWN),
    "bristle_soft": TheoryOfOrder(2.0, _CORNER),
    "bristle_stiff": TheoryOfOrder(2.0, _CORNER),
}
_THEORY: dict[str, dict[str, TheoryOfOrder]] = {
    "rk4": {
        "smooth": TheoryOfOrder(4.0, _OWN),
        "crossing": TheoryOfOrder(1.0, _REVERSAL),
        "grazing": TheoryOfOrder(1.0, _LOGARITHM, plain=False),
        "stick": TheoryOfOrder(1.0, _BLIND),
        "bristle_dragged": TheoryOfOrder(4.0, _OWN),
        "bristle_soft": TheoryOfOrder(2.0, _CORNER),
        "bristle_stiff": TheoryOfOrder(2.0, _CORNER),
        "plane_near_rest": TheoryOfOrder(
            4.0, "of the formula itself, once a step is shorter than the turn; rounding comes first"
        ),
    },
    "moreau_0.5": {
        "smooth": TheoryOfOrder(2.0, _OWN),
        "crossing": TheoryOfOrder(1.0, _REVERSAL),
        "grazing": TheoryOfOrder(
            2.0, "what the amplitude's error, of order 2, exceeds the belt by is projected"
        ),
        "stick": TheoryOfOrder(2.0, _ENDS),
        "plane_near_rest": TheoryOfOrder(2.0, _OWN),
    },
    "moreau_1": {
        "smooth": TheoryOfOrder(1.0, _OWN),
        "crossing": TheoryOfOrder(1.0, _REVERSAL),
        "grazing": TheoryOfOrder(
            math.nan, "its damping of order 1 keeps slip from rest: friction is constant"
        ),
        "stick": TheoryOfOrder(1.0, _OWN),
        "plane_near_rest": TheoryOfOrder(1.0, _OWN),
    },
    "exponential": _OF_TWO_STAGES,
    "sdirk2": _OF_TWO_STAGES,
    "smoothed": {
        "smooth": TheoryOfOrder(math.nan, _FASTER),
        "crossing": TheoryOfOrder(1.0, _WIDTH),
        "grazing": TheoryOfOrder(1.0, _LOGARITHM, plain=False),
        "stick": TheoryOfOrder(1.0, _WIDTH),
        "plane_near_rest": TheoryOfOrder(math.nan, _FASTER),
    },
}


def theory_of(solver: str, motion: str) -> TheoryOfOrder:
    """What theory says of a solver on a motion."""
    if solver in _THEORY:
        return _THEORY[solver][motion]
    return (
        TheoryOfOrder(math.nan, _CLOSED_FORM)
        if solver == "exact"
        else TheoryOfOrder(1.0, _TOLERANCE, plain=False)
    )


REFERENCE_TOLERANCE = 1e-12
"""Tolerance of a reference."""
LEAST_REFERENCE_ERROR = 1e-14
"""What no reference is known better than."""
ORDERS_CAPTION = (
    "Errors of the mean friction; each refinement halves the step or the smoothing width, or asks for a tenth of the "
    "tolerance. The steeper, the higher the order; the number is the fitted slope over the setting, in brackets and "
    "with hollow marks where the range is not asymptotic."
)


@dataclass(frozen=True)
class OrderRow:
    """One solver on one motion; reference: the method whose mean errors are measured against."""

    solver: str
    motion: KindOfMotion
    refinement: Refinement
    fit: Fit
    theory: TheoryOfOrder
    reference: str

    @property
    def asymptotic(self) -> bool:
        """Whether the slope is steady and theory gives a plain power."""
        return self.fit.asymptotic and self.theory.plain

    @property
    def agrees(self) -> bool:
        """Whether an asymptotic order is within 0.1 of theory."""
        return abs(self.fit.order - self.theory.order) <= 0.1

    def record(self) -> dict[str, Any]:
        """A row of the CSV; empty where nothing was fitted."""
        fit, refinement = self.fit, self.refinement
        fitted = not math.isnan(fit.order)
        return {
            "solver": self.solver,
            "motion": self.motion.name,
            "law": self.motion.law_text,
            "setting": refinement.setting,
            "settings_from": refinement.values[fit.first] if fitted else "",
            "settings_to": refinement.values[fit.last] if fitted else "",
            "order": fit.order if fitted else "",
            "spread": fit.spread if fitted else "",
            "theory": "" if math.isnan(self.theory.order) else self.theory.order,
            "reason": self.theory.reason,
            "asymptotic": "yes" if self.asymptotic else "no",
            "error_from": float(refinement.errors[fit.first if fitted else 0]),
            "error_to": float(refinement.errors[fit.last if fitted else -1]),
            "reference": self.reference,
        }


@dataclass(frozen=True)
class OrdersResult(SectionResult):
    """Every order that was measured."""

    rows: list[OrderRow]
    name: str = "orders"
    title: str = "Observed orders on every kind of motion"
    caption = ORDERS_CAPTION

    def records(self) -> list[dict[str, Any]]:
        """A row an order."""
        return [row.record() for row in self.rows]

    def summary(self) -> str:
        """A line a motion and solver, asymptotic orders first compared with theory."""
        known = [row for row in self.rows if row.asymptotic]
        lines = [
            f"{self.name}: {len(known)} of {len(self.rows)} asymptotic, "
            f"{sum(row.agrees for row in known)} of them within 0.1 of theory"
        ]
        for row in self.rows:
            order = "-" if math.isnan(row.fit.order) else f"{row.fit.order:.2f} +- {row.fit.spread:.2f}"
            told = "" if math.isnan(row.theory.order) else f"theory {row.theory.order:g}"
            range_text = "" if row.asymptotic else " (not asymptotic)"
            lines.append(f"{row.motion.name:<17}{row.solver:<13}{order + range_text:<34}{told}")
        return "\n".join(lines)


class OrdersSection(Record):
    """Solvers and motions, all where none is named; samples: places of the grid that irregular errors are averaged
    over.
    """

    name: ClassVar[str] = "orders"

    motions: Annotated[tuple[Annotated[Any, one_of(MOTIONS)], ...], FILLED] = (*MOTIONS.values(),)
    steppers: Annotated[tuple[Annotated[Any, one_of(ORDER_SOLVERS)], ...], FILLED] = (
        *ORDER_SOLVERS.values(),
    )
    samples: AtLeastOne = 40

    def sections(self) -> list[OrdersSection]:
        """Itself."""
        return [self]

    def measure(self, tell: Callable[[str], None]) -> OrdersResult:
        """Measure every solver on every motion that it can follow."""
        rows = []
        for motion in self.motions:
            mean, known, reference = reference_mean(motion)
            for solver in (each for each in self.steppers if each.refusal(motion) is None):
                tell(f"{self.name}: {motion.name}, {solver.name}")
                found = solver.refined(motion, mean, self.samples)
                fit = fit_order(found.sizes, found.errors, known) if found.sizes.size > 1 else NO_FIT
                theory = theory_of(solver.name, motion.name)
                rows.append(OrderRow(solver.name, motion, found, fit, theory, reference))
        return OrdersResult(rows)


def reference_mean(motion: KindOfMotion) -> tuple[float, float, str]:
    """The mean friction of a motion, how well it is known, and the method that says so: exact where it can."""
    method = Exact() if Exact().refusal(motion.scene, motion.law) is None else Shooting()
    found = solve_points(method, [motion.scene], motion.law, REFERENCE_TOLERANCE)
    return float(found.means[0]), max(float(found.errors[0]), LEAST_REFERENCE_ERROR), method.name
