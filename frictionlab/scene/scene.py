"""The mass, its springs and dashpots, its loads and the belt it slides on: none, one or two degrees of freedom.

Everything is nondimensional, in the scales of Sulollari, van Dalen & Cabboi, Eq. 2: time 1/omega_1, a length
L, force K_1 L, velocity omega_1 L, energy K_1 L^2. The equations of motion are their Eq. 1,

    x1'' + 2 damping_ratio x1' + x1 + normal_load T1 = load along x1,
    x2'' + 2 damping_ratio_2 omega_r x2' + omega_r^2 x2 + normal_load T2 = load along x2,

with T the friction coefficient of a law at the slip velocity (x1' - belt_speed, x2').
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from typing import Any, ClassVar

from pydantic import ValidationError, model_validator

from frictionlab.quantities import Finite, NonNegative, Positive, Record, given_values
from frictionlab.scene.body import Mass, Motion
from frictionlab.scene.dimensional import Dimensional


class _Part(Record):
    """A part of a scene; reports planned keys as not available yet instead of as unknown."""

    not_available_yet: ClassVar[frozenset[str]] = frozenset()

    @model_validator(mode="before")
    @classmethod
    def _refuse_what_has_not_come(cls, data: Any) -> Any:
        for key in sorted(cls.not_available_yet & set(data)) if isinstance(data, dict) else ():
            raise ValueError(f"{key}: not available yet")
        return data


class _Force(_Part):
    """A harmonic force given by an unbalance or by its amplitude."""

    unbalance: NonNegative | None = None
    amplitude: NonNegative | None = None
    phase: Finite = 0.0

    @model_validator(mode="after")
    def _one_of_two(self) -> _Force:
        if (self.unbalance is None) == (self.amplitude is None):
            raise ValueError("give exactly one of unbalance and amplitude")
        return self

    def phasor(self, frequency: float) -> complex:
        """F of the force Im(F exp(i frequency tau)) [force scale K_1 L]."""
        size = self.amplitude if self.unbalance is None else self.unbalance * frequency**2
        assert size is not None
        return cmath.rect(size, math.radians(self.phase))


class Drive(_Force):
    """The force along x1: unbalance*frequency^2 (or amplitude) times sin(frequency*tau + phase).

    unbalance [L] or amplitude [K_1 L], >= 0; frequency [omega_1], > 0; phase [degrees].
    """

    not_available_yet: ClassVar[frozenset[str]] = frozenset({"waveform", "direction"})

    frequency: Positive


class Load(_Force):
    """The force along x2, at the frequency of the drive; units as for ``Drive``."""

    not_available_yet: ClassVar[frozenset[str]] = frozenset({"waveform", "frequency"})


class Transverse(_Part):
    """The motion along x2, across the belt: natural_frequency [omega_1] > 0, damping_ratio >= 0, its load."""

    natural_frequency: Positive
    damping_ratio: NonNegative
    load: Load | None = None


class Slip(_Part):
    """Prescribed oscillation along x1: velocity_amplitude*sin(frequency*tau + phase). Phase in degrees."""

    velocity_amplitude: NonNegative
    frequency: Positive
    phase: Finite = 0.0


class TransverseSlip(_Part):
    """Prescribed oscillation along x2; a frequency of its own only where there is none along x1."""

    velocity_amplitude: NonNegative
    phase: Finite = 0.0
    frequency: Positive | None = None


class Initial(_Part):
    """Where the mass starts, for scenes whose steady state depends on it: positions [L], velocities."""

    x: Finite = 0.0
    velocity: Finite = 0.0
    x2: Finite = 0.0
    velocity2: Finite = 0.0


class Scene(_Part):
    """A body on a moving belt, shaken: damping_ratio and drive, or a prescribed slip instead of both.

    damping_ratio (>= 0, may exceed 1), normal_load (gamma^2 > 0; 1 by default for prescribed slip), belt_speed.
    Leave ``transverse`` out for one degree of freedom, ``drive`` for an undriven scene. ``dimensional``
    gives all of it in SI units instead; every other field is then filled from it (Eq. 2).
    """

    damping_ratio: NonNegative | None = None
    normal_load: Positive | None = None
    belt_speed: Finite
    drive: Drive | None = None
    transverse: Transverse | None = None
    slip: Slip | None = None
    transverse_slip: TransverseSlip | None = None
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
        problems = self._prescribed_problems() if prescribed else self._free_problems()
        if problems:
            raise ValueError("; ".join(problems))
        return self

    def _prescribed_problems(self) -> list[str]:
        for name in ("damping_ratio", "drive", "transverse", "initial"):
            if getattr(self, name) is not None:
                return [f"{name}: leave it out with a prescribed slip"]
        own = self.transverse_slip.frequency if self.transverse_slip is not None else None
        if self.slip is not None and own is not None:
            return ["transverse_slip.frequency: leave it out, slip.frequency holds for both"]
        if self.slip is None and own is None:
            return ["transverse_slip.frequency: required where slip is left out"]
        return []

    def _free_problems(self) -> list[str]:
        missing = [name for name in ("damping_ratio", "normal_load") if getattr(self, name) is None]
        problems = [f"{name}: required" for name in missing]
        if self.drive is None and self.transverse is not None and self.transverse.load is not None:
            problems.append("transverse.load: leave it out where drive is left out (an undriven scene)")
        if self.initial is not None and self.transverse is None:
            stray = {"x2", "velocity2"} & self.initial.model_fields_set
            problems += [f"initial.{name}: needs transverse" for name in sorted(stray)]
        return problems

    @property
    def degrees_of_freedom(self) -> int:
        """0 for a prescribed slip, 1 along the belt alone, 2 in the plane."""
        if self.slip is not None or self.transverse_slip is not None:
            return 0
        return 1 if self.transverse is None else 2

    @property
    def undriven(self) -> bool:
        """Whether no load drives the mass: the period of its motion is then unknown."""
        return self.degrees_of_freedom > 0 and self.drive is None

    @property
    def start(self) -> Initial:
        """``initial``; where it is left out, at rest on the belt with the spring undeflected."""
        return self.initial or Initial(velocity=self.belt_speed)

    @property
    def frequency(self) -> float:
        """Of the drive, or of the prescribed slip [omega_1]; 1, the unit, for an undriven scene."""
        part = self.drive or self.slip or self.transverse_slip
        if part is None:
            return 1.0
        assert part.frequency is not None
        return part.frequency

    @property
    def load_along_belt_only(self) -> bool:
        """Whether no load acts across the belt: with isotropic friction x2 then decays from every start."""
        if self.degrees_of_freedom == 0:
            return self.transverse_slip is None or self.transverse_slip.velocity_amplitude == 0
        load = self.transverse.load if self.transverse is not None else None
        return load is None or load.phasor(self.frequency) == 0

    def mass(self) -> Mass:
        """The numbers of a free scene."""
        assert self.damping_ratio is not None
        assert self.normal_load is not None
        across = self.transverse or Transverse(natural_frequency=1.0, damping_ratio=0.0)
        omega_r = across.natural_frequency
        return Mass(
            damping=2.0 * self.damping_ratio,
            stiffness=1.0,
            transverse_damping=2.0 * across.damping_ratio * omega_r,
            transverse_stiffness=omega_r**2,
            normal_load=self.normal_load,
            frequency=self.frequency,
            force=self.drive.phasor(self.frequency) if self.drive is not None else 0j,
            transverse_force=across.load.phasor(self.frequency) if across.load is not None else 0j,
        )

    def motion(self) -> Motion:
        """The numbers of a prescribed slip."""
        assert self.normal_load is not None
        phasors = [
            cmath.rect(part.velocity_amplitude, math.radians(part.phase)) if part is not None else 0j
            for part in (self.slip, self.transverse_slip)
        ]
        return Motion(self.normal_load, self.frequency, *phasors)

    def values(self) -> dict[str, float]:
        """Every number of the scene by its dotted path, without the leading ``scene.``; SI numbers included."""
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

    def given_values(self) -> dict[str, float]:
        """Those of ``values`` that were given: only the SI ones where the scene is in SI units."""
        kept = "" if self.dimensional is None else "dimensional."
        return {path: value for path, value in self.values().items() if path.startswith(kept)}

    def with_(self, **changes: Any) -> Scene:
        """The same scene with other values: ``with_(normal_load=3, **{"drive.frequency": 2})``; None leaves one out.

        Raises WrongValues. A scene in SI units is changed in them: ``**{"dimensional.mass_kg": 2}``.
        """
        given = given_values(self)
        tree = given if self.dimensional is None else {"dimensional": given["dimensional"]}
        return type(self)(**with_values(tree, changes))

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
        return self.model_copy(update={"belt_speed": there.scaled()["belt_speed"], "dimensional": there})


def with_values(tree: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of nested values with some replaced, by dotted path."""
    new = dict(tree)
    for path, value in values.items():
        head, _, rest = path.partition(".")
        held = new.get(head) if rest else None
        inside = given_values(held) if isinstance(held, Record) else held
        new[head] = (
            with_values(inside if isinstance(inside, Mapping) else {}, {rest: value}) if rest else value
        )
    return new


def _flat(tree: dict[str, Any], prefix: str = "") -> dict[str, float]:
    flat: dict[str, float] = {}
    for key, value in tree.items():
        flat |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat
