"""The mass, its springs and dashpots, its loads and the belt it slides on: none, one or two degrees of freedom.

Everything is nondimensional, in the scales of Sulollari, van Dalen & Cabboi, Eq. 2: time 1/omega_1, a length
L, force K_1 L, velocity omega_1 L, energy K_1 L^2. The equations of motion are their Eq. 1,

    x1'' + 2 damping_ratio x1' + x1 + normal_load T1 = load along x1,
    x2'' + 2 damping_ratio_2 omega_r x2' + omega_r^2 x2 + normal_load T2 = load along x2,

with T the friction coefficient of a law at the slip velocity (x1' - belt_speed, x2'), or against a belt that vibrates
and under a normal load that changes where the scene says so.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, ClassVar, Literal, NamedTuple

from pydantic import ValidationError, model_validator

from frictionlab.quantities import Finite, NonNegative, Positive, Record, given_values
from frictionlab.scene.body import Mass, Motion
from frictionlab.scene.dimensional import Dimensional
from frictionlab.scene.rules import (
    periods_of,
    problems_of_frequencies,
    problems_of_parts,
    problems_of_variation,
)
from frictionlab.scene.signals import FULL_TURN, Signal, Signals, signal_of
from frictionlab.scene.varying import varying_of
from frictionlab.scene.waveforms import SINE, Ratio, Waveform, form_of


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
    """A periodic force given by an unbalance or by its amplitude.

    unbalance [L], >= 0: the force has the amplitude unbalance*frequency^2; or instead
    amplitude [K_1 L], >= 0: its amplitude.
    phase [degrees]: the force is the waveform at frequency*tau + phase.
    waveform: sine where left out, square, triangle, sawtooth or {harmonics: [{order, amplitude, phase}, ...]}.

    Waveforms of such a force are compared by Michaux, Ferri & Cunefare (2008).
    """

    unbalance: NonNegative | None = None
    amplitude: NonNegative | None = None
    phase: Finite = 0.0
    waveform: Waveform | None = None

    @model_validator(mode="after")
    def _one_of_two(self) -> _Force:
        if (self.unbalance is None) == (self.amplitude is None):
            raise ValueError("give exactly one of unbalance and amplitude")
        return self

    def size(self, frequency: float) -> float:
        """What the waveform is multiplied by [K_1 L]; frequency: that of the drive."""
        size = self.amplitude if self.unbalance is None else self.unbalance * frequency**2
        assert size is not None
        return size

    def phasor(self, frequency: float) -> complex:
        """F of the sine Im(F exp(i frequency tau)) [K_1 L]."""
        return cmath.rect(self.size(frequency), math.radians(self.phase))


class Drive(_Force):
    """The force along x1: unbalance*frequency^2 (or amplitude) times waveform(frequency*tau + phase).

    unbalance [L], >= 0: the force has the amplitude unbalance*frequency^2; or instead
    amplitude [K_1 L], >= 0: its amplitude.
    phase [degrees]: the force is the waveform at frequency*tau + phase.
    waveform: sine where left out, square, triangle, sawtooth or {harmonics: [{order, amplitude, phase}, ...]}.
    frequency [omega_1], > 0: of the drive; everything else that vibrates has it in some ratio.
    direction [degrees]: from x1 towards x2, in scenes with ``transverse``; along x1 where left out.

    >>> import frictionlab as fl
    >>> fl.Drive(unbalance=10, frequency=2).size(2)
    40.0
    >>> fl.Drive(amplitude=3, frequency=2, waveform="square", phase=90)
    Drive(amplitude=3, phase=90, waveform='square', frequency=2)

    Waveforms of such a force are compared by Michaux, Ferri & Cunefare (2008).
    """

    frequency: Positive
    direction: Finite | None = None


class Load(_Force):
    """The force along x2, across the belt, beside a drive along x1.

    unbalance [L], >= 0: the force has the amplitude unbalance*(frequency of the drive)^2; or instead
    amplitude [K_1 L], >= 0: its amplitude.
    phase [degrees]: the force is the waveform at its frequency*tau + phase.
    waveform: sine where left out, square, triangle, sawtooth or {harmonics: [{order, amplitude, phase}, ...]}.
    frequency_ratio [-]: its frequency in shares of the drive's, p/q; 1 where left out.

    >>> import frictionlab as fl
    >>> fl.Load(amplitude=3, frequency_ratio="3/2", phase=90)
    Load(amplitude=3, phase=90, frequency_ratio=1.5)
    """

    frequency_ratio: Ratio | None = None


class Transverse(_Part):
    """The motion along x2, across the belt: a second degree of freedom, which friction couples to the first.

    natural_frequency [omega_1], > 0: omega_r, of the motion along x2.
    damping_ratio [-], >= 0: of the motion along x2.
    load: the force along x2; none where left out.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> across = fl.Transverse(natural_frequency=0.5, damping_ratio=0.1, load=fl.Load(unbalance=10))
    >>> round(fl.steady_state(scene.with_(transverse=across), fl.Coulomb(mu=0.4)).mean_friction, 4)
    0.0426

    Source: Sulollari, van Dalen & Cabboi, Eqs. 1 and 2.
    """

    natural_frequency: Positive
    damping_ratio: NonNegative
    load: Load | None = None


class Slip(_Part):
    """Prescribed slip along the belt: -belt_speed + velocity_amplitude*waveform(frequency*tau + phase).

    velocity_amplitude [omega_1 L], >= 0: of the slip velocity beside the belt's.
    frequency [omega_1], > 0: of the oscillation.
    phase [degrees]: the slip velocity is the waveform at frequency*tau + phase.
    waveform: of the slip velocity; sine where left out, square, triangle, sawtooth or {harmonics: [...]}.
    direction [degrees]: from x1 towards x2; along x1 where left out.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction, 4)
    0.1333
    """

    velocity_amplitude: NonNegative
    frequency: Positive
    phase: Finite = 0.0
    waveform: Waveform | None = None
    direction: Finite | None = None


class TransverseSlip(_Part):
    """Prescribed oscillation along x2, across the belt.

    velocity_amplitude [omega_1 L], >= 0: of the slip velocity along x2.
    phase [degrees]: the slip velocity is the waveform at frequency*tau + phase.
    frequency [omega_1], > 0: only where ``slip`` is left out, whose frequency else holds for both.
    waveform: of the slip velocity; sine where left out, square, triangle, sawtooth or {harmonics: [...]}.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(belt_speed=1, transverse_slip=fl.TransverseSlip(velocity_amplitude=2, frequency=1))
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction, 4)
    0.2571
    """

    velocity_amplitude: NonNegative
    phase: Finite = 0.0
    frequency: Positive | None = None
    waveform: Waveform | None = None


class BeltVibration(_Part):
    """The belt's velocity beside belt_speed: velocity_amplitude*waveform(ratio*frequency*tau + phase).

    velocity_amplitude [omega_1 L], >= 0: of the belt's vibration.
    phase [degrees]: the belt's vibration is the waveform at its frequency*tau + phase.
    waveform: of the velocity; sine where left out, square, triangle, sawtooth or {harmonics: [...]}.
    direction [degrees]: from x1 towards x2, in scenes with ``transverse``; along x1 where left out.
    frequency_ratio [-]: its frequency in shares of the drive's, p/q; 1 where left out.
    frequency [omega_1], > 0: only where nothing else has one.

    A slider pulled through its spring over a vibrating plate, in any direction, is this scene
    (Gutowski & Leus, 2020).

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> scene = scene.with_(belt_vibration=fl.BeltVibration(velocity_amplitude=2))
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction, 4)
    0.0548
    """

    velocity_amplitude: NonNegative
    phase: Finite = 0.0
    waveform: Waveform = SINE
    direction: Finite = 0.0
    frequency_ratio: Ratio | None = None
    frequency: Positive | None = None


class NormalLoadVariation(_Part):
    """The normal load as normal_load*(1 + amplitude*waveform(ratio*frequency*tau + phase)), always positive.

    amplitude [-], >= 0: the varying share of the normal load.
    phase [degrees]: the share is the waveform at its frequency*tau + phase.
    waveform: sine where left out, square, triangle, sawtooth or {harmonics: [...]}.
    frequency_ratio [-]: its frequency in shares of the drive's, p/q; 1 where left out.
    frequency [omega_1], > 0: only where nothing else has one.
    contact: ``per_load``, the stiffness and damping of bristles follow the load, as in laws per unit normal load
    (Canudas de Wit & Tsiotras, 1999); ``constant``, they stay those of the mean load, and the load changes the limit
    of friction alone (a spring in series with Coulomb friction, as in Teidelt, Starcevic & Popov, 2012, Popov, Popov
    & Popov, 2017, and Mao et al., 2017).

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> scene = scene.with_(normal_load_variation=fl.NormalLoadVariation(amplitude=0.3))
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction, 4)
    -0.0245
    """

    amplitude: NonNegative
    phase: Finite = 0.0
    waveform: Waveform = SINE
    frequency_ratio: Ratio | None = None
    contact: Literal["per_load", "constant"] = "per_load"
    frequency: Positive | None = None


class Initial(_Part):
    """Where the mass starts, for scenes whose steady state depends on it.

    x [L]: position along the belt, from where the spring is undeflected.
    velocity [omega_1 L]: along the belt.
    x2 [L]: position across the belt.
    velocity2 [omega_1 L]: across the belt.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> motion = fl.trajectory(scene, fl.Coulomb(mu=0.4), periods=1, initial=fl.Initial(x=3, velocity=1))
    >>> motion[["tau", "x1", "v1"]].values.tolist()[0]
    [0.0, 3.0, 1.0]
    """

    x: Finite = 0.0
    velocity: Finite = 0.0
    x2: Finite = 0.0
    velocity2: Finite = 0.0


class Scene(_Part):
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
        problems = self._prescribed_problems() if prescribed else self._free_problems()
        if problems:
            raise ValueError("; ".join(problems))
        return self

    def _prescribed_problems(self) -> list[str]:
        for name in ("damping_ratio", "drive", "transverse", "initial", "belt_vibration"):
            if getattr(self, name) is not None:
                return [f"{name}: leave it out with a prescribed slip"]
        if self.transverse_slip is not None and self.slip is not None and self.slip.direction is not None:
            return ["slip.direction: leave it out with transverse_slip"]
        own = self.transverse_slip.frequency if self.transverse_slip is not None else None
        if self.slip is not None and own is not None:
            return ["transverse_slip.frequency: leave it out, slip.frequency holds for both"]
        if self.slip is None and own is None:
            return ["transverse_slip.frequency: required where slip is left out"]
        given = "slip" if self.slip is not None else "transverse_slip"
        return [*problems_of_frequencies(self, "frequency", given)] or problems_of_variation(self)

    def _free_problems(self) -> list[str]:
        missing = [name for name in ("damping_ratio", "normal_load") if getattr(self, name) is None]
        return [*(f"{name}: required" for name in missing), *problems_of_parts(self, "frequency")]

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
            part is None or _size(part) == 0.0 for part in (self.belt_vibration, self.normal_load_variation)
        )
        one = load is None or load.frequency_ratio in (None, 1.0)
        return constant and one and all(shape == SINE for shape in shapes)

    @property
    def constant_contact(self) -> bool:
        """Whether bristles keep their stiffness while the normal load changes."""
        return _keeps_stiffness(self.normal_load_variation)

    def signals(self) -> Signals:
        """Everything that changes in time."""
        return self._shaking.signals

    @property
    def _shaking(self) -> _Shaking:
        """What shakes: read once of all scenes that differ in belt speed alone."""
        assert self.normal_load is not None
        load = self.transverse.load if self.transverse is not None else None
        parts = self.drive, load, self.slip, self.transverse_slip
        varying = self.belt_vibration, self.normal_load_variation
        return _shaking_by(parts, varying, self.frequency, self.periods, self.normal_load, self.is_harmonic)

    @property
    def load_along_belt_only(self) -> bool:
        """Whether nothing shakes across the belt: with isotropic friction x2 then decays from every start."""
        if self.degrees_of_freedom == 1:
            return True
        signals = self.signals()
        return signals.load[1] == Signal() and signals.belt[1] == Signal()

    def mass(self) -> Mass:
        """The numbers of a free scene."""
        assert self.damping_ratio is not None
        assert self.normal_load is not None
        across = self.transverse or Transverse(natural_frequency=1.0, damping_ratio=0.0)
        omega_r, shaking = across.natural_frequency, self._shaking
        along, aside = shaking.load
        return Mass(
            damping=2.0 * self.damping_ratio,
            stiffness=1.0,
            transverse_damping=2.0 * across.damping_ratio * omega_r,
            transverse_stiffness=omega_r**2,
            normal_load=self.normal_load,
            frequency=self.frequency,
            force=along,
            transverse_force=aside,
            varying=shaking.varying,
        )

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

    def given_values(self) -> dict[str, float | str]:
        """Those of ``values`` that were given: only the SI ones where the scene is in SI units."""
        kept = "" if self.dimensional is None else "dimensional."
        return {path: value for path, value in self.values().items() if path.startswith(kept)}

    def with_(self, changes: Mapping[str, Any] | None = None, /, **others: Any) -> Scene:
        """The same scene with other values: ``with_({"drive.frequency": 2}, normal_load=3)``; None leaves one out.

        A scene in SI units is changed in them: ``with_({"dimensional.mass_kg": 2})``.

        >>> import frictionlab as fl
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5)
        >>> scene.with_(belt_speed=2, drive=fl.Drive(amplitude=3, frequency=1))
        Scene(damping_ratio=0.1, normal_load=10, belt_speed=2, drive=Drive(amplitude=3, frequency=1))

        Raises WrongValues, TypeError.
        """
        if changes is not None and not isinstance(changes, Mapping):
            raise TypeError("with_ takes values by name, belt_speed=2, or by path, {'drive.frequency': 2}")
        given = given_values(self)
        tree = given if self.dimensional is None else {"dimensional": given["dimensional"]}
        return type(self)(**with_values(tree, {**(changes or {}), **others}))

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


def _size(part: BeltVibration | NormalLoadVariation) -> float:
    return part.velocity_amplitude if isinstance(part, BeltVibration) else part.amplitude


def _varying(part: BeltVibration | NormalLoadVariation | None, omega: float) -> Signal:
    """Its waveform, as large as it says; omega: the frequency of the drive."""
    if part is None:
        return Signal()
    return signal_of(part.waveform, omega * (part.frequency_ratio or 1.0), part.phase).scaled(_size(part))


class _Shaking(NamedTuple):
    """Everything that changes in time, its harmonics at the frequency of the drive along x1 and x2, and what kernels
    are told of what changes otherwise than as one sine; nothing where nothing does."""

    signals: Signals
    load: tuple[complex, complex]
    belt: tuple[complex, complex]
    varying: Any


@lru_cache(maxsize=1024)
def _shaking_by(
    parts: tuple[Drive | None, Load | None, Slip | None, TransverseSlip | None],
    others: tuple[BeltVibration | None, NormalLoadVariation | None],
    omega: float,
    periods: int,
    normal_load: float,
    is_harmonic: bool,
) -> _Shaking:
    (drive, load, slip, across), (belt, normal) = parts, others
    if slip is not None or across is not None:
        moved = _slips(slip, across, omega)
    else:
        moved = _turned(_varying(belt, omega), belt.direction if belt is not None else 0.0)
    variation = _varying(normal, omega).scaled(normal_load)
    signals = Signals(FULL_TURN * periods / omega, _loads(drive, load, omega), moved, variation)
    first, second, third, fourth = (
        each.harmonic(omega, signals.period) for each in (*signals.load, *signals.belt)
    )
    varying = () if is_harmonic else varying_of(signals, omega, _keeps_stiffness(normal))
    return _Shaking(signals, (first, second), (third, fourth), varying)


def _keeps_stiffness(part: NormalLoadVariation | None) -> bool:
    """Whether bristles do while the normal load changes."""
    return part is not None and part.amplitude > 0.0 and part.contact == "constant"


def _loads(drive: Drive | None, load: Load | None, omega: float) -> tuple[Signal, Signal]:
    if drive is None:
        return Signal(), Signal()
    whole = signal_of(drive.waveform or SINE, omega, drive.phase).scaled(drive.size(omega))
    along, across = _turned(whole, drive.direction or 0.0)
    if load is not None:
        own = signal_of(load.waveform or SINE, omega * (load.frequency_ratio or 1.0), load.phase)
        across = own.scaled(load.size(omega))
    return along, across


def _slips(slip: Slip | None, across: TransverseSlip | None, omega: float) -> tuple[Signal, Signal]:
    parts = [
        signal_of(part.waveform or SINE, omega, part.phase).scaled(part.velocity_amplitude)
        if part is not None
        else Signal()
        for part in (slip, across)
    ]
    if slip is not None and slip.direction is not None:
        return _turned(parts[0], slip.direction)
    return parts[0], parts[1]


def _turned(signal: Signal, direction: float) -> tuple[Signal, Signal]:
    """Its parts along x1 and x2, where it acts at an angle [degrees] to x1; right angles to the last digit."""
    quarters, rest = divmod(direction, 90.0)
    along, across = (
        (1.0, 0.0) if rest == 0.0 else (math.cos(math.radians(rest)), math.sin(math.radians(rest)))
    )
    for _ in range(int(quarters) % 4):
        along, across = -across, along
    return signal.scaled(along), signal.scaled(across)
