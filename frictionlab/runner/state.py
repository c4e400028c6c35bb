"""One steady state as a record: every result column as an attribute, and its orbit on request."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Status
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import at_least_one

if TYPE_CHECKING:
    import pandas as pd

    from frictionlab.motion.orbit.sample import HarmonicParts


NAN = float("nan")


class NoMeanError(RuntimeError):
    """A steady state that has no mean friction; the message gives its status and the reason."""


class OrbitOf:
    """The orbit of one steady state, made when first asked for, or when it goes to another process."""

    def __init__(self, make: Callable[[int], Orbit | None], scene: Scene, law: FrictionLaw) -> None:
        self._make, self._scene, self._law = make, scene, law

    @cached_property
    def _orbit(self) -> Orbit | None:
        return self._make(0)

    def sampled(self, n: int) -> dict[str, Any] | None:
        """So many samples of it as columns, in SI units, too, where the scene is; None where there is no orbit."""
        if self._orbit is None:
            return None
        from frictionlab.motion.orbit.sample import sample  # imports numba: only where it is needed
        from frictionlab.runner.part import beside_in_si, si_scales

        columns = sample(self._orbit, self._scene, self._law, n).columns()
        scales = {} if self._scene.dimensional is None else si_scales(self._scene)
        return {**columns, **beside_in_si(columns, scales)}

    def harmonics(self, highest: int, across: bool) -> HarmonicParts | None:
        """Its harmonics 0 ... highest along or across the belt; None where there is no orbit."""
        if self._orbit is None:
            return None
        from frictionlab.motion.orbit.sample import harmonic_parts  # imports numba: only where it is needed

        return harmonic_parts(self._scene, self._orbit, highest, across)

    def __reduce__(self) -> Any:
        return OrbitOf, (partial(_kept, self._orbit), self._scene, self._law)


def _kept(orbit: Orbit | None, _place: int) -> Orbit | None:
    return orbit


@dataclass(frozen=True, repr=False)
class SteadyState:
    """A steady state: the result columns of the table, in its units; NaN or "" where one does not apply.

    mean_friction, error [-]: the mean friction coefficient along the belt and the bound on its error; lengths in L,
    velocities in omega_1 L, energies of one period in K_1 L^2, period in those of the drive. All columns are
    in docs/results.md. si: the columns in SI units by name, where the scene is given in them.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4))
    >>> state.status, round(state.mean_friction, 4), state.error < 1e-8, state.reversals
    ('ok', 0.0506, True, 2.0)
    """

    status: Status
    reason: str = ""
    mean_friction: float = NAN
    error: float = NAN
    error_kind: str = ""
    unique: str = ""
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
    energy_input_error: float = NAN
    energy_viscous_error: float = NAN
    energy_friction_error: float = NAN
    energy_contact_error: float = NAN
    period: float = NAN
    floquet: float = NAN
    floquet_error: float = NAN
    normalized_friction: float = NAN
    velocity_ratio: float = NAN
    friction_to_drive: float = NAN
    presliding_ratio: float = NAN
    model: str = ""
    seconds: float = NAN
    si: Mapping[str, float] = field(default_factory=dict)
    motion: OrbitOf | None = field(default=None, compare=False)

    def __repr__(self) -> str:
        """The mean with its error, or what there is instead of one and why."""
        if self.status == "ok":
            said = f"mean_friction={self.mean_friction!r}, error={self.error:.1e}"
            return f"SteadyState(ok, {said}{f'; {self.reason}' if self.reason else ''})"
        return f"SteadyState({self._why()})"

    def _why(self) -> str:
        between = f"between {self.mean_low!r} and {self.mean_high!r}"
        none = f"mean_friction {between}" if self.status == "not_unique" else "no mean_friction"
        return f"{self.status}, {none}: {self.reason}"

    def raise_for_status(self) -> SteadyState:
        """This steady state if its status is ``ok``. Raises NoMeanError with status and reason for every other.

        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).raise_for_status().mean_friction, 4)
        0.0506
        """
        if self.status != "ok":
            raise NoMeanError(self._why())
        return self

    def orbit(self, n: int) -> pd.DataFrame:
        """One period at n equally spaced times, a row each: tau, x1, v1, x2, v2, friction, load, slip, ...

        Columns as in ``orbits.parquet``, in the scales of the scene, x2 and its like zero along a line; behind them
        those in SI units, ``tau_s``, ``x1_m``, ``v1_m_per_s``, ..., where the scene is given in them.

        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4))
        >>> state.orbit(4)[["tau", "slip"]].round(2).values.tolist()
        [[0.0, -4.95], [1.57, 20.02], [3.14, -4.62], [4.71, -30.21]]

        Raises ValueError where there is no orbit, saying why.
        """
        count = at_least_one("n", n)
        columns = None if self.motion is None else self.motion.sampled(count)
        if columns is None:
            raise ValueError(self._no_orbit())
        import pandas as pd  # takes half a second, which a mean alone need not

        return pd.DataFrame(columns)

    def harmonics(self, highest: int, across: bool = False) -> HarmonicParts:
        """Harmonics 0 ... highest of velocity [omega_1 L] and friction [-] along the belt, or across it.

        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4))
        >>> state.harmonics(3).velocity_amplitude[1:].round(3).tolist()
        [25.057, 0.651, 0.525]

        Raises ValueError where there is no orbit, saying why.
        """
        count = at_least_one("highest", highest)
        found = None if self.motion is None else self.motion.harmonics(count, across)
        if found is None:
            raise ValueError(self._no_orbit())
        return found

    def _no_orbit(self) -> str:
        return f"no orbit: the steady state is '{self.status}': {self.reason or 'none was kept'}"
