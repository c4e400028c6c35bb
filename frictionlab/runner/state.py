"""One steady state as a record: every result column as an attribute, and its orbit on request."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Status
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.values.columns import IN_SI_UNITS, SI
from frictionlab.values.quantities import at_least_one

if TYPE_CHECKING:
    import pandas as pd

    from frictionlab.motion.orbit.sample import HarmonicParts
    from frictionlab.runner.free_body import MotionOnSprings


NAN = float("nan")


class NoMeanError(RuntimeError):
    """A steady state that has no mean friction; the message gives its status and the reason."""


class OrbitOf:
    """Orbit of one steady state, made when first asked for, or when it goes to another process."""

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


class ResultsInSI(dict[str, float]):
    """Results in SI units by column; each is an attribute, too, without the unit: ``si.velocity_amplitude``."""

    def __getattr__(self, name: str) -> float:
        """Return the number of this name. Raises AttributeError."""
        column = next((each for each, made in SI.items() if made.column == name and each in self), None)
        if column is None:
            raise AttributeError(f"no result {name!r} in SI units; there are {', '.join(self.__dir__())}")
        return self[column]

    def __dir__(self) -> list[str]:
        """Return the names of its results without their units."""
        return [SI[name].column for name in self]

    def __repr__(self) -> str:
        """Return the results that apply with their units."""
        units = IN_SI_UNITS | dict.fromkeys((name for name, made in SI.items() if made.scale == "load"), "N")
        told = (
            f"{SI[name].column} {value:.6g} {units[name]}" for name, value in self.items() if value == value
        )
        return f"ResultsInSI({', '.join(told)})"


@dataclass(frozen=True, repr=False)
class SteadyState:
    """Steady state of one scene: all result columns of the table, in its units.

    A number that does not apply is NaN, a text that does not apply is "". Lengths are in L, velocities in
    omega_1 L, and energies in K_1 L^2 per period. ``fl.steady_state`` returns it.

    Attributes
    ----------
    status : {"ok", "refused", "failed", "not_unique", "killed"}
        "ok": a number with an error. "refused": the method cannot do the scene. "failed": no steady state was
        found. "not_unique": the mean depends on the initial state. "killed": the computation was interrupted.
    reason : str
        Reason of the status, if it is not plainly ok.
    mean_friction : float
        Time mean of the friction coefficient along the belt [-].
    error : float
        Bound on the absolute error of ``mean_friction`` [-].
    error_kind : str
        "guaranteed" (proved), "estimated", or "statistical" if the motion does not repeat.
    unique : str
        "proved", "tested" or "no": whether every initial state ends in this state.
    mean_low : float
        Lowest mean, if it is not unique [-].
    mean_high : float
        Highest mean, if it is not unique [-].
    window : float
        Number of drive periods over which this range, or a statistical mean, is averaged.
    mean_friction_transverse : float
        Time mean of the friction coefficient across the belt [-].
    velocity_amplitude : float
        Half the peak-to-peak velocity along the belt [omega_1 L].
    velocity_harmonic : float
        Amplitude of the first harmonic of the velocity along the belt [omega_1 L].
    velocity_phase : float
        Phase of this harmonic against the load along the belt [degrees], positive if it leads.
    transverse_velocity_amplitude : float
        Half the peak-to-peak velocity across the belt [omega_1 L].
    transverse_velocity_harmonic : float
        Amplitude of the first harmonic of the velocity across the belt [omega_1 L].
    transverse_velocity_phase : float
        Phase of this harmonic against the load along the belt [degrees], positive if it leads.
    stick_fraction : float
        Fraction of the period in stick.
    reversals : float
        Sign changes of the slip velocity along the belt per period.
    force_reversals : float
        Sign changes of the friction force along the belt per period.
    energy_input : float
        Work of the loads per period [K_1 L^2].
    energy_viscous : float
        Loss in the dashpots per period [K_1 L^2].
    energy_friction : float
        Energy that friction takes from the mass per period [K_1 L^2].
    energy_contact : float
        Heat in the contact per period [K_1 L^2].
    energy_input_error : float
        Estimated bound on the error of ``energy_input`` [K_1 L^2]; NaN for reduced models.
    energy_viscous_error : float
        The same for ``energy_viscous``.
    energy_friction_error : float
        The same for ``energy_friction``.
    energy_contact_error : float
        The same for ``energy_contact``.
    period : float
        Period of the response in drive periods; without a drive in units of 2 pi.
    floquet : float
        Largest modulus of the Floquet multipliers, without the trivial one of an undriven orbit.
    floquet_error : float
        Estimated bound on the error of ``floquet``.
    normalized_friction : float
        ``mean_friction`` over the friction coefficient of steady sliding.
    velocity_ratio : float
        Belt speed over V_lin, the largest velocity of the body without friction.
    friction_to_drive : float
        Friction coefficient times normal load over the amplitude of the driving force.
    presliding_ratio : float
        Presliding length over the amplitude of the motion without friction.
    drift_speed : float
        Speed of a free body over the plate; ``fl.drift_speed`` computes it, here it is NaN.
    drift_speed_error : float
        Bound on its error, NaN here, too.
    model : str
        Model that produced the number, in words such as "events"; with ``auto`` also why it was chosen.
    seconds : float
        Time spent in kernels [s].
    si : ResultsInSI
        Columns in SI units by name, if the scene is given in SI units.
    motion : OrbitOf or MotionOnSprings, optional
        Orbit, computed when first used; ``orbit`` and ``harmonics`` read it.

    Examples
    --------
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
    si: ResultsInSI = field(default_factory=ResultsInSI)
    drift_speed: float = NAN
    drift_speed_error: float = NAN
    motion: OrbitOf | MotionOnSprings | None = field(default=None, compare=False)

    def __repr__(self) -> str:
        """Return the mean with its error, or what there is instead of one and why."""
        if self.status == "ok":
            said = f"mean_friction={self.mean_friction!r}, error={self.error:.1e}"
            return f"SteadyState(ok, {said}{f'; {self.reason}' if self.reason else ''})"
        return f"SteadyState({self._why()})"

    def _why(self) -> str:
        between = f"between {self.mean_low!r} and {self.mean_high!r}"
        none = f"mean_friction {between}" if self.status == "not_unique" else "no mean_friction"
        return f"{self.status}, {none}: {self.reason}"

    def raise_for_status(self) -> SteadyState:
        """Return this steady state if its status is ``ok``.

        Returns
        -------
        SteadyState
            This steady state.

        Raises
        ------
        NoMeanError
            If the status is another; the message has status and reason.

        Examples
        --------
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
        """Sample one period of the orbit at equally spaced times.

        Parameters
        ----------
        n : int, >= 1
            Number of samples.

        Returns
        -------
        pandas.DataFrame
            A row for each instant, with the columns of ``orbits.parquet`` in the scales of the scene:
            ``tau``, ``x1``, ``v1``, ``x2``, ``v2``, ``friction``, ``load``, ``slip``, ...; ``x2`` and other
            columns across the belt are zero along a line. For a scene in SI units, ``tau_s``, ``x1_m``,
            ``v1_m_per_s``, ... follow.

        Raises
        ------
        ValueError
            If there is no orbit; the message says why.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4))
        >>> state.orbit(4)[["tau", "slip"]].round(2).values.tolist()
        [[0.0, -4.95], [1.57, 20.02], [3.14, -4.62], [4.71, -30.21]]
        """
        count = at_least_one("n", n)
        columns = None if self.motion is None else self.motion.sampled(count)
        if columns is None:
            raise ValueError(self._no_orbit())
        import pandas as pd  # takes half a second, which a mean alone need not

        return pd.DataFrame(columns)

    def harmonics(self, highest: int, across: bool = False) -> HarmonicParts:
        """Compute the harmonics of velocity and friction along or across the belt.

        Parameters
        ----------
        highest : int, >= 1
            Highest order; the harmonics 0 to ``highest`` are computed.
        across : bool, default False
            Whether to compute them across the belt instead of along it.

        Returns
        -------
        HarmonicParts
            Arrays by order: amplitudes and phases of velocity [omega_1 L] and friction [-], and the parts of
            friction in phase and in quadrature with the velocity.

        Raises
        ------
        ValueError
            If there is no orbit; the message says why.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4))
        >>> state.harmonics(3).velocity_amplitude[1:].round(3).tolist()
        [25.057, 0.651, 0.525]
        """
        count = at_least_one("highest", highest)
        found = None if self.motion is None else self.motion.harmonics(count, across)
        if found is None:
            raise ValueError(self._no_orbit())
        return found

    def _no_orbit(self) -> str:
        return f"no orbit: the steady state is '{self.status}': {self.reason or 'none was kept'}"
