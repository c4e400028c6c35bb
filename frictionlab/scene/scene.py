"""The mass, its springs and dashpots, its loads and the belt it slides on: none, one or two degrees of freedom.

Everything is nondimensional, in the scales of Sulollari, van Dalen & Cabboi, Eq. 2: time 1/omega_1, a length
L, force K_1 L, velocity omega_1 L, energy K_1 L^2. The equations of motion are their Eq. 1,

    x1'' + 2 damping_ratio x1' + x1 + normal_load T1 = load along x1,
    x2'' + 2 damping_ratio_2 omega_r x2' + omega_r^2 x2 + normal_load T2 = load along x2,

with T the friction coefficient of a law at the slip velocity (x1' - belt_speed, x2'), or against a belt that vibrates
and under a normal load that changes where the scene says so; ``body`` adds what is not linear, or remembers.

What shakes a scene, from its parts; read once of all scenes that differ in belt speed alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple, cast

from pydantic import ValidationError, model_validator

from frictionlab.scene.as_written import changed, with_values
from frictionlab.scene.body import Mass, Motion, with_free_motion
from frictionlab.scene.dimensional import Dimensional
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
from frictionlab.scene.rules import periods_of, problems_of_parts, problems_of_slip, replaced_by_table
from frictionlab.scene.signals import FULL_TURN, Signal, Signals, signal_of
from frictionlab.scene.varying import varying_of
from frictionlab.scene.waveforms import SINE, form_of
from frictionlab.values.quantities import Finite, NonNegative, Positive, given_values


class Shaking(NamedTuple):
    """Everything that changes in time, its harmonics at the frequency of the drive along x1 and x2, and what kernels
    are told of what changes otherwise than as one sine; nothing where nothing does."""

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
    (drive, load, slip, across), (belt, normal) = parts, others
    moved = _pair(slip or belt, across, omega)
    variation = _signal(normal, omega).scaled(normal_load)
    signals = Signals(FULL_TURN * periods / omega, _pair(drive, load, omega), moved, variation)
    first, second, third, fourth = (
        each.harmonic(omega, signals.period) for each in (*signals.load, *signals.belt)
    )
    varying = () if is_harmonic else varying_of(signals, omega, keeps_stiffness(normal))
    return Shaking(signals, (first, second), (third, fourth), varying)


def keeps_stiffness(part: NormalLoadVariation | None) -> bool:
    """Whether bristles do while the normal load changes."""
    return part is not None and part.amplitude > 0.0 and part.contact == "constant"


def _signal(part: Any, omega: float) -> Signal:
    """Its waveform, as large as it says; omega: the frequency of the drive."""
    if part is None:
        return Signal()
    ratio = getattr(part, "frequency_ratio", None) or 1.0
    return signal_of(part.waveform or SINE, omega * ratio, part.phase).scaled(part.size(omega))


def _pair(part: Any, across: Any, omega: float) -> tuple[Signal, Signal]:
    """A part and one across the belt: along x1, and along x2."""
    along, aside = _turned(_signal(part, omega), (part and part.direction) or 0.0)
    return along, aside if across is None else _signal(across, omega)


def _turned(signal: Signal, direction: float) -> tuple[Signal, Signal]:
    """Its parts along x1 and x2, where it acts at an angle [degrees] to x1; right angles to the last digit."""
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
"""A scene and what it is made of."""


class Scene(ScenePart):
    """A body on a moving belt, shaken: damping_ratio and drive, or a prescribed slip instead of both.

    damping_ratio [-], >= 0: beta_1, along the belt; may exceed 1.
    normal_load [K_1 L], > 0: gamma^2, friction force per friction coefficient; 1 where left out with prescribed slip.
    belt_speed [omega_1 L]: v_b.

    Nondimensional: times in 1/omega_1, lengths in L, forces in K_1 L, for a mass on a spring K_1.
    Leave ``transverse`` out for one degree of freedom, ``drive`` for a scene that nothing drives, or that
    ``belt_vibration`` or ``normal_load_variation`` shakes. ``dimensional`` gives all of it in SI units instead; every
    other field is then filled from it (Eq. 2).
    Raises WrongValues with every mistake in the values, TypeError for values without names.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> scene.degrees_of_freedom, scene.with_(belt_speed=2).belt_speed
    (1, 2.0)

    Source: Sulollari, van Dalen & Cabboi, Eqs. 1 and 2.
    """

    damping_ratio: NonNegative | None = None
    normal_load: Positive | None = None
    belt_speed: Finite
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
        """Fill the fields from ``dimensional``; mistakes inside it are reported by the check of that field."""
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
        return [*missing, *left, *problems_of_parts(self)]

    def _shown(self) -> dict[str, Any]:
        """``dimensional`` alone where that gives all the rest."""
        return super()._shown() if self.dimensional is None else {"dimensional": self.dimensional}

    @property
    def degrees_of_freedom(self) -> int:
        """0 for a prescribed slip, 1 along the belt alone, 2 in the plane."""
        if self.slip is not None or self.transverse_slip is not None:
            return 0
        return 1 if self.transverse is None else 2

    @property
    def planar(self) -> bool:
        """Whether there is an x2, across the belt."""
        if self.degrees_of_freedom > 0:
            return self.transverse is not None
        return self.transverse_slip is not None or bool(self.slip and self.slip.direction)

    @property
    def undriven(self) -> bool:
        """Whether no load drives the mass: the period of its motion is then unknown."""
        shaken = self.drive or self.belt_vibration or self.normal_load_variation
        return self.degrees_of_freedom > 0 and shaken is None

    @property
    def body_terms(self) -> list[str]:
        """The keys of ``body`` that add something to its linear spring and dashpot."""
        return [] if self.body is None else self.body.terms

    @property
    def bends(self) -> bool:
        """Whether springs and dashpots of the body are not linear."""
        return not set(BENDING).isdisjoint(self.body_terms)

    @property
    def remembers(self) -> bool:
        """Whether the body is known by its frequency response alone, as its force hangs on its motion long before."""
        return not {*REMEMBERING, BY_TABLE}.isdisjoint(self.body_terms)

    @property
    def start(self) -> Initial:
        """``initial``; where it is left out, at rest on the belt with the spring undeflected."""
        return self.initial or Initial(velocity=self.belt_speed)

    @property
    def frequency(self) -> float:
        """Of the drive, of the prescribed slip or of what else gives it [omega_1]; 1 for an undriven scene."""
        slips = self.slip or self.transverse_slip
        for part in (self.drive, slips, self.belt_vibration, self.normal_load_variation):
            if part is not None and part.frequency is not None:
                return part.frequency
        return 1.0

    @property
    def periods(self) -> int:
        """The periods of the drive after which everything that changes in time has repeated."""
        return periods_of(self)

    @property
    def is_harmonic(self) -> bool:
        """Whether loads, or a prescribed slip, are sines of one frequency and nothing else changes in time."""
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
        return constant and one and all(shape == SINE for shape in shapes)

    @property
    def constant_contact(self) -> bool:
        """Whether bristles keep their stiffness while the normal load changes."""
        return keeps_stiffness(self.normal_load_variation)

    def signals(self) -> Signals:
        """Everything that changes in time."""
        return self._shaking.signals

    @property
    def _shaking(self) -> Shaking:
        """What shakes: read once of all scenes that differ in belt speed alone."""
        assert self.normal_load is not None
        load = self.transverse.load if self.transverse is not None else None
        parts = self.drive, load, self.slip, self.transverse_slip
        varying = self.belt_vibration, self.normal_load_variation
        return shaking_by(parts, varying, self.frequency, self.periods, self.normal_load, self.is_harmonic)

    @property
    def load_along_belt_only(self) -> bool:
        """Whether nothing shakes across the belt: with isotropic friction x2 then decays from every start."""
        if self.degrees_of_freedom == 1:
            return True
        signals = self.signals()
        return signals.load[1] == Signal() and signals.belt[1] == Signal()

    def mass(self) -> Mass:
        """The numbers of a free scene."""
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
        """The numbers of a prescribed slip."""
        assert self.normal_load is not None
        shaking = self._shaking
        return Motion(self.normal_load, self.frequency, *shaking.belt, shaking.varying)

    def values(self) -> dict[str, float | str]:
        """Every value of the scene by its dotted path, without the leading ``scene.``; SI numbers included."""
        return _flat(self.model_dump(exclude_none=True))

    def given(self) -> dict[str, Any]:
        """Nested plain values from which the same scene can be built; in SI units if the scene was given in them."""
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
        """Those of ``values`` that were given: only the SI ones where the scene is in SI units.

        defaults: what has its default, too.
        """
        kept = "" if self.dimensional is None else "dimensional."
        told = _flat(self.model_dump(exclude_none=True, exclude_defaults=not defaults))
        return {path: value for path, value in told.items() if path.startswith(kept)}

    def with_(self, changes: Mapping[str, Any] | None = None, /, **others: Any) -> Scene:
        """The same scene with other values: ``with_({"drive.frequency": 2}, normal_load=3)``; None leaves one out.

        A scene in SI units is changed in them: ``with_({"dimensional.mass": "2 kg"})``.

        >>> import frictionlab as fl
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5)
        >>> scene.with_(belt_speed=2, drive=fl.Drive(amplitude=3, frequency=1))
        Scene(damping_ratio=0.1, normal_load=10, belt_speed=2, drive=Drive(amplitude=3, frequency=1))

        Raises WrongValues, TypeError.
        """
        given = given_values(self)
        tree = given if self.dimensional is None else {"dimensional": given["dimensional"]}
        return cast(Scene, changed(self, tree, changes, others))

    def checked(self) -> Scene:
        """The same scene, made again from what it was given: raises WrongValues where its values make no scene."""
        given = given_values(self)
        if given.get("dimensional") is None:
            return type(self)(**given)
        found = type(self)(**{"dimensional": given["dimensional"]})
        other = [name for name in type(self).model_fields if getattr(found, name) != getattr(self, name)]
        return (
            found if not other else type(self)(dimensional=found.dimensional, **{n: given[n] for n in other})
        )

    def at(self, belt_speed: float) -> Scene:
        """The same scene at another belt speed: [m/s] where the scene is given in SI units."""
        if self.dimensional is None:
            return self.model_copy(update={"belt_speed": belt_speed})
        there = self.dimensional.model_copy(update={"belt_speed_m_per_s": belt_speed})
        speed = belt_speed / there.scales.velocity
        return self.model_copy(update={"belt_speed": speed, "dimensional": there})


def _flat(tree: Mapping[str, Any], prefix: str = "") -> dict[str, float | str]:
    """Nested values by dotted path; a sum of harmonics as one text."""
    flat: dict[str, float | str] = {}
    for key, value in tree.items():
        if not isinstance(value, dict):
            flat[f"{prefix}{key}"] = value
        elif "harmonics" in value:
            flat[f"{prefix}{key}"] = str(form_of(value))
        else:
            flat |= _flat(value, f"{prefix}{key}.")
    return flat
