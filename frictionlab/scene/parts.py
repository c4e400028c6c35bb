"""Parts of a scene: loads, motion across the belt, prescribed slips, vibrations and a start.

The annotation of a field states its limits and its dimension. ``dimensional.py`` derives the key and the
value in SI units from the dimension.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
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

OF_WHAT_VARIES = "phase", "waveform", "frequency_ratio"
"""Keys that say nothing of a constant force."""


class ScenePart(Record):
    """Part of a scene.

    ``alternatives`` names fields of which exactly one is given, or none where ``alone`` is; both are empty if
    there are none.
    """

    alternatives: ClassVar[tuple[str, ...]] = ()
    alone: ClassVar[str] = ""

    @classmethod
    def key(cls, name: str) -> str:
        """Return the name in this class of a nondimensional field; in SI units it ends in the unit."""
        return name

    @model_validator(mode="before")
    @classmethod
    def _without_frequency(cls, data: Any) -> Any:
        """Leave the frequency out of what does not change in time."""
        if not cls.alone or not isinstance(data, Mapping) or data.get(cls.key(cls.alone)) is None:
            return data
        frequency, sizes = cls.key("frequency"), map(cls.key, cls.alternatives)
        lacks = frequency in cls.model_fields and all(data.get(key) is None for key in sizes)
        return {frequency: None, **data} if lacks else data

    @model_validator(mode="after")
    def _one_of_the_alternatives(self) -> Self:
        keys = [self.key(name) for name in self.alternatives]
        count = sum(getattr(self, key) is not None for key in keys)
        enough = 0 if self.alone and getattr(self, self.key(self.alone)) is not None else 1
        if keys and not enough <= count <= 1:
            raise ValueError(f"give exactly one of {' and '.join(keys)}")
        stray = [name for name in OF_WHAT_VARIES if keys and count == 0 and getattr(self, name, None)]
        if stray:
            raise ValueError(f"{stray[0]}: is of a force that varies: give {' or '.join(keys)}")
        return self


class _Force(ScenePart):
    """Periodic force given by an unbalance or by its amplitude.

    Parameters
    ----------
    unbalance : float, >= 0, optional
        Unbalance [L]: the force has the amplitude unbalance*frequency^2.
    amplitude : float, >= 0, optional
        Amplitude of the force [K_1 L]. Exactly one is given: it or ``unbalance``.
    phase : float, default 0
        Phase added to frequency*tau in the argument of the waveform [degrees].
    waveform : str or dict, optional
        Waveform: "sine", "square", "triangle", "sawtooth", {square: {duty}}, {sawtooth: {width}},
        {points: [[share, value], ...]}, {file: PATH} or {harmonics: [{order, amplitude, phase}, ...]};
        sine if left out.
    offset : float, optional
        Constant force beside the periodic one [K_1 L]; zero if left out.

    References
    ----------
    Waveforms of such a force are compared by Michaux, Ferri & Cunefare (2008).
    """

    alternatives: ClassVar[tuple[str, ...]] = ("unbalance", "amplitude")
    alone: ClassVar[str] = "offset"
    unbalance: Annotated[NonNegative, UNBALANCE] | None = None
    amplitude: Annotated[NonNegative, FORCE] | None = None
    phase: Finite = 0.0
    waveform: Waveform | None = None
    offset: Annotated[Finite, FORCE] | None = None

    def size(self, frequency: float) -> float:
        """Return the amplitude by which the waveform is multiplied; 0 of an offset alone.

        Parameters
        ----------
        frequency : float, > 0
            Frequency of the drive [omega_1].

        Returns
        -------
        float
            Amplitude of the force [K_1 L].
        """
        return self.amplitude or 0.0 if self.unbalance is None else self.unbalance * frequency**2

    def phasor(self, frequency: float) -> complex:
        """Compute the phasor F of a sine Im(F exp(i frequency tau)).

        Parameters
        ----------
        frequency : float, > 0
            Frequency of the drive [omega_1].

        Returns
        -------
        complex
            Phasor [K_1 L].
        """
        return cmath.rect(self.size(frequency), math.radians(self.phase))


class Drive(_Force):
    """Force along x1: unbalance*frequency^2 (or amplitude) times waveform(frequency*tau + phase).

    Parameters
    ----------
    unbalance : float, >= 0, optional
        Unbalance [L]: the force has the amplitude unbalance*frequency^2.
    amplitude : float, >= 0, optional
        Amplitude of the force [K_1 L]. Exactly one is given: it or ``unbalance``.
    phase : float, default 0
        Phase added to frequency*tau in the argument of the waveform [degrees].
    waveform : str or dict, optional
        Waveform: "sine", "square", "triangle", "sawtooth", {square: {duty}}, {sawtooth: {width}},
        {points: [[share, value], ...]}, {file: PATH} or {harmonics: [{order, amplitude, phase}, ...]};
        sine if left out.
    offset : float, optional
        Constant force beside the periodic one [K_1 L], such as the weight on an incline; zero if left out. It
        may stand alone where the belt or the normal load vibrates.
    frequency : float, > 0, optional
        Frequency of the drive [omega_1]; other vibrations have the same frequency or a multiple p/q of it.
        Required but for an ``offset`` alone.
    direction : float, optional
        Direction of the force, from x1 towards x2, in scenes with ``transverse`` [degrees]; along x1 if left
        out.

    References
    ----------
    Waveforms of such a force are compared by Michaux, Ferri & Cunefare (2008).

    Examples
    --------
    >>> import frictionlab as fl
    >>> fl.Drive(unbalance=10, frequency=2).size(2)
    40.0
    >>> fl.Drive(amplitude=3, frequency=2, waveform="square", phase=90)
    Drive(amplitude=3, phase=90, waveform='square', frequency=2)
    """

    frequency: Annotated[Positive, FREQUENCY] | None
    direction: Finite | None = None


class Load(_Force):
    """Force along x2, across the belt, in addition to a drive along x1.

    Parameters
    ----------
    unbalance : float, >= 0, optional
        Unbalance [L]: the force has the amplitude unbalance*(frequency of the drive)^2.
    amplitude : float, >= 0, optional
        Amplitude of the force [K_1 L]. Exactly one is given: it or ``unbalance``.
    phase : float, default 0
        Phase added to frequency*tau in the argument of the waveform, with the frequency of the force
        [degrees].
    waveform : str or dict, optional
        Waveform: "sine", "square", "triangle", "sawtooth", {square: {duty}}, {sawtooth: {width}},
        {points: [[share, value], ...]}, {file: PATH} or {harmonics: [{order, amplitude, phase}, ...]};
        sine if left out.
    offset : float, optional
        Constant force across the belt [K_1 L]; zero if left out.
    frequency_ratio : float or str, > 0, optional
        Frequency of the force as a multiple of the drive's, p/q [-]; 1 if left out.

    Examples
    --------
    >>> import frictionlab as fl
    >>> fl.Load(amplitude=3, frequency_ratio="3/2", phase=90)
    Load(amplitude=3, phase=90, frequency_ratio=1.5)
    """

    frequency_ratio: Ratio | None = None


class Transverse(ScenePart):
    """Motion along x2, across the belt: a second degree of freedom, which friction couples to the first.

    Parameters
    ----------
    natural_frequency : float, > 0
        Natural frequency omega_r of the motion along x2 [omega_1].
    damping_ratio : float, >= 0
        Damping ratio of the motion along x2 [-].
    load : Load, optional
        Force along x2; no force if left out.

    References
    ----------
    Source: Sulollari, van Dalen & Cabboi, Eqs. 1 and 2.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> across = fl.Transverse(natural_frequency=0.5, damping_ratio=0.1, load=fl.Load(unbalance=10))
    >>> round(fl.steady_state(scene.with_(transverse=across), fl.Coulomb(mu=0.4)).mean_friction, 4)
    0.0426
    """

    natural_frequency: Annotated[Positive, FREQUENCY]
    damping_ratio: NonNegative
    load: Load | None = None


Order = Annotated[Positive, Field(le=1.0)]
"""Order of a derivative, in (0, 1]."""


class Relaxation(ScenePart):
    """Spring in series with a dashpot, parallel to spring and dashpot of the body: the standard linear solid.

    It adds the force stiffness*y, y' = x1' - y/time.

    Parameters
    ----------
    stiffness : float, > 0
        Stiffness of the spring, which adds to that of the body in fast motion [K_1].
    time : float, > 0
        Relaxation time of the force of the spring [1/omega_1].
    order : float, > 0 and <= 1, default 1
        Order of the derivative of y [-]; below 1 this is the fractional Zener model.

    Examples
    --------
    >>> import frictionlab as fl
    >>> fl.Relaxation(stiffness=0.5, time=1)
    Relaxation(stiffness=0.5, time=1)
    """

    stiffness: Annotated[Positive, STIFFNESS]
    time: Annotated[Positive, TIME]
    order: Order = 1.0


class Fractional(ScenePart):
    """Force coefficient*D^order x1, added to those of spring and dashpot of the body.

    It lies between the force of a spring (order 0) and that of a dashpot (order 1).

    Parameters
    ----------
    coefficient : float, > 0
        Coefficient of the derivative [K_1/omega_1^order]; x1 = exp(i omega tau) gives the force
        coefficient*(i omega)^order*x1 (Weyl).
    order : float, > 0 and <= 1
        Order of the derivative [-].

    Examples
    --------
    >>> import frictionlab as fl
    >>> fl.Fractional(coefficient=0.2, order=0.5)
    Fractional(coefficient=0.2, order=0.5)
    """

    coefficient: Positive
    order: Order


BENDING = "cubic_stiffness", "amplitude_damping", "curvature"
"""Keys of ``body`` that make it nonlinear."""
REMEMBERING = "relaxation", "fractional"
"""Keys of ``body`` that make its force depend on earlier motion."""
BY_TABLE = "receptance"
"""Key of ``body`` that stands for the whole body."""


def file_alone(values: Any) -> Any:
    """Return the values of a receptance that is given by its file alone; other values unchanged."""
    return {"file": values} if isinstance(values, str) else values


def digest_of(table: TabulatedBody, known: str, file: str) -> str:
    """Return the digest of a file's contents. Raises ValueError if another digest is known."""
    if known and known != table.digest:
        raise ValueError(f"{file} has changed since: leave digest out to take it as it is")
    return table.digest


