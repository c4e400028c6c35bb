"""One steady state as a record: every result column as an attribute, and its orbit on request."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from frictionlab.methods.base import Status

if TYPE_CHECKING:
    from frictionlab.orbit.sample import Samples


NAN = float("nan")


@dataclass(frozen=True)
class SteadyState:
    """A steady state: the result columns of the table, in its units; NaN or "" where one does not apply.

    si: the columns in SI units by name, where the scene is given in them.
    """

    status: Status
    reason: str = ""
    mean_friction: float = NAN
    error: float = NAN
    error_kind: str = ""
    mean_low: float = NAN
    mean_high: float = NAN
    window: float = NAN
    mean_friction_transverse: float = NAN
    velocity_amplitude: float = NAN
    velocity_harmonic: float = NAN
    velocity_phase: float = NAN
    transverse_velocity_amplitude: float = NAN
    transverse_velocity_harmonic: float = NAN
    transverse_velocity_phase: float = NAN
    stick_fraction: float = NAN
    reversals: float = NAN
    force_reversals: float = NAN
    energy_input: float = NAN
    energy_viscous: float = NAN
    energy_friction: float = NAN
    energy_contact: float = NAN
    period: float = NAN
    floquet: float = NAN
    normalized_friction: float = NAN
    velocity_ratio: float = NAN
    friction_to_drive: float = NAN
    presliding_ratio: float = NAN
    model: str = ""
    seconds: float = NAN
    si: Mapping[str, float] = field(default_factory=dict)
    sampled: Callable[[int], Samples | None] = field(default=lambda n: None, repr=False, compare=False)

    def orbit(self, n: int) -> Samples:
        """One period at n equally spaced times. Raises ValueError where there is no orbit, saying why."""
        if n < 1:
            raise ValueError(f"an orbit has at least one sample, not {n}")
        samples = self.sampled(n)
        if samples is None:
            raise ValueError(
                f"no orbit: the steady state is '{self.status}': {self.reason or 'none was kept'}"
            )
        return samples
