"""Base of every steady-state method: it says what it accepts, refuses the rest with a reason, solves curves."""

from __future__ import annotations

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.motion.orbit.record import End, Orbit, Orbits
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.units import Units, measured
from frictionlab.theory.linear import velocity_scale
from frictionlab.values.quantities import Floats, Record, gone

Status = Literal["ok", "refused", "failed", "not_unique", "killed"]
PROVED, TESTED, NOT_UNIQUE = "proved", "tested", "no"
"""Words on the only steady state: a theorem says so, starts far apart ended in it, others end elsewhere."""
STATISTICAL = "statistical"
"""Kind of the error of a long-time mean: two standard errors, of which no tolerance is asked."""


def no_orbit(i: int) -> None:
    """Refuse an orbit: answers have none."""


def none_found(i: int) -> list[Any]:
    """Return no states: answers know of no others."""
    return []


class Multipliers(NamedTuple):
    """Largest modulus of the Floquet multipliers of each scene, and the bound on its error, NaN where not known.

    reason: why it is empty although there is a motion, else ''.
    """

    modulus: Floats
    error: Floats
    reason: list[str]


@dataclass(frozen=True)
class Answers:
    """Answers of a method on n scenes that differ in belt speed alone, one entry per scene.

    ``Ledger`` makes them. An array left out is empty for every scene.

    Parameters
    ----------
    status : list of {"ok", "refused", "failed", "not_unique", "killed"}
        End that each scene came to.
    reason : list of str
        Reason where there is no mean, or remark on one that there is.
    model : list of str
        Words of the column ``model``: what produced the number.
    error_kind : list of str
        Kind of the error, "guaranteed", "estimated" or "statistical"; "" without a mean.
    mean : ndarray
        Friction coefficient, NaN without one; x1 + i x2 where friction has two directions.
    error : ndarray
        Bound on the error of the x1 of the mean.
    period : ndarray, optional
        Period of the response, in periods of the drive.
    floquet : callable, optional
        Called without arguments: largest modulus of the multipliers of each, as closely as the method needs it.
    multipliers : callable, optional
        Called without arguments: the same as the table tells it, with its error; ``floquet`` if left out.
    mean_low : ndarray, optional
        Lowest mean where the state is not unique.
    mean_high : ndarray, optional
        Highest mean where the state is not unique.
    window : ndarray, optional
        Periods over which each of these means is taken.
    seconds : ndarray, optional
        Time of kernels [s].
    unique : sequence of {"proved", "tested", "no", ""}, optional
        What is known of an answer as the only one: a theorem in the model says so, starts in the reason were
        tried, only ``scene.initial`` chooses it, or nothing was asked.
    orbit : callable, optional
        Called with i: the orbit of scene i, made when asked for; None without one.
    orbits : callable, optional
        Called without arguments: all orbits, where a method makes them together at less cost.
    states : callable, optional
        Called with i: where a state is not unique, those that its starts reached.
    ends : callable, optional
        Called with i: where the mean may be any in a range, where starts end; columns in which all agree are told.
    balanced : bool, default True
        True if orbits obey the equation of motion but for numerical errors; energies of others have no errors.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> answers = fl.Exact().solve([scene, scene.with_(belt_speed=50)], fl.Coulomb(mu=0.4), 1e-8)
    >>> answers.status, answers.error_kind
    (['ok', 'ok'], ['estimated', 'guaranteed'])
    >>> answers.mean.round(4).tolist(), answers.orbit(0).tau.shape[1]
    ([0.0506, 0.4], 10)
    """

    status: list[Status]
    reason: list[str]
    model: list[str]
    error_kind: list[str]
    mean: Floats | NDArray[np.complex128]
    error: Floats
    period: Floats | None = None
    floquet: Callable[[], Floats] | None = field(default=None, repr=False)
    multipliers: Callable[[], Multipliers] | None = field(default=None, repr=False)
    mean_low: Floats | None = None
    mean_high: Floats | None = None
    window: Floats | None = None
    seconds: Floats | None = None
    unique: Sequence[str] | None = None
    orbit: Callable[[int], Orbit | None] = field(default=no_orbit, repr=False)
    orbits: Callable[[], Orbits] | None = field(default=None, repr=False)
    states: Callable[[int], list[FoundState]] = field(default=none_found, repr=False)
    ends: Callable[[int], list[End]] = field(default=none_found, repr=False)
    balanced: bool = True