class Receptance(ScenePart):
    """Frequency response of a linear body, measured or computed, in place of its mass, spring and dashpot.

    Parameters
    ----------
    file : str
        CSV file with columns frequency [omega_1], real and imaginary [1/K_1]: parts of x1 over force, from
        frequency 0.
    free_mass : float, > 0, optional
        Mass [K_1/omega_1^2]: above the last frequency x1 over force is -1/(free_mass frequency^2).
    frequency_unit : float, > 0, optional
        Unit of the frequencies in the file [omega_1]; 1 if left out.
    receptance_unit : float, > 0, optional
        Unit of x1 over force in the file [1/K_1]; 1 if left out.
    digest : str, default ""
        Digest of the contents of the file; computed if left out. A file with other contents is refused.

    Examples
    --------
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
    def _file_alone(cls, values: Any) -> Any:
        return file_alone(values)

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        object.__setattr__(self, "digest", digest_of(self._read(), self.digest, self.file))
        return self

    def _read(self) -> TabulatedBody:
        return read_receptance(self.file, self.free_mass, self.frequency_unit is not None)

    def body(self) -> TabulatedBody:
        """Return the body of the file.

        Returns
        -------
        TabulatedBody
            Frequencies [omega_1] with x1 over force [1/K_1].
        """
        table = self._read()
        if self.frequency_unit is None and self.receptance_unit is None:
            return table
        return table.scaled(self.frequency_unit or 1.0, self.receptance_unit or 1.0)


class Body(ScenePart):
    """Nonlinear and viscoelastic forces on the body along x1, added to those of its spring and its dashpot.

    Nondimensional, the spring has stiffness 1 and the dashpot is given by damping_ratio. A body with
    relaxation, fractional or receptance is solved under Coulomb friction alone, along one line.

    Parameters
    ----------
    cubic_stiffness : float, default 0
        Cubic stiffness k3 of the force k3 x1^3 [K_1/L^2]; the spring hardens, or softens if it is negative.
    amplitude_damping : float, >= 0, default 0
        Damping c of the force c x1^2 x1' [K_1/(omega_1 L^2)].
    curvature : float, default 0
        Curvature r [1/L]: spring and dashpot follow the strain x1 + r x1^2, their force is
        x1 + 3 r x1^2 + 2 r^2 x1^3 + 2 damping_ratio (1 + 2 r x1)^2 x1' (Amabili, 2018).
    relaxation : Relaxation, optional
        Spring in series with a dashpot, the standard linear solid; none if left out.
    fractional : Fractional, optional
        Force between those of a spring and a dashpot; none if left out.
    receptance : Receptance or str, optional
        Frequency response instead of mass, spring, damping_ratio and all of the above: a CSV file or {file,
        free_mass}.

    Examples
    --------
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
        """Compute the coefficients of the nonlinear force that adds to spring and dashpot.

        Parameters
        ----------
        damping_ratio : float, >= 0
            Damping ratio along the belt [-].

        Returns
        -------
        Bends or tuple
            Coefficients; an empty tuple if all are zero.
        """
        r = self.curvature
        bends = Bends(
            spring_2=3.0 * r,
            spring_3=self.cubic_stiffness + 2.0 * r**2,
            dashpot_1=8.0 * damping_ratio * r,
            dashpot_2=self.amplitude_damping + 8.0 * damping_ratio * r**2,
        )
        return bends if any(bends[:4]) else ()

    @property
    def terms(self) -> list[str]:
        """Keys of ``body`` whose value is neither zero nor empty."""
        return [name for name in type(self).model_fields if getattr(self, name)]


