"""Observed orders of solvers on every kind of motion: fitted slopes beside what theory expects, and why."""

from __future__ import annotations

import math
from functools import partial
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
import pandas as pd

from frictionlab.bench.charts import orders_figure
from frictionlab.bench.contenders import FILLED, AtLeastOne, one_of
from frictionlab.bench.order_solvers import MOTIONS, ORDER_SOLVERS, KindOfMotion, OrderSolver
from frictionlab.bench.result import SectionResult, Tell
from frictionlab.bench.solve import solve_points
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
"""Most settings of a fit: the finest ones."""
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


NO_FIT = Fit(math.nan, math.nan, 0, -1, False)


def fit_order(sizes: Floats, errors: Floats, known: float) -> Fit:
    """Return the order of errors at sizes that shrink from each to the next; known: error of the reference."""
    first, last = _longest_run(np.isfinite(errors) & (errors > FLOOR_OF_ERRORS * known))
    if last - first < 1:
        return NO_FIT
    x, y = np.log(sizes), np.log(np.where(errors > 0.0, errors, 1.0))

    def slope(at: int, end: int) -> float:
        return float(np.polyfit(x[at : end + 1], y[at : end + 1], 1)[0])

    def fitted(begin: int, points: int, asymptotic: bool) -> Fit:
        order = slope(begin, last)
        slopes = [slope(at, at + points - 1) for at in range(begin, last - points + 2)]
        return Fit(order, max(abs(each - order) for each in slopes), begin, last, asymptotic)

    for points, fewest in ((SETTINGS_OF_A_SLOPE, FEWEST_SLOPES), (2, FEWEST_SLOPES + 1)):
        finest = range(max(first, last - MOST_SETTINGS + 1), last - points + 2)
        steady = _steady_at_the_end([slope(at, at + points - 1) for at in finest])
        if steady >= fewest:
            return fitted(last - points + 2 - steady, points, True)
    return fitted(first, SETTINGS_OF_A_SLOPE if last - first > SETTINGS_OF_A_SLOPE else 2, False)


def _longest_run(good: np.ndarray) -> tuple[int, int]:
    """First and last of the longest stretch of good ones; (0, -1) for none."""
    best, start = (0, -1), 0
    for i, each in enumerate(good):
        start = start if each else i + 1
        best = max(best, (start, i), key=lambda run: run[1] - run[0])
    return best


def _steady_at_the_end(slopes: list[float]) -> int:
    """Return how many of the last slopes differ by little enough."""
    last = slopes[::-1]
    steady = (n for n in range(len(last), 0, -1) if np.ptp(last[:n]) <= STEADY_SLOPES)
    return next(steady, 0)


_OWN = "of the formula itself: all is smooth"
_ONCE_SHORT = "of the formula itself, once a step is shorter than the turn; rounding comes first"
_CORNER = "rates have a corner where slip reverses: second order is kept, no higher one"
_WIDTH = "friction is off while slip is within a width of rest: a time in proportion to it"
_LOGARITHM = "the dip grows with what it changes: h log 1/h, which looks like less or more than 1 for long"
_TOLERANCE = "the error follows the tolerance; steps adapt, so not smoothly"
NOT_PLAIN = (_LOGARITHM, _TOLERANCE)
"""Reasons of errors that fall by no plain power."""
# fmt: off
_THEORY = (
    ("rk4", "smooth bristle_dragged", 4.0, _OWN),
    ("rk4", "plane_near_rest", 4.0, _ONCE_SHORT),
    ("rk4", "stick", 1.0, "blind to stick: chatter of one step's impulse"),
    ("rk4 smoothed", "grazing", 1.0, _LOGARITHM),
    ("rk4 sdirk2", "bristle_soft bristle_stiff", 2.0, _CORNER),
    ("sdirk2", "bristle_dragged", 2.0, _OWN),
    ("rk4 moreau_0.5 moreau_1", "crossing", 1.0, "a reversal inside a step: the grid knows its sign, not its share"),
    ("moreau_0.5", "smooth plane_near_rest", 2.0, _OWN),
    ("moreau_0.5", "grazing", 2.0, "what the amplitude's error, of order 2, exceeds the belt by is projected"),
    ("moreau_0.5", "stick", 2.0, "projection: friction is continuous where stick begins and ends"),
    ("moreau_1", "smooth stick plane_near_rest", 1.0, _OWN),
    ("moreau_1", "grazing", math.nan, "its damping of order 1 keeps slip from rest: friction is constant"),
    ("smoothed", "smooth plane_near_rest", math.nan, "slip stays many widths from rest: faster than any power"),
    ("smoothed", "crossing stick", 1.0, _WIDTH),
    ("shooting", " ".join(MOTIONS), 1.0, _TOLERANCE),
    ("exact", " ".join(MOTIONS), math.nan, "closed form between events: rounding at any tolerance"),
)
# fmt: on
"""Solvers, motions, the order that theory gives them, NaN where errors fall otherwise than by a power, and why."""


