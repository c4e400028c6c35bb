"""Mass, its springs and dashpots, its loads and the belt it slides on: none, one or two degrees of freedom.

Everything is nondimensional, in the scales of Sulollari, van Dalen & Cabboi, Eq. 2: time 1/omega_1, a length
L, force K_1 L, velocity omega_1 L, energy K_1 L^2. The equations of motion are their Eq. 1,

    x1'' + 2 damping_ratio x1' + x1 + normal_load T1 = load along x1,
    x2'' + 2 damping_ratio_2 omega_r x2' + omega_r^2 x2 + normal_load T2 = load along x2,

with T the friction coefficient of a law at the slip velocity (x1' - belt_speed, x2'). The belt vibrates and
the normal load changes if the scene says so; ``body`` adds what is not linear, or remembers.

Excitations of a scene are made from its parts, once for all scenes that differ in belt speed alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Annotated, Any, NamedTuple

from pydantic import BeforeValidator, StrictBool, ValidationError, model_validator

from frictionlab.scene.body import Mass, Motion, with_free_motion
from frictionlab.scene.dimensional import Dimensional, changed, with_values
from frictionlab.scene.parts import (
    BENDING,
    BY_TABLE,
    REMEMBERING,
    BeltVibration,
    Body,
    Drive,
    Fractional,
    Initial,
    Load,
    NormalLoadVariation,
    Receptance,
    Relaxation,
    ScenePart,
    Slip,
    Transverse,
    TransverseSlip,
)
from frictionlab.scene.rules import (
    frequency_of,
    periods_of,
    problems_of_free,
    problems_of_parts,
    problems_of_slip,
    replaced_by_table,
)
from frictionlab.scene.signals import FULL_TURN, Signal, Signals, constant, signal_of
from frictionlab.scene.units import FORCE, VELOCITY
from frictionlab.scene.varying import varying_of
from frictionlab.scene.waveforms import SINE, form_of
from frictionlab.values.quantities import Finite, NonNegative, Positive, given_values


class Shaking(NamedTuple):
    """Excitations of a scene: everything that changes in time.

    ``load`` and ``belt`` are the harmonics along x1 and x2 at the frequency of the drive. ``varying`` holds,
    for kernels, the excitations other than one sine; it is empty if there are none.
    """

    signals: Signals
    load: tuple[complex, complex]
    belt: tuple[complex, complex]
    varying: Any


@lru_cache(maxsize=1024)
def shaking_by(
    parts: tuple[Drive | None, Load | None, Slip | None, TransverseSlip | None],
    others: tuple[BeltVibration | None, NormalLoadVariation | None],
    omega: float,
    periods: int,
    normal_load: float,
    is_harmonic: bool,
) -> Shaking:
    """Return the excitations of a scene with these parts, frequency ``omega`` and common period."""
    (drive, load, slip, across), (belt, normal) = parts, others
    moved = _pair(slip or belt, across, omega)
    variation = _signal(normal, omega).scaled(normal_load)
    signals = Signals(FULL_TURN * periods / omega, _pair(drive, load, omega), moved, variation)
    first, second, third, fourth = (
        signal.harmonic(omega, signals.period) for signal in (*signals.load, *signals.belt)
    )
    varying = () if is_harmonic else varying_of(signals, omega, keeps_stiffness(normal))
    return Shaking(signals, (first, second), (third, fourth), varying)


def keeps_stiffness(part: NormalLoadVariation | None) -> bool:
    """Check whether bristles keep their stiffness while the normal load changes."""
    return part is not None and part.amplitude > 0.0 and part.contact == "constant"


def _signal(part: Any, omega: float) -> Signal:
    """Return the signal of a part, its waveform times its size; ``omega`` is the frequency of the drive.

    A force keeps the mean of its waveform; a velocity and the normal load have theirs in ``belt_speed`` and
    ``normal_load``.
    """
    if part is None:
        return Signal()
    ratio = getattr(part, "frequency_ratio", None) or 1.0
    form, is_force = part.waveform or SINE, isinstance(part, Drive | Load)
    signal = signal_of(form, omega * ratio, part.phase, is_force).scaled(part.size(omega))
    return signal.plus(constant(part.offset or 0.0, FULL_TURN / omega)) if is_force else signal


def _pair(part: Any, across: Any, omega: float) -> tuple[Signal, Signal]:
    """Return the signals along x1 and x2 of a part along the belt and of one across it."""
    along, aside = _turned(_signal(part, omega), (part and part.direction) or 0.0)
    return along, aside if across is None else _signal(across, omega)


def _turned(signal: Signal, direction: float) -> tuple[Signal, Signal]:
    """Return the components along x1 and x2 of a signal at an angle [degrees] to x1.

    Right angles are exact to the last digit.
    """
    quarters, rest = divmod(direction, 90.0)
    along, across = (
        (1.0, 0.0) if rest == 0.0 else (math.cos(math.radians(rest)), math.sin(math.radians(rest)))
    )
    for _ in range(int(quarters) % 4):
        along, across = -across, along
    return signal.scaled(along), signal.scaled(across)


__all__ = [
    "BeltVibration",
    "Body",
    "Drive",
    "Fractional",
    "Initial",
    "Load",
    "NormalLoadVariation",
    "Receptance",
    "Relaxation",
    "Scene",
    "Slip",
    "Transverse",
    "TransverseSlip",
    "with_values",
]
"""Names of the scene and its parts."""


def _truth(value: Any) -> Any:
    """Return the truth value that a number of a table stands for; other values unchanged."""
    return bool(value) if isinstance(value, float) and value in (0.0, 1.0) else value


class Scene(ScenePart):
    """Body on a moving belt, shaken: damping_ratio and drive, or a prescribed slip instead of both.

    Nondimensional: times in 1/omega_1, lengths in L, forces in K_1 L, for a mass on a spring K_1.
    ``Scene.si`` makes one in SI units; every other field is then filled from them (Eq. 2).

    Parameters
    ----------
    damping_ratio : float, >= 0, optional
        Damping ratio beta_1 along the belt [-]; may exceed 1. Required unless the slip is prescribed or
        ``body`` has a receptance.
    spring : bool, optional
        False for a body that no spring holds along the belt: its mean friction is then what a constant outer
        force must balance for it to stay. omega_1 is then any unit of frequency.
    normal_load : float, > 0, optional
        Normal load gamma^2 [K_1 L]: friction force per friction coefficient. Required unless the slip is
        prescribed, 1 then.
    belt_speed : float
        Belt speed v_b [omega_1 L].
    drive : Drive, optional
        Force along the belt. Left out of a scene that nothing drives, or that ``belt_vibration`` or
        ``normal_load_variation`` shakes.
    transverse : Transverse, optional
        Motion across the belt; one degree of freedom if left out.
    body : Body, optional
        Nonlinear and viscoelastic parts of the body, or its frequency response; a linear spring and dashpot
        if left out.
    slip : Slip, optional
        Prescribed slip along the belt, instead of ``damping_ratio`` and ``drive``.
    transverse_slip : TransverseSlip, optional
        Prescribed slip across the belt.
    belt_vibration : BeltVibration, optional
        Vibration of the belt; steady if left out.
    normal_load_variation : NormalLoadVariation, optional
        Variation of the normal load in time; constant if left out.
    initial : Initial, optional
        Start of the mass; at rest on the belt with the spring undeflected if left out.
    dimensional : dict, optional
        Values that ``Scene.si`` takes, instead of all other fields.

    Raises
    ------
    WrongValues
        If values make no scene; the message has every mistake.
    TypeError
        If values are given without names.

    References
    ----------
    Source: Sulollari, van Dalen & Cabboi, Eqs. 1 and 2.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> scene.degrees_of_freedom, scene.with_(belt_speed=2).belt_speed
    (1, 2.0)
    """

    damping_ratio: NonNegative | None = None
    spring: Annotated[StrictBool, BeforeValidator(_truth)] | None = None
    normal_load: Annotated[Positive, FORCE] | None = None
    belt_speed: Annotated[Finite, VELOCITY]
    drive: Drive | None = None
    transverse: Transverse | None = None
    body: Body | None = None
    slip: Slip | None = None
    transverse_slip: TransverseSlip | None = None
    belt_vibration: BeltVibration | None = None
    normal_load_variation: NormalLoadVariation | None = None
    initial: Initial | None = None
    dimensional: Dimensional | None = None

    @model_validator(mode="before")
    @classmethod
    def _normal_load_of_a_prescribed_slip(cls, data: Any) -> Any:
        if isinstance(data, dict) and {"slip", "transverse_slip"} & set(data):
            return {"normal_load": 1.0, **data}
        return data

    @model_validator(mode="before")
    @classmethod
    def _from_si_units(cls, data: Any) -> Any:
        """Fill the fields from ``dimensional``; the check of that field reports mistakes inside it."""
        if not isinstance(data, dict) or data.get("dimensional") is None:
            return data
        both = sorted(set(data) & set(cls.model_fields) - {"dimensional"})
        if both:
            raise ValueError("; ".join(f"{name}: leave it out, dimensional gives the scene" for name in both))
        try:
            dimensional = Dimensional.model_validate(data["dimensional"])
        except ValidationError:
            return {"belt_speed": 0.0, **data}
        return {**data, **dimensional.scaled(), "dimensional": dimensional}

    @model_validator(mode="after")
    def _one_kind_of_scene(self) -> Scene:
        prescribed = self.slip is not None or self.transverse_slip is not None
        problems = problems_of_slip(self) if prescribed else self._free_problems()
        if problems:
            raise ValueError("; ".join(problems))
        return self

    def _free_problems(self) -> list[str]:
        measured = BY_TABLE in self.body_terms
        required = ("normal_load",) if measured else ("damping_ratio", "normal_load")
        missing = [f"{name}: required" for name in required if getattr(self, name) is None]
        left = replaced_by_table(self, ["damping_ratio"]) if measured else []
        left += problems_of_free(self, "spring") if self.is_free else []
        return [*missing, *left, *problems_of_parts(self)]

    def _shown(self) -> dict[str, Any]:
        """Return the values that are shown: ``dimensional`` alone if it gives all others."""
        return super()._shown() if self.dimensional is None else {"dimensional": self.dimensional}

    def __repr__(self) -> str:
        """Return the call that makes it again."""
        return super().__repr__() if self.dimensional is None else repr(self.dimensional)

    __str__ = __repr__

    @classmethod
    def si(cls, **values: Any) -> Scene:
        """Make a scene from numbers in SI units.

        Every number may be text with a unit, its key without one: ``belt_speed="2 mm/s"``,
        ``frequency="60 Hz"``. Parts are mappings: ``drive={"amplitude": "20 N", "frequency": "60 Hz"}``.
        ``slip`` and ``transverse_slip`` prescribe a motion in place of mass, spring, dashpot and loads.
        ``body.receptance`` stands for mass, spring and dashpot, too; K_1 is then that of the body at rest, M
        the free mass, or if there is none K_1 over the square of the drive's frequency.

        Parameters
        ----------
        mass_kg : float, > 0, optional
            Mass M [kg]; required unless ``slip``, ``transverse_slip`` or ``body.receptance`` is given.
        stiffness_N_per_m : float, >= 0, optional
            Stiffness K_1 of the spring along the belt [N/m]. With a mass exactly one is given: it or
            ``natural_frequency_rad_per_s``. 0 for a body that no spring holds.
        natural_frequency_rad_per_s : float, > 0, optional
            Natural frequency omega_1 of the mass on that spring [rad/s].
        damping_N_s_per_m : float, >= 0, optional
            Damping C_1 of the dashpot along the belt [N s/m]. At most one is given: it or
            ``damping_ratio``; 0 if both are left out.
        damping_ratio : float, >= 0, optional
            Damping ratio of the motion along the belt [-].
        length_m : float, > 0, optional
            Length scale L of the nondimensional columns [m]; no result in SI units depends on it. If left out it
            is the largest amplitude without friction, of each load and of the belt's vibration as a sine of its
            size; normal load over stiffness if nothing shakes.
        gravity_m_per_s2 : float, > 0, optional
            Gravity [m/s^2]: the normal load is the weight. 9.81 if ``normal_load_N`` is left out.
        normal_load_N : float, > 0, optional
            Normal load [N], instead of ``gravity_m_per_s2``; 1 if left out with a prescribed slip.
        belt_speed_m_per_s : float
            Belt speed V_b [m/s].
        drive : dict, optional
            Force along the belt.
        transverse : dict, optional
            Motion across the belt; one degree of freedom if left out.
        body : dict, optional
            Nonlinear and viscoelastic parts of the body, or its frequency response.
        slip : dict, optional
            Prescribed slip along the belt.
        transverse_slip : dict, optional
            Prescribed slip across the belt.
        belt_vibration : dict, optional
            Vibration of the belt.
        normal_load_variation : dict, optional
            Variation of the normal load in time.
        initial : dict, optional
            Start of the mass; at rest on the belt with the spring undeflected if left out.

        Returns
        -------
        Scene
            Scene; ``scene.dimensional`` has its numbers in SI units.

        Raises
        ------
        WrongValues
            If values make no scene; the message has every mistake.

        References
        ----------
        Source: Sulollari, van Dalen & Cabboi, Eq. 2.

        Examples
        --------
        >>> import frictionlab as fl
        >>> body = {"mass": "1 kg", "stiffness": "400 N/m", "damping": "4 N s/m", "length": "1 mm"}
        >>> drive = {"amplitude": "20 N", "frequency_rad_per_s": 20}
        >>> scene = fl.Scene.si(**body, belt_speed="50 mm/s", drive=drive)
        >>> scene.damping_ratio, scene.normal_load, scene.belt_speed
        (0.1, 24.525, 2.5)
        >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).si["mean_friction_N"], 4)
        0.0332
        """
        return cls(**{"dimensional": Dimensional(**values)})

    @property
    def degrees_of_freedom(self) -> int:
        """Number of degrees of freedom: 0 for a prescribed slip, 1 along the belt alone, 2 in the plane."""
        if self.slip is not None or self.transverse_slip is not None:
            return 0
        return 1 if self.transverse is None else 2

    @property
    def planar(self) -> bool:
        """True if there is an x2, across the belt."""
        if self.degrees_of_freedom > 0:
            return self.transverse is not None
        return self.transverse_slip is not None or bool(self.slip and self.slip.direction)

    @property
    def is_free(self) -> bool:
        """True if no spring holds the body along the belt."""
        return self.spring is False

    @property
    def undriven(self) -> bool:
        """True if no load drives the mass: the period of its motion is then unknown."""
        shaken = self.is_driven or self.belt_vibration or self.normal_load_variation
        return self.degrees_of_freedom > 0 and not shaken

    @property
    def is_driven(self) -> bool:
        """True if ``drive`` has a frequency: if it is more than a constant force."""
        return self.drive is not None and self.drive.frequency is not None

    @property
    def body_terms(self) -> list[str]:
        """Keys of ``body`` that add something to its linear spring and dashpot."""
        return [] if self.body is None else self.body.terms

    @property
    def bends(self) -> bool:
        """True if springs and dashpots of the body are not linear."""
        return not set(BENDING).isdisjoint(self.body_terms)

    @property
    def remembers(self) -> bool:
        """True if the body is known by its frequency response alone: its force depends on earlier motion."""
        return not {*REMEMBERING, BY_TABLE}.isdisjoint(self.body_terms)

    @property
    def start(self) -> Initial:
        """Start of the mass, ``initial``; by default at rest on the belt with the spring undeflected."""
        return self.initial or Initial(velocity=self.belt_speed)

    @property
    def frequency(self) -> float:
        """Frequency of the drive, prescribed slip or another part [omega_1]; 1 for an undriven scene."""
        return frequency_of(self)

    @property
    def periods(self) -> int:
        """Number of periods of the drive after which everything that changes in time has repeated."""
        return periods_of(self)

    @property
    def is_harmonic(self) -> bool:
        """True if loads or a prescribed slip are sines of one frequency and nothing else changes in time."""
        load = self.transverse.load if self.transverse is not None else None
        shapes = [
            part.waveform
            for part in (self.drive, load, self.slip, self.transverse_slip)
            if part is not None and part.waveform is not None
        ]
        constant = all(
            part is None or part.size(1.0) == 0.0
            for part in (self.belt_vibration, self.normal_load_variation)
        )
        one = load is None or load.frequency_ratio in (None, 1.0)
        pushed = any(part is not None and part.offset for part in (self.drive, load))
        return constant and one and not pushed and all(shape == SINE for shape in shapes)

    @property
    def constant_contact(self) -> bool:
        """True if bristles keep their stiffness while the normal load changes."""
        return keeps_stiffness(self.normal_load_variation)

    def signals(self) -> Signals:
        """Return everything that changes in time.

        Returns
        -------
        Signals
            Load, vibration of the belt or oscillation of the slip, and variation of the normal load.
        """
        return self._shaking.signals

    @property
    def _shaking(self) -> Shaking:
        """Excitations, made once for all scenes that differ in belt speed alone."""
        assert self.normal_load is not None
        load = self.transverse.load if self.transverse is not None else None
        parts = self.drive, load, self.slip, self.transverse_slip
        varying = self.belt_vibration, self.normal_load_variation
        return shaking_by(parts, varying, self.frequency, self.periods, self.normal_load, self.is_harmonic)

    @property
    def load_along_belt_only(self) -> bool:
        """True if nothing shakes across the belt: with isotropic friction x2 then decays from every start."""
        if self.degrees_of_freedom == 1:
            return True
        signals = self.signals()
        return signals.load[1] == Signal() and signals.belt[1] == Signal()

    def mass(self) -> Mass:
        """Return the numbers of a free scene for kernels.

        Returns
        -------
        Mass
            Coefficients of the equations of motion and phasors of the loads.

        Raises
        ------
        ValueError
            If no spring holds the body: it is solved on ever softer springs.
        """
        if self.is_free:
            raise ValueError(
                "a body without a spring is solved by runs, curves and steady states: give it a soft one here"
            )
        assert self.normal_load is not None
        damping_ratio = self.damping_ratio or 0.0
        across = self.transverse or Transverse(natural_frequency=1.0, damping_ratio=0.0)
        omega_r, shaking = across.natural_frequency, self._shaking
        along, aside = shaking.load
        mass = Mass(
            damping=2.0 * damping_ratio,
            stiffness=1.0,
            transverse_damping=2.0 * across.damping_ratio * omega_r,
            transverse_stiffness=omega_r**2,
            normal_load=self.normal_load,
            frequency=self.frequency,
            force=along,
            transverse_force=aside,
            varying=shaking.varying,
            bends=self.body.bends(damping_ratio) if self.body is not None else (),
        )
        return with_free_motion(mass) if mass.bends else mass

    def motion(self) -> Motion:
        """Return the numbers of a prescribed slip for kernels.

        Returns
        -------
        Motion
            Normal load, frequency and phasors of the slip velocity.
        """
        assert self.normal_load is not None
        shaking = self._shaking
        return Motion(self.normal_load, self.frequency, *shaking.belt, shaking.varying)

    def values(self) -> dict[str, float | str]:
        """Return every value of the scene by its dotted path.

        Returns
        -------
        dict of str to float or str
            Values by path, without the leading ``scene.``; SI numbers included.
        """
        return _flat(self.model_dump(exclude_none=True))

    def given(self) -> dict[str, Any]:
        """Return values from which the same scene can be made.

        Returns
        -------
        dict of str to Any
            Nested plain values; in SI units if the scene was given in them.
        """
        tree = self.model_dump(exclude_none=True)
        if self.initial is not None:
            # A scene without x2 would refuse the defaults for x2.
            tree["initial"] = self.initial.model_dump(exclude_unset=True)
        if self.dimensional is None:
            return tree
        if self.dimensional.initial is not None:
            tree["dimensional"]["initial"] = self.dimensional.initial.model_dump(exclude_unset=True)
        return {"dimensional": tree["dimensional"]}

    def given_values(self, defaults: bool = True) -> dict[str, float | str]:
        """Return those of ``values`` that were given: only the SI ones if the scene is in SI units.

        Parameters
        ----------
        defaults : bool, default True
            True to include values that are the default.

        Returns
        -------
        dict of str to float or str
            Values by dotted path.
        """
        kept = "" if self.dimensional is None else "dimensional."
        values = _flat(self.model_dump(exclude_none=True, exclude_defaults=not defaults))
        return {path: value for path, value in values.items() if path.startswith(kept)}

    def with_(self, changes: Mapping[str, Any] | None = None, /, **others: Any) -> Scene:
        """Return the same scene with other values.

        A scene in SI units is changed in them: ``with_(mass="2 kg")``.

        Parameters
        ----------
        changes : mapping of str to Any, optional
            New values by dotted path: ``{"drive.frequency": 2}``. None leaves a value out.
        **others : Any
            New values by name: ``normal_load=3``. None leaves a value out.

        Returns
        -------
        Scene
            Scene with the new values.

        Raises
        ------
        WrongValues
            If the values make no scene.
        TypeError
            If ``changes`` is no mapping.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5)
        >>> scene.with_(belt_speed=2, drive=fl.Drive(amplitude=3, frequency=1))
        Scene(damping_ratio=0.1, normal_load=10, belt_speed=2, drive=Drive(amplitude=3, frequency=1))
        """
        if self.dimensional is None:
            return type(self)(**changed(Scene, self, changes, others))
        return type(self).si(**changed(Dimensional, self.dimensional, changes, others, "dimensional."))

    def checked(self) -> Scene:
        """Return the same scene, made again from the values it was given.

        Returns
        -------
        Scene
            Equal scene.

        Raises
        ------
        WrongValues
            If its values make no scene.
        """
        given = given_values(self)
        if given.get("dimensional") is None:
            return type(self)(**given)
        found = type(self)(**{"dimensional": given["dimensional"]})
        other = [name for name in type(self).model_fields if getattr(found, name) != getattr(self, name)]
        return (
            found if not other else type(self)(dimensional=found.dimensional, **{n: given[n] for n in other})
        )

    def at(self, belt_speed: float) -> Scene:
        """Return the same scene at another belt speed.

        Parameters
        ----------
        belt_speed : float
            Belt speed [omega_1 L]; [m/s] if the scene is given in SI units.

        Returns
        -------
        Scene
            Scene with that belt speed.
        """
        if self.dimensional is None:
            return self.model_copy(update={"belt_speed": belt_speed})
        there = self.dimensional.model_copy(update={"belt_speed_m_per_s": belt_speed})
        speed = belt_speed / there.scales.velocity
        return self.model_copy(update={"belt_speed": speed, "dimensional": there})


def _flat(tree: Mapping[str, Any], prefix: str = "") -> dict[str, float | str]:
    """Return nested values by dotted path; a waveform as one text."""
    flat: dict[str, float | str] = {}
    for key, value in tree.items():
        if not isinstance(value, dict):
            flat[f"{prefix}{key}"] = value
        elif key == "waveform":
            flat[f"{prefix}{key}"] = str(form_of(value))
        else:
            flat |= _flat(value, f"{prefix}{key}.")
    return flat


Dimensional.__doc__ = Scene.si.__doc__  # whence studies tell what its keys mean