class _Vibration(ScenePart):
    """Velocity that follows a waveform.

    Parameters
    ----------
    velocity_amplitude : float, >= 0
        Amplitude of the velocity, by which the waveform is multiplied [omega_1 L].
    """

    velocity_amplitude: Annotated[NonNegative, VELOCITY]

    def size(self, _frequency: float) -> float:
        """Return the amplitude by which the waveform is multiplied, the same at all frequencies.

        Returns
        -------
        float
            Amplitude of the velocity [omega_1 L].
        """
        return self.velocity_amplitude


class Slip(_Vibration):
    """Prescribed slip along the belt: -belt_speed + velocity_amplitude*waveform(frequency*tau + phase).

    Parameters
    ----------
    velocity_amplitude : float, >= 0
        Amplitude of the oscillation that is added to the mean slip velocity -belt_speed [omega_1 L].
    frequency : float, > 0
        Frequency of the oscillation [omega_1].
    phase : float, default 0
        Phase added to frequency*tau in the argument of the waveform [degrees].
    waveform : str or dict, optional
        Waveform of the slip velocity: "sine", "square", "triangle", "sawtooth", {square: {duty}},
        {sawtooth: {width}}, {points: [[share, value], ...]}, {file: PATH} or {harmonics: [{order, amplitude,
        phase}, ...]}; sine if left out.
    direction : float, optional
        Direction of the oscillation, from x1 towards x2 [degrees]; along x1 if left out.

    Examples
    --------
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

    Parameters
    ----------
    velocity_amplitude : float, >= 0
        Amplitude of the slip velocity along x2 [omega_1 L].
    phase : float, default 0
        Phase added to frequency*tau in the argument of the waveform [degrees].
    frequency : float, > 0, optional
        Frequency of the oscillation [omega_1]; given only without ``slip``. With ``slip`` both oscillate at
        the frequency of ``slip``.
    waveform : str or dict, optional
        Waveform of the slip velocity: "sine", "square", "triangle", "sawtooth", {square: {duty}},
        {sawtooth: {width}}, {points: [[share, value], ...]}, {file: PATH} or {harmonics: [{order, amplitude,
        phase}, ...]}; sine if left out.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(belt_speed=1, transverse_slip=fl.TransverseSlip(velocity_amplitude=2, frequency=1))
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction, 4)
    0.2571
    """

    phase: Finite = 0.0
    frequency: Annotated[Positive, FREQUENCY] | None = None
    waveform: Waveform | None = None