def theory_of(solver: str, motion: str) -> tuple[float, str]:
    """Order that theory gives a solver on a motion, and why."""
    ((order, reason),) = (
        (order, reason)
        for solvers, motions, order, reason in _THEORY
        if solver in solvers.split() and motion in motions.split()
    )
    return order, reason


REFERENCE_TOLERANCE = 1e-12
"""Tolerance of a reference."""
LEAST_REFERENCE_ERROR = 1e-14
"""Accuracy that no reference exceeds."""
ORDERS_CAPTION = (
    "Errors of the mean friction; each refinement halves the step or the smoothing width, or asks for a tenth of the "
    "tolerance. The steeper, the higher the order; the number is the fitted slope over the setting, in brackets and "
    "with hollow marks where the range is not asymptotic."
)
_FOR_THE_FIGURE = ["title", "errors"]


def order_row(
    motion: KindOfMotion, solver: OrderSolver, samples: int, mean: float, known: float
) -> dict[str, Any]:
    """Return the row of one solver on one motion: the order of its errors about a mean known to an error."""
    found, (theory, reason) = solver.refined(motion, mean, samples), theory_of(solver.name, motion.name)
    sizes = 1.0 / found.values if found.setting == "steps" else found.values
    fit = fit_order(sizes, found.errors, known)
    ends = [fit.first, fit.last] if fit.order == fit.order else []
    first, last = found.values[ends] if ends else (math.nan, math.nan)
    return {
        **{"solver": solver.name, "motion": motion.name, "law": motion.law_text, "setting": found.setting},
        **{"settings_from": first, "settings_to": last, "order": fit.order, "spread": fit.spread},
        **{"theory": theory, "reason": reason},
        "asymptotic": "yes" if fit.asymptotic and reason not in NOT_PLAIN else "no",
        "error_from": found.errors[fit.first],
        "error_to": found.errors[fit.last],
        **{"title": f"{motion.title} ({motion.law_text})", "errors": found.errors},
    }


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

    def measure(self, tell: Tell) -> SectionResult:
        """Measure every solver on every motion that it can follow."""
        rows = []
        for motion in self.motions:
            mean, known, reference = reference_mean(motion)
            for solver in (each for each in self.steppers if each.takes(motion)):
                tell(f"{self.name}: {motion.name}, {solver.name}")
                row = order_row(motion, solver, self.samples, mean, known)
                rows.append(row | {"reference": reference})
        table = pd.DataFrame(rows)
        title, figure = "Observed orders on every kind of motion", partial(orders_figure, table)
        shown, said = table.drop(columns=_FOR_THE_FIGURE), orders_summary(table)
        return SectionResult(self.name, title, shown, said, figure, ORDERS_CAPTION)


def reference_mean(motion: KindOfMotion) -> tuple[float, float, str]:
    """Return the mean friction of a motion, how well it is known, and the method that says so: exact where it can."""
    method = Exact() if Exact().refusal(motion.scene, motion.law) is None else Shooting()
    found = solve_points(method, [motion.scene], motion.law, REFERENCE_TOLERANCE).iloc[0]
    return float(found["mean"]), max(float(found["error"]), LEAST_REFERENCE_ERROR), method.name


def orders_summary(table: pd.DataFrame) -> str:
    """A line a motion and solver, asymptotic orders first compared with theory."""
    known = table[table["asymptotic"] == "yes"]
    near = int(agrees(known).sum())
    lines = [f"orders: {len(known)} of {len(table)} asymptotic, {near} of them within 0.1 of theory"]
    for _, row in table.iterrows():
        order = "-" if math.isnan(row["order"]) else f"{row['order']:.2f} +- {row['spread']:.2f}"
        order += "" if row["asymptotic"] == "yes" else " (not asymptotic)"
        told = "" if math.isnan(row["theory"]) else f"theory {row['theory']:g}"
        lines.append(f"{row['motion']:<17}{row['solver']:<13}{order:<34}{told}")
    return "\n".join(lines)


def agrees(table: pd.DataFrame) -> pd.Series:
    """Check for orders within 0.1 of theory."""
    return (table["order"] - table["theory"]).abs() <= 0.1