class Ledger:
    """Answers of a curve on their way, one entry for each of n scenes, which has failed until it is entered.

    Its lists and arrays have the names of those of ``Answers``, but for ``low`` and ``high``. Numbers that are not
    known are NaN.

    Parameters
    ----------
    count : int
        Number of scenes.

    Examples
    --------
    >>> import frictionlab as fl
    >>> ledger = fl.Ledger(3)
    >>> ledger.accept(0, mean=0.4, error=1e-12, period=1)
    >>> ledger.leave_open(1, "the mass stays where it starts", low=-0.1, high=0.1, window=1)
    >>> ledger.fail(2, "no fixed point found")
    >>> ledger.remark(2, "the load is in resonance")
    >>> ledger.answers().status
    ['ok', 'not_unique', 'failed']
    >>> ledger.answers().reason[2]
    'no fixed point found; the load is in resonance'
    """

    def __init__(self, count: int) -> None:
        self.status: list[Status] = ["failed"] * count
        self.reason, self.model, self.error_kind, self.unique = ([""] * count for _ in range(4))
        self.mean = np.full(count, complex(math.nan, math.nan))
        self.error, self.period, self.low, self.high, self.window, self.seconds = np.full((6, count), np.nan)

    def accept(
        self, i: int, mean: complex, error: float, period: float = math.nan, kind: str = "estimated"
    ) -> None:
        """Enter the mean of scene i, its error and the period of the response."""
        self.clear(i)
        self.status[i], self.mean[i], self.error[i] = "ok", mean, error
        self.period[i], self.error_kind[i] = period, kind

    def leave_open(self, i: int, reason: str, low: float, high: float, window: float) -> None:
        """Enter that the mean depends on the start, and the range of means over so many periods."""
        self.clear(i)
        self.status[i], self.reason[i] = "not_unique", reason
        self.low[i], self.high[i], self.window[i] = low, high, window

    def fail(self, i: int, reason: str, status: Status = "failed") -> None:
        """Enter that there is no mean, and why."""
        self.clear(i)
        self.status[i], self.reason[i] = status, reason

    def clear(self, i: int) -> None:
        """Forget all but the kernel time."""
        self.status[i], self.mean[i] = "failed", complex(math.nan, math.nan)
        for words in (self.reason, self.model, self.error_kind, self.unique):
            words[i] = ""
        for numbers in (self.error, self.period, self.low, self.high, self.window):
            numbers[i] = math.nan

    def remark(self, i: int, text: str) -> None:
        """Add a sentence to the reason."""
        self.reason[i] = "; ".join(filter(None, (self.reason[i], text)))

    def answers(self, **others: Any) -> Answers:
        """Return the answers as every method gives them. others: what makes orbits, multipliers and states."""
        ok = [status == "ok" for status in self.status]
        return Answers(
            status=self.status,
            reason=self.reason,
            model=self.model,
            error_kind=[kind if good else "" for kind, good in zip(self.error_kind, ok, strict=True)],
            mean=self.mean,
            error=self.error,
            period=self.period,
            mean_low=self.low,
            mean_high=self.high,
            window=self.window,
            unique=self.unique,
            seconds=self.seconds,
            **others,
        )


class FoundState(NamedTuple):
    """A state that a motion ended in: the scene's place on its curve, its period in drive periods (0: never repeats).

    mean, error: of the friction coefficient over the whole period; where it never repeats over a long time, with two
    standard errors, NaN where that is not known. low, high: of means over one drive period each. x, velocity: along
    the belt, at the start of each of its drive periods, or of the last ones. found_from: from where it was found.
    share: that of the starts that ended in it.
    """

    place: int
    period: int
    mean: float
    error: float
    low: float
    high: float
    x: Floats
    velocity: Floats
    found_from: str
    share: float