class BeltVibration(_Vibration):
    """Vibration of the belt, added to belt_speed: velocity_amplitude*waveform(ratio*frequency*tau + phase).

    This scene also describes a slider pulled by a spring over a plate that vibrates in any direction
    (Gutowski & Leus, 2020).

    Parameters
    ----------
    velocity_amplitude : float, >= 0
        Amplitude of the oscillation that is added to belt_speed [omega_1 L].
    phase : float, default 0
        Phase added to frequency*tau in the argument of the waveform, with the frequency of the vibration
        [degrees].
    waveform : str or dict, default "sine"
        Waveform of the velocity: "sine", "square", "triangle", "sawtooth" or {harmonics: [{order, amplitude,
        phase}, ...]}.
    direction : float, default 0
        Direction of the vibration, from x1 towards x2, in scenes with ``transverse`` [degrees].
    frequency_ratio : float or str, > 0, optional
        Frequency of the vibration as a multiple of the drive's, p/q [-]; 1 if left out.
    frequency : float, > 0, optional
        Frequency of the vibration [omega_1]; given only if no other part of the scene has one.

    Examples
    --------
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
    """Variation of the normal load: normal_load*(1 + amplitude*waveform(ratio*frequency*tau + phase)).

    The normal load must always be positive.

    Parameters
    ----------
    amplitude : float, >= 0
        Amplitude of the variation as a fraction of the normal load [-].
    phase : float, default 0
        Phase added to frequency*tau in the argument of the waveform, with the frequency of the variation
        [degrees].
    waveform : str or dict, default "sine"
        Waveform of the variation: "sine", "square", "triangle", "sawtooth" or {harmonics: [{order, amplitude,
        phase}, ...]}.
    frequency_ratio : float or str, > 0, optional
        Frequency of the variation as a multiple of the drive's, p/q [-]; 1 if left out.
    contact : {"per_load", "constant"}, default "per_load"
        Stiffness and damping of bristles. ``per_load``: they follow the load, as in laws per unit normal load
        (Canudas de Wit & Tsiotras, 1999). ``constant``: they stay those of the mean load, and the load
        changes only the limit of friction (a spring in series with Coulomb friction, as in Teidelt,
        Starcevic & Popov, 2012, Popov, Popov & Popov, 2017, and Mao et al., 2017).
    frequency : float, > 0, optional
        Frequency of the variation [omega_1]; given only if no other part of the scene has one.

    Examples
    --------
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
        """Return the amplitude by which the waveform is multiplied, the same at all frequencies.

        Returns
        -------
        float
            Amplitude as a fraction of the normal load [-].
        """
        return self.amplitude


class Initial(ScenePart):
    """Start of the mass, for scenes whose steady state depends on it.

    Parameters
    ----------
    x : float, default 0
        Position along the belt, from where the spring is undeflected [L].
    velocity : float, default 0
        Velocity along the belt [omega_1 L].
    x2 : float, default 0
        Position across the belt [L].
    velocity2 : float, default 0
        Velocity across the belt [omega_1 L].

    Examples
    --------
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
