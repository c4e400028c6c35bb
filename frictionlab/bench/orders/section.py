"""The section of a bench list that measures orders, and what it comes to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from frictionlab.bench.csv_table import write_records
from frictionlab.bench.orders.fit import NO_FIT, Fit, fit_order
from frictionlab.bench.orders.motions import KindOfMotion
from frictionlab.bench.orders.solvers import OrderSolver, Refinement
from frictionlab.bench.orders.theory import TheoryOfOrder, theory_of
from frictionlab.bench.sections import BenchPicture
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


@dataclass(frozen=True)
class OrdersResult:
    """Every order that was measured."""

    rows: list[OrderRow]
    name: str = "orders"
    title: str = "Observed orders on every kind of motion"

    def write(self, folder: Path) -> list[Path]:
        """orders.csv. Raises OSError."""
        path = folder / f"{self.name}.csv"
        records = [_record(row) for row in self.rows]
        write_records(path, records)
        return [path]

    def draw(self, folder: Path) -> list[BenchPicture]:
        """One picture, a panel a motion. Raises OSError."""
        from frictionlab.bench.orders.chart import draw_orders

        draw_orders(self.rows, folder, self.name)
        return [BenchPicture(self.name, ORDERS_CAPTION)]

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


def _record(row: OrderRow) -> dict[str, Any]:
    """A row of the CSV; empty where nothing was fitted."""
    fit, refinement = row.fit, row.refinement
    fitted = not math.isnan(fit.order)
    return {
        "solver": row.solver,
        "motion": row.motion.name,
        "law": row.motion.law_text,
        "setting": refinement.setting,
        "settings_from": refinement.values[fit.first] if fitted else "",
        "settings_to": refinement.values[fit.last] if fitted else "",
        "order": fit.order if fitted else "",
        "spread": fit.spread if fitted else "",
        "theory": "" if math.isnan(row.theory.order) else row.theory.order,
        "reason": row.theory.reason,
        "asymptotic": "yes" if row.asymptotic else "no",
        "error_from": float(refinement.errors[fit.first if fitted else 0]),
        "error_to": float(refinement.errors[fit.last if fitted else -1]),
        "reference": row.reference,
    }


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