class Method(Record, ABC):
    """Method that finds steady states. Its fields are the parameters that a study may set.

    Base class of every method. A package brings one to studies by an entry point in the group
    ``frictionlab.methods``, under its ``name``. The docstring of a method names its sources, as that of a law
    does.

    Attributes
    ----------
    in_words : str
        Name in figures; its label is used if this is left out.
    resolves_events : bool
        True if instants of stick and reversal are solved for: else rest is known to a step or to a model.
    bibtex : str
        BibTeX entries of the sources as one string, except those already in frictionlab's bibliography.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Sliding(fl.Method):
    ...     name = "sliding"
    ...     def refusal(self, scene, law):
    ...         return None if law.constant_sliding_friction() else "sliding needs Coulomb friction"
    ...     def solve(self, scenes, law, tolerance):
    ...         ledger = fl.Ledger(len(scenes))
    ...         for i, scene in enumerate(scenes):
    ...             if scene.belt_speed > 50:
    ...                 ledger.accept(i, law.sliding_friction(1.0), 0.0, period=1, kind="guaranteed")
    ...             else:
    ...                 ledger.fail(i, "slip may reverse")
    ...         return ledger.answers()
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> fl.curve(scene, fl.Coulomb(mu=0.4), [5, 60], method=Sliding())["status"].tolist()
    ['failed', 'ok']
    """

    name: ClassVar[str]
    in_words: ClassVar[str] = ""
    resolves_events: ClassVar[bool] = False
    bibtex: ClassVar[str] = ""

    @abstractmethod
    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Return why this method cannot do this scene and law, as a sentence; None if it can."""

    def refusals(self, scenes: Sequence[Scene], law: FrictionLaw) -> list[str | None]:
        """Return the refusal of each of scenes that differ in belt speed alone.

        This one asks one after another. A method that knows of them all at once says so sooner.
        """
        return [self.refusal(scene, law) for scene in scenes]

    @abstractmethod
    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer scenes that differ in belt speed alone, in ascending order; none of them refused."""

    def states(
        self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, starts: int
    ) -> list[FoundState]:
        """Return the states that so many starts end in, of scenes that differ in belt speed alone.

        Nothing for a method that follows one motion to one answer.
        """
        return []

    def motion(self, scene: Scene, law: FrictionLaw, periods: int, tolerance: float) -> list[Orbit]:
        """Return the motion from scene.initial, or from the friction-free one, a record of each common period.

        Each ends where the next begins. Nothing for a method that knows no motion but the steady one.
        """
        return []


def about_rest(name: str, scene: Scene) -> str | None:
    """Why a method of this name cannot do a body that is not linear on a belt that vibrates about rest."""
    rests = scene.belt_speed == 0.0 and scene.belt_vibration is not None
    told = f"{name} does not know where a body that is not linear may rest on a belt that vibrates about rest"
    return f"{told}: give a belt speed" if rests and scene.body_terms else None


REMEMBERS = (
    "a body that remembers, or is known by a table, is solved under Coulomb friction alone, along one line: use "
    "method relay_locus, which the package frictionlab-linear-bodies brings, and law coulomb, or a body of springs "
    "and dashpots"
)


def beyond_linear(name: str, scene: Scene, taken: Sequence[str] = ()) -> str | None:
    """Why a method of this name cannot do the body of a scene, None where it can; taken: keys that it takes."""
    others = [f"body.{term}" for term in scene.body_terms if term not in taken]
    return f"{name} does not take {' and '.join(others)}" if others else None


def beyond_springs(scene: Scene) -> str | None:
    """Why no motion of a scene is followed from instant to instant: its body is more than springs and dashpots."""
    return REMEMBERS if scene.remembers else None


