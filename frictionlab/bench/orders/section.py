"""The section of a bench list that measures orders, and what it comes to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from frictionlab.bench.orders.fit import NO_FIT, Fit, fit_order
from frictionlab.bench.orders.motions import MOTIONS, KindOfMotion
from frictionlab.bench.orders.solvers import ORDER_SOLVERS, Refinement
from frictionlab.bench.orders.theory import TheoryOfOrder, theory_of
from frictionlab.bench.sections import FILLED, AtLeastOne, SectionResult, one_of
from frictionlab.bench.solvers import solve_points
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.quantities import Record

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
