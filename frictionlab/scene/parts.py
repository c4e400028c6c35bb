"""The parts of a scene: loads, the motion across the belt, prescribed slips, vibrations and a start.

A number with a dimension says so beside its limits: from that follow its key and its value in SI units
(``dimensional.py``).
"""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from frictionlab.scene.body import Bends
from frictionlab.scene.receptance import TabulatedBody, read_receptance
from frictionlab.scene.units import (
    CUBIC_DAMPING,
    CUBIC_STIFFNESS,
    CURVATURE,
    FORCE,
    FREQUENCY,
    LENGTH,
    MASS,
    STIFFNESS,
    TIME,
    UNBALANCE,
    VELOCITY,
)
from frictionlab.scene.waveforms import SINE, Ratio, Waveform
from frictionlab.values.quantities import Finite, NonNegative, Positive, Record


class ScenePart(Record):
    """A part of a scene; alternatives: names of which exactly one is given, where there are any."""

    alternatives: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def key(cls, name: str) -> str:
        """Under which the part has the value of this nondimensional name."""
        return name

    @model_validator(mode="after")
    def _one_of_the_alternatives(self) -> Self:
        keys = [self.key(name) for name in self.alternatives]
        if keys and sum(getattr(self, key) is not None for key in keys) != 1:
            raise ValueError(f"give exactly one of {' and '.join(keys)}")
        return self


class _Force(ScenePart):
    """A periodic force given by an unbalance or by its amplitude.

    unbalance [L], >= 0: the force has the amplitude unbalance*frequency^2; or instead
    amplitude [K_1 L], >= 0: its amplitude.
    phase [degrees]: the force is the waveform at frequency*tau + phase.
    waveform: sine where left out, square, triangle, sawtooth or {harmonics: [{order, amplitude, phase}, ...]}.

    Waveforms of such a force are compared by Michaux, Ferri & Cunefare (2008).
    """

    alternatives: ClassVar[tuple[str, ...]] = ("unbalance", "amplitude")
    unbalance: Annotated[NonNegative, UNBALANCE] | None = None
    amplitude: Annotated[NonNegative, FORCE] | None = None
    phase: Finite = 0.0
    waveform: Waveform | None = None

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

    frequency: Annotated[Positive, FREQUENCY]
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


class Transverse(ScenePart):
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


Order = Annotated[Positive, Field(le=1.0)]
"""Of a derivative, in (0, 1]."""


class Relaxation(ScenePart):
    """A spring in series with a dashpot, beside spring and dashpot of the body: the standard linear solid.

    It adds the force stiffness*y, y' = x1' - y/time.

    stiffness [K_1], > 0: of the spring, felt by fast motion.
    time [1/omega_1], > 0: in which its force relaxes.
    order [-], 0 < order <= 1: of the derivative of y; below 1 the fractional Zener model.

    >>> import frictionlab as fl
    >>> fl.Relaxation(stiffness=0.5, time=1)
    Relaxation(stiffness=0.5, time=1)
    """

    stiffness: Annotated[Positive, STIFFNESS]
    time: Annotated[Positive, TIME]
    order: Order = 1.0


class Fractional(ScenePart):
    """A force coefficient*D^order x1 beside spring and dashpot: between a spring (order 0) and a dashpot (order 1).

    coefficient [K_1/omega_1^order], > 0: of the derivative, (i omega)^order of a sine (Weyl).
    order [-], 0 < order <= 1: of the derivative.

    >>> import frictionlab as fl
    >>> fl.Fractional(coefficient=0.2, order=0.5)
    Fractional(coefficient=0.2, order=0.5)
    """

    coefficient: Positive
    order: Order


BENDING = "cubic_stiffness", "amplitude_damping", "curvature"
REMEMBERING = "relaxation", "fractional"
BY_TABLE = "receptance"
"""Keys of ``body`` that make it nonlinear, that make it remember, and that stands for all of it."""


def file_alone(given: Any) -> Any:
    """What is given of a receptance by its file alone."""
    return {"file": given} if isinstance(given, str) else given


def digest_of(table: TabulatedBody, known: str, file: str) -> str:
    """Of what a file says. Raises ValueError where another is known."""
    if known and known != table.digest:
        raise ValueError(f"{file} has changed since: leave digest out to take it as it is")
    return table.digest