SMALLEST, LARGEST = 2.0**-5, 2.0**10
"""Sizes of motions between which lengths are left as they are given."""
_LENGTHS = re.compile(r"(?<= up to )[^ ]+(?= apart)|(?<=at x = )[^ ;]+|(?<=with velocity )[^ ;]+")
"""Lengths and velocities in reasons."""


def own_length(scenes: Scenes) -> float:
    """Return the unit of length in which the motion has a size near one, a power of two: digits stay as they are.

    The size is about the largest of the swing without friction, the normal load of a body, and the belt speeds.
    """
    scene, omega = scenes.scene, scenes.scene.frequency
    forces = scene.drive, scene.transverse and scene.transverse.load
    sizes = [part.size(omega) / max(1.0, omega) for part in forces if part]
    speeds = scene.slip, scene.transverse_slip, scene.belt_vibration
    sizes += [np.abs(scenes.belt_speeds).max(), *(part.size(omega) for part in speeds if part)]
    if scene.degrees_of_freedom > 0:
        sizes.append(scene.normal_load or 0.0)
    if scene.is_harmonic and not scene.bends:
        sizes.append(velocity_scale(scene) * max(1.0, 1.0 / omega))
    size = max((float(size) for size in sizes if 0.0 < size < math.inf), default=1.0)
    return 1.0 if SMALLEST < size < LARGEST else 2.0 ** round(math.log2(size))


def in_length(scenes: Scenes, law: FrictionLaw, length: float) -> tuple[Scenes, FrictionLaw]:
    """Return nondimensional scenes and a law in another unit of length."""
    units = Units(length, 1.0, length if scenes.scene.degrees_of_freedom > 0 else 1.0)
    return scenes.measured(units), measured(law, units)


def in_own_lengths(ask: Callable[..., Any], given: Sequence[Scene], law: FrictionLaw, *told: Any) -> Any:
    """Ask ``solve`` or ``states`` of a method in lengths that give the motion a size near one.

    Answers are in the lengths of the scenes given: no unit of theirs decides how accurate a method is.
    """
    scenes = Scenes.of(given)
    length = own_length(scenes)
    if length == 1.0:
        return ask(scenes, law, *told)
    found = ask(*in_length(scenes, law, length), *told)
    if not isinstance(found, Answers):
        return _states_as_long(found, length)
    orbits = found.orbits
    return replace(
        found,
        reason=[_LENGTHS.sub(lambda said: f"{float(said[0]) * length:.3g}", each) for each in found.reason],
        orbit=lambda i: _as_long(found.orbit(i), length),
        orbits=orbits and (lambda: _as_long(orbits(), length)),
        states=lambda i: _states_as_long(found.states(i), length),
    )


def _as_long(orbit: Any, length: float) -> Any:
    return orbit and replace(orbit, x=orbit.x * length, v=orbit.v * length)


def _states_as_long(states: Sequence[FoundState], length: float) -> list[FoundState]:
    return [one._replace(x=one.x * length, velocity=one.velocity * length) for one in states]


REDUCED_MODELS = frozenset({"harmonic_balance", "mdsm"})
"""Names of those that solve a simpler problem, known without loading them."""


FOR_MEMORY = "relay_locus"
"""Name of the method that ``auto`` takes for bodies that remember, or are known by a table: that of a plugin."""
NO_BOUND = "bounds are gone: the error of a reduced model is its distance to the full answer"


class ReducedModel(Method):
    """A method that solves a simpler problem than the scene states.

    error: what that leaves out is always told by the ``distance`` to the full answer.
    """

    error: Annotated[Literal["distance"], gone("bound", NO_BOUND)] = "distance"

    @abstractmethod
    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats | NDArray[np.complex128]:
        """Return the mean friction of the model alone, as ``solve`` has it, without its error.

        Of scenes with a mass that differ in belt speed alone, none refused; NaN where the model has no answer.
        """


def refused(reasons: Sequence[str]) -> Answers:
    """Return the answers of a method that cannot do these scenes."""
    n, nothing = len(reasons), np.full(len(reasons), np.nan)
    return Answers(["refused"] * n, list(reasons), [""] * n, [""] * n, nothing, nothing)
