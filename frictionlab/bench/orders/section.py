"""The section of a bench list that measures orders, and what it comes to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from frictionlab.bench.orders.fit import NO_FIT, fit_order
from frictionlab.bench.orders.motions import KindOfMotion
from frictionlab.bench.orders.record import OrderRow
from frictionlab.bench.orders.solvers import OrderSolver
from frictionlab.bench.orders.theory import theory_of
from frictionlab.bench.sections import SectionResult
from frictionlab.bench.solvers import solve_points
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting

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
class OrdersResult(SectionResult):
    """Every order that was measured."""

    rows: list[OrderRow]
    name: str = "orders"
    title: str = "Observed orders on every kind of motion"

    @property
    def caption(self) -> str:
        """How to read the picture."""
        return ORDERS_CAPTION

    def records(self) -> list[dict[str, Any]]:
        """A row an order."""
        return [row.record() for row in self.rows]

    def figure(self) -> Any:
        """A panel a motion."""
        from frictionlab.bench.orders.chart import orders_figure

        return orders_figure(self.rows)

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


@dataclass(frozen=True)
class OrdersSection:
    """Solvers and motions; samples: places of the grid that irregular errors are averaged over."""

    motions: tuple[KindOfMotion, ...]
    solvers: tuple[OrderSolver, ...]
    samples: int
    name: str = "orders"

    def measure(self, tell: Callable[[str], None]) -> OrdersResult:
        """Measure every solver on every motion that it can follow."""
        rows = []
        for motion in self.motions:
            mean, known, reference = reference_mean(motion)
            for solver in self.solvers:
                if solver.refusal(motion) is None:
                    tell(f"{self.name}: {motion.name}, {solver.name}")
                    found = solver.refined(motion, mean, self.samples)
                    fit = fit_order(found.sizes, found.errors, known) if found.sizes.size > 1 else NO_FIT
                    rows.append(
                        OrderRow(
                            solver.name, motion, found, fit, theory_of(solver.name, motion.name), reference
                        )
                    )
        return OrdersResult(rows)


def reference_mean(motion: KindOfMotion) -> tuple[float, float, str]:
    """The mean friction of a motion, how well it is known, and the method that says so: exact where it can."""
    method = Exact() if Exact().refusal(motion.scene, motion.law) is None else Shooting()
    found = solve_points(method, [motion.scene], motion.law, REFERENCE_TOLERANCE)
    return float(found.means[0]), max(float(found.errors[0]), LEAST_REFERENCE_ERROR), method.name