class Receptance(ScenePart):
    """What a linear body answers, measured or computed by others, in place of its mass, spring and dashpot.

    file: a CSV file with columns frequency [omega_1], real and imaginary [1/K_1] of x1 over force, from frequency 0.
    free_mass [K_1/omega_1^2], > 0: above the last frequency x1 over force is -1/(free_mass frequency^2).
    frequency_unit [omega_1], > 0: of the frequencies of the file; 1 where left out.
    receptance_unit [1/K_1], > 0: of what it says of x1 over force; 1 where left out.
    digest: found where it is left out, of what the file says; a file that says something else is then refused.

    >>> import frictionlab as fl
    >>> fl.Receptance(file="no_such_file.csv")
    Traceback (most recent call last):
    frictionlab.values.notes.WrongValues: Receptance: there is no file no_such_file.csv
    """

    file: str
    free_mass: Annotated[Positive, MASS] | None = None
    frequency_unit: Positive | None = None
    receptance_unit: Positive | None = None
    digest: str = ""

    @model_validator(mode="before")
    @classmethod
    def _file_alone(cls, given: Any) -> Any:
        return file_alone(given)

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        object.__setattr__(self, "digest", digest_of(self._read(), self.digest, self.file))
        return self

    def _read(self) -> TabulatedBody:
        return read_receptance(self.file, self.free_mass, self.frequency_unit is not None)

    def body(self) -> TabulatedBody:
        """The body of the file."""
        table = self._read()
        if self.frequency_unit is None and self.receptance_unit is None:
            return table
        return table.scaled(self.frequency_unit or 1.0, self.receptance_unit or 1.0)


class Body(ScenePart):
    """What of the body is no linear spring or dashpot; it acts along x1, beside spring 1 and damping_ratio.

    cubic_stiffness [K_1/L^2]: k3 of the force k3 x1^3; a spring that hardens, or softens where negative.
    amplitude_damping [K_1/(omega_1 L^2)], >= 0: c of the force c x1^2 x1'.
    curvature [1/L]: r; spring and dashpot follow the strain x1 + r x1^2, their force is
    x1 + 3 r x1^2 + 2 r^2 x1^3 + 2 damping_ratio (1 + 2 r x1)^2 x1' (Amabili, 2018).
    relaxation: a spring in series with a dashpot, the standard linear solid; none where left out.
    fractional: a force between those of a spring and a dashpot; none where left out.
    receptance: instead of mass, spring, damping_ratio and all of the above, a CSV file or {file, free_mass}.

    >>> import frictionlab as fl
    >>> fl.Body(cubic_stiffness=0.01, amplitude_damping=0.02)
    Body(cubic_stiffness=0.01, amplitude_damping=0.02)
    """

    cubic_stiffness: Annotated[Finite, CUBIC_STIFFNESS] = 0.0
    amplitude_damping: Annotated[NonNegative, CUBIC_DAMPING] = 0.0
    curvature: Annotated[Finite, CURVATURE] = 0.0
    relaxation: Relaxation | None = None
    fractional: Fractional | None = None
    receptance: Receptance | None = None

    def bends(self, damping_ratio: float) -> Any:
        """What it adds to the force of spring and dashpot; empty where that is nothing."""
        r = self.curvature
        bends = Bends(
            spring_2=3.0 * r,
            spring_3=self.cubic_stiffness + 2.0 * r**2,
            dashpot_1=8.0 * damping_ratio * r,
            dashpot_2=self.amplitude_damping + 8.0 * damping_ratio * r**2,
        )
        return bends if any(bends) else ()

    @property
    def terms(self) -> list[str]:
        """The keys that add something."""
        return [name for name in type(self).model_fields if getattr(self, name)]


class _Vibration(ScenePart):
    """A velocity that follows a waveform.

    velocity_amplitude [omega_1 L], >= 0: of the velocity that the waveform is of.
    """

    velocity_amplitude: Annotated[NonNegative, VELOCITY]

    def size(self, _frequency: float) -> float:
        """What the waveform is multiplied by."""
        return self.velocity_amplitude


class Slip(_Vibration):
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

    frequency: Annotated[Positive, FREQUENCY]
    phase: Finite = 0.0
    waveform: Waveform | None = None
    direction: Finite | None = None


class TransverseSlip(_Vibration):
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

    phase: Finite = 0.0
    frequency: Annotated[Positive, FREQUENCY] | None = None
    waveform: Waveform | None = None


class BeltVibration(_Vibration):
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

    phase: Finite = 0.0
    waveform: Waveform = SINE
    direction: Finite = 0.0
    frequency_ratio: Ratio | None = None
    frequency: Annotated[Positive, FREQUENCY] | None = None


class NormalLoadVariation(ScenePart):
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
    frequency: Annotated[Positive, FREQUENCY] | None = None

    def size(self, _frequency: float) -> float:
        """What the waveform is multiplied by."""
        return self.amplitude


class Initial(ScenePart):
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

    x: Annotated[Finite, LENGTH] = 0.0
    velocity: Annotated[Finite, VELOCITY] = 0.0
    x2: Annotated[Finite, LENGTH] = 0.0
    velocity2: Annotated[Finite, VELOCITY] = 0.0
