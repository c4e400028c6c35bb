"""One order that was measured."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from frictionlab.bench.orders.fit import Fit
from frictionlab.bench.orders.motions import KindOfMotion
from frictionlab.bench.orders.solvers import Refinement
from frictionlab.bench.orders.theory import TheoryOfOrder


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
