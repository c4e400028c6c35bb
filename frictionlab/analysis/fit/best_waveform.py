"""The drive that lowers, or raises, the mean friction most: its harmonics and its direction, against the sine.

The least value of a function that bends sharply where it is least: evolution with an adapted covariance.

Points are drawn about a mean; the better half moves the mean, and the covariance towards the steps that paid
(CMA-ES: Hansen, 2016, The CMA evolution strategy: a tutorial, with its usual numbers). Ranks alone count: corners and
slopes without bound do not mislead it, as they do a search along gradients.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Literal, get_args

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from frictionlab.analysis.fit.residuals import FIT_TOLERANCE
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.arguments import given_law, given_scene
from frictionlab.runner.steady_state import steady_state, steady_states
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.signals import FULL_TURN, signal_of
from frictionlab.scene.waveforms import MOST_TERMS, SINE, WAVE_SHAPES, Form, Term
from frictionlab.study.grid import law_in_scene
from frictionlab.values.quantities import Floats, at_least_one

FIRST_STEP = 0.3
SETTLED = 10
"""Generations over which the best must not have changed."""
MOST_GENERATIONS = 400


def evolve(
    function: Callable[[Floats], float], start: Floats, seed: int, closeness: float = 3e-4
) -> tuple[Floats, float]:
    """The best point that was found, and its value. closeness: of values at the end, over the best and 1."""
    size = len(start)
    drawn, count = 4 + int(3.0 * math.log(size)), (4 + int(3.0 * math.log(size))) // 2
    weights = math.log(0.5 * drawn + 0.5) - np.log(np.arange(1, count + 1))
    weights = weights / weights.sum()
    selected = 1.0 / float(weights @ weights)
    path_share = (4.0 + selected / size) / (size + 4.0 + 2.0 * selected / size)
    step_share = (selected + 2.0) / (size + selected + 5.0)
    by_path = 2.0 / ((size + 1.3) ** 2 + selected)
    by_rank = min(1.0 - by_path, 2.0 * (selected - 2.0 + 1.0 / selected) / ((size + 2.0) ** 2 + selected))
    damping = 1.0 + 2.0 * max(0.0, math.sqrt((selected - 1.0) / (size + 1.0)) - 1.0) + step_share
    usual = math.sqrt(size) * (1.0 - 0.25 / size + 1.0 / (21.0 * size**2))
    random, mean, step = np.random.default_rng(seed), np.array(start), FIRST_STEP
    covariance, path, step_path = np.eye(size), np.zeros(size), np.zeros(size)
    best, least, bests = mean, function(mean), list[float]()
    for generation in range(1, MOST_GENERATIONS + 1):
        squares, ways = np.linalg.eigh(covariance)
        widths = np.sqrt(np.maximum(squares, 1e-20))
        moves = random.normal(size=(drawn, size)) * widths @ ways.T
        values = np.array([function(mean + step * move) for move in moves])
        order = np.argsort(values)
        bests.append(float(values[order[0]]))
        if bests[-1] < least:
            best, least = mean + step * moves[order[0]], bests[-1]
        near = closeness * (1.0 + abs(least))
        if np.ptp(bests[-SETTLED:]) < near and np.ptp(values) < near and generation > SETTLED:
            break
        better = moves[order[:count]]
        moved = weights @ better
        mean = mean + step * moved
        kept = 1.0 - step_share
        step_path = kept * step_path + math.sqrt((1.0 - kept**2) * selected) * (
            ways @ (ways.T @ moved / widths)
        )
        length = float(np.linalg.norm(step_path)) / usual
        steady = length / math.sqrt(1.0 - kept ** (2 * generation)) < 1.4 + 2.0 / (size + 1.0)
        path = (1.0 - path_share) * path
        if steady:
            path = path + math.sqrt(path_share * (2.0 - path_share) * selected) * moved
        covariance = (
            (1.0 - by_path - by_rank) * covariance
            + by_path * np.outer(path, path)
            + by_rank * (better.T * weights) @ better
        )
        step *= math.exp(step_share / damping * (length - 1.0))
    return best, least


Equal = Literal["power", "amplitude", "rms"]
Aim = Literal["lowest", "highest"]
_FEW_STARTS = 3
_SAME_END = 0.01
"""Starts agree where they gain the same, but for this share of it."""
_UNIT = 0.01
"""Of the friction of steady sliding: a change of the mean that is small."""
_HALF_TURN = 180.0
_SAMPLES = 400
"""Of a motion that is drawn."""
_NEAR_POWER, _SAME_POWER = 0.05, 1e-6
"""Shares of the power: from which a mean is interpolated to it, and within which that is not needed."""
_SIZES = "unbalance", "amplitude", "velocity_amplitude"
_READ = "mean_friction", "error", "period", "energy_input"


@dataclass(frozen=True, eq=False)
class BestWaveform:
    """Best drive, compared with the sine.

    ``fl.best_waveform`` returns it.

    Attributes
    ----------
    drive : Drive or Slip
        Best drive, as the scene takes it; a slip if that is prescribed.
    mean_friction : float
        Mean friction with the best drive [-].
    sine_mean_friction : float
        Mean friction with the sine [-].
    error : float
        Bound on the error of their difference [-].
    agreeing : int
        Number of starts of the search that change the mean by as much as the best one.
    starts : int
        Number of starts.
    table : pandas.DataFrame
        A row each for the sine, for the named waveforms that are as strong, and for the best:
        ``mean_friction``, ``error``, and ``amplitude``, ``rms`` and ``power`` over those of the sine.
    scenes : dict of str to Scene
        Scene with the sine and with the best drive, which ``plot`` draws.
    law : FrictionLaw
        Law of friction.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
    >>> found = fl.best_waveform(scene, fl.Coulomb(mu=0.4), harmonics=1, equal="rms", starts=1)
    >>> round(found.mean_friction, 4), round(found.sine_mean_friction, 4), len(found.table)
    (0.1333, 0.1333, 5)
    >>> found.plot().savefig("waveforms.svg")
    """

    drive: Any
    mean_friction: float
    sine_mean_friction: float
    error: float
    agreeing: int
    starts: int
    table: pd.DataFrame
    scenes: dict[str, Scene] = field(repr=False)
    law: FrictionLaw = field(repr=False)

    def plot(self) -> Any:
        """Draw the sine and the best drive over a period, and the motions that they cause.

        Returns
        -------
        matplotlib.figure.Figure
            Figure.
        """
        from frictionlab.charts.fits import best_waveform_figure  # with matplotlib, which takes a second

        motions = {}
        for name, scene in self.scenes.items():
            state = steady_state(scene, self.law)
            motion, part = state.orbit(_SAMPLES), scene.drive or scene.slip
            assert part is not None
            wave = signal_of(part.waveform or SINE, scene.frequency, part.phase)
            motion["drive"] = part.size(scene.frequency) * wave(motion["tau"])
            motions[f"{name}: mean friction {state.mean_friction:.3g}"] = motion
        scene = self.scenes["sine"]
        return best_waveform_figure(motions, scene.belt_speed, scene.drive is None)


def best_waveform(
    scene: Scene,
    law: FrictionLaw,
    harmonics: int = 5,
    direction: bool = False,
    equal: Equal = "power",
    goal: Aim = "lowest",
    starts: int = _FEW_STARTS,
) -> BestWaveform:
    """Find the waveform of the drive, or of a prescribed slip, with the lowest or highest mean friction.

    It is as strong as the sine of the drive.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    harmonics : int, >= 1, default 5
        Highest order whose amplitude and phase are chosen.
    direction : bool, default False
        Whether to choose the direction of the drive in the plane, too.
    equal : {"power", "amplitude", "rms"}, default "power"
        Measure of strength that is that of the sine: "power", the mean power that loads put into the body as
        it then moves (``energy_input`` over its time); "amplitude", the largest value of the load; "rms", its
        root mean square, which determines currents and their heat.
    goal : {"lowest", "highest"}, default "lowest"
        Mean friction that is looked for. The lowest one may be below 0: a body driven against the belt.
    starts : int, >= 1, default 3
        Number of starts of the search; the first is the sine. Each needs some 2000 steady states, at equal
        power 8000.

    Returns
    -------
    BestWaveform
        Best drive, and its mean friction beside that of the sine.

    Raises
    ------
    ValueError
        If a value makes no sense, or the sine has no mean friction.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> found = fl.best_waveform(scene, fl.Coulomb(mu=0.4), harmonics=2, equal="rms", starts=1)
    >>> found.mean_friction < 0.7 * found.sine_mean_friction
    True
    """
    for name, value, allowed in (("equal", equal, get_args(Equal)), ("goal", goal, get_args(Aim))):
        if value not in allowed:
            raise ValueError(f"{name} must be {' or '.join(map(repr, allowed))}, got {value!r}")
    if at_least_one("harmonics", harmonics) > MOST_TERMS:
        raise ValueError(f"harmonics must be at most {MOST_TERMS}, got {harmonics}")
    given = given_scene(scene)
    asked = _Asked(given, given_law(law), harmonics, direction, equal)
    sine, sign = asked.sine, 1.0 if goal == "lowest" else -1.0
    ends = [
        asked.held(*asked.drive_at(_unturned(evolve(lambda x: asked.loss(x, sign), start, seed)[0], asked)))
        for seed, start in enumerate(_starts(asked, at_least_one("starts", starts)))
    ]
    best = min([sine, *ends], key=lambda end: math.inf if math.isnan(end.mean) else sign * end.mean)
    near = _SAME_END * (abs(best.mean - sine.mean) + asked.unit)
    agreeing = sum(abs(end.mean - best.mean) <= near for end in ends)
    rows = {name: asked.held(Form(name), asked.part.direction) for name in WAVE_SHAPES} | {"best": best}
    table = pd.DataFrame([{"waveform": name, **asked.told(row)} for name, row in rows.items()])
    scenes = {"sine": asked.scene_of(sine), "best": asked.scene_of(best)}
    error = best.error + sine.error if best is not sine else 0.0
    drive = asked.drive_in(given, best)
    return BestWaveform(drive, best.mean, sine.mean, error, agreeing, starts, table, scenes, asked.law)


@dataclass(frozen=True)
class _Driven:
    """A form of the drive, how many times the size of the given one, where it points, and what comes of it."""

    form: Form
    factor: float
    direction: float | None
    mean: float = math.nan
    error: float = math.nan
    power: float = math.nan


class _Asked:
    """The question: scenes by their drive, nondimensional, and what is held equal.

    alone: whether nothing else changes in time, so that a delay of the drive changes nothing. unit: a small change of
    the mean friction.
    """

    def __init__(self, scene: Scene, law: FrictionLaw, harmonics: int, turns: bool, equal: Equal) -> None:
        self.law, self.harmonics, self.turns, self.equal = law_in_scene(law, scene), harmonics, turns, equal
        self.scene = scene.model_copy(update={"dimensional": None})
        self.name = "drive" if scene.slip is None else "slip"
        self.part: Any = getattr(scene, self.name)
        if self.part is None:
            raise ValueError(
                "best_waveform: the scene has no drive and no slip whose waveform could be chosen"
            )
        if scene.slip is not None and equal == "power":
            raise ValueError("equal='power': a prescribed slip has no body to put power into; use 'rms'")
        if turns:
            self.scene.with_({f"{self.name}.direction": 1.0})  # says where it cannot
        others = scene.belt_vibration, scene.normal_load_variation, scene.transverse_slip
        across = scene.transverse is not None and scene.transverse.load is not None
        self.alone = not across and all(part is None for part in others)
        self.factor, self.unit = 1.0, _UNIT * self.law.sliding_friction(abs(scene.belt_speed))
        self.sine = self.answered(_Driven(SINE, 1.0, self.part.direction))
        if math.isnan(self.sine.mean):
            raise ValueError("best_waveform: the sine has no mean friction; fl.steady_state says why")
        if equal == "power" and not self.sine.power > 0.0:
            raise ValueError("equal='power': the sine puts no power into the body; use 'rms' or 'amplitude'")

    def scene_of(self, driven: _Driven) -> Scene:
        """The scene with this drive."""
        sizes = {name: getattr(self.part, name, None) for name in _SIZES}
        changes: dict[str, Any] = {
            name: driven.factor * size for name, size in sizes.items() if size is not None
        }
        changes |= {"waveform": driven.form, "direction": driven.direction}
        return self.scene.model_copy(update={self.name: self.part.model_copy(update=changes)})

    def drive_in(self, given: Scene, driven: _Driven) -> Any:
        """The drive as a scene takes it that was given so: of the same size, its harmonics larger."""
        form = driven.form
        terms = [term._replace(amplitude=driven.factor * term.amplitude) for term in form.terms]
        changes: dict[str, Any] = {"waveform": form._replace(terms=tuple(terms)).plain()}
        changes |= {} if driven.direction is None else {"direction": driven.direction}
        within = "" if given.dimensional is None else "dimensional."
        found = given.with_({f"{within}{self.name}.{name}": value for name, value in changes.items()})
        return getattr(found.dimensional or found, self.name)

    def answered(self, driven: _Driven) -> _Driven:
        """With its mean friction, NaN where there is none, the error of that, and its power where that counts."""
        columns = _READ[: 4 if self.equal == "power" else 2]
        found = steady_states(Scenes.of([self.scene_of(driven)]), self.law, FIT_TOLERANCE, columns).numbers
        mean, error, periods, energy = (
            float(found[name][0]) if name in found else math.nan for name in _READ
        )
        power = energy * self.scene.frequency / (FULL_TURN * periods)
        return replace(driven, mean=mean, error=error, power=power)

    def held(self, form: Form, direction: float | None) -> _Driven:
        """A form in the size in which it is as strong as the sine; without a mean where there is no such size."""
        driven = _Driven(form, _strength(SINE, self.equal) / _strength(form, self.equal), direction)
        if self.equal != "power":
            return self.answered(driven)

        def sized(log: float) -> _Driven:
            return self.answered(replace(driven, factor=driven.factor * math.exp(log)))

        logs = np.linspace(0.0, 4.0, 17)
        here = sized(0.0).power > self.sine.power
        for near, far in zip(-logs if here else logs, (-logs if here else logs)[1:], strict=False):
            if (sized(far).power > self.sine.power) != here:
                log = brentq(lambda log: sized(log).power / self.sine.power - 1.0, near, far, xtol=1e-10)
                return sized(float(log))
        return driven

    def loss(self, numbers: Floats, sign: float) -> float:
        """Units by which the mean is worse than the sine's, below 0 where it is better; infinite where there is none.

        At equal power it is interpolated between two sizes, one of which is near.
        """
        form, direction = self.drive_at(numbers)
        if self.equal != "power":
            found = sign * (self.held(form, direction).mean - self.sine.mean) / self.unit
            return math.inf if math.isnan(found) else found
        driven = _Driven(form, self.factor * _strength(SINE, "rms") / _strength(form, "rms"), direction)
        one, ratio = None, math.nan
        for _ in range(5):
            other, one = one, self.answered(driven)
            ratio = max(one.power / self.sine.power, 1e-3)
            if math.isnan(ratio):
                return math.inf
            slope = 0.0
            if other is not None and other.power > 0.0 and one.power not in (0.0, other.power):
                slope = (one.mean - other.mean) / math.log(abs(one.power / other.power))
            if abs(ratio - 1.0) < (_SAME_POWER if other is None else _NEAR_POWER):
                self.factor = driven.factor * _strength(form, "rms") / _strength(SINE, "rms")
                return sign * (one.mean - slope * math.log(ratio) - self.sine.mean) / self.unit
            driven = replace(driven, factor=driven.factor / math.sqrt(ratio))
        return math.inf

    def drive_at(self, numbers: Floats) -> tuple[Form, float | None]:
        """The form and the direction that numbers of the search stand for: of sines, of cosines, direction."""
        phasors = _phasors(numbers, self.harmonics)
        pairs = zip(np.abs(phasors).tolist(), np.angle(phasors, deg=True).tolist(), strict=True)
        form = Form("harmonics", tuple(Term(k, *pair) for k, pair in enumerate(pairs, 1)))
        return form, _HALF_TURN * float(numbers[-1]) if self.turns else self.part.direction

    def told(self, driven: _Driven) -> dict[str, float]:
        """A row of the table."""
        row = {"mean_friction": driven.mean, "error": driven.error}
        for name in ("amplitude", "rms"):
            row[name] = driven.factor * _strength(driven.form, name) / _strength(SINE, name)
        row |= {"power": driven.power / self.sine.power} if self.equal == "power" else {}
        return row | ({"direction": driven.direction or 0.0} if self.turns else {})


def _strength(form: Form, measure: str) -> float:
    """The largest value of a form, or else its root mean square."""
    if measure == "amplitude":
        return max(map(abs, signal_of(form, 1.0, 0.0).extremes(FULL_TURN)))
    square = sum(0.5 * term.amplitude**2 for term in form.waves)
    for line, (length, end) in zip(form.lines, form.ends, strict=True):
        square += float(length * (line.value**2 + line.value * end + end**2) / 3)
    return math.sqrt(square)


def _phasors(numbers: Floats, harmonics: int) -> Any:
    return numbers[:harmonics] + 1j * numbers[harmonics : 2 * harmonics]


def _unturned(numbers: Floats, asked: _Asked) -> Floats:
    """The same drive, its first harmonic a sine, where nothing else tells times apart."""
    if not asked.alone:
        return numbers
    phasors = _phasors(numbers, asked.harmonics)
    phasors = phasors * np.exp(-1j * np.angle(phasors[0]) * np.arange(1, asked.harmonics + 1))
    return np.concatenate([phasors.real, phasors.imag, numbers[2 * asked.harmonics :]])


def _starts(asked: _Asked, count: int) -> Iterator[Floats]:
    """The sine, then forms whose harmonics shrink with their order."""
    drawn, orders = np.random.default_rng(1), np.tile(np.arange(1, asked.harmonics + 1), 2)
    direction = (asked.part.direction or 0.0) / _HALF_TURN
    yield np.concatenate([np.eye(1, 2 * asked.harmonics)[0], [direction] * asked.turns])
    for _ in range(1, count):
        waves = drawn.normal(size=2 * asked.harmonics) / orders
        yield np.concatenate([waves / np.linalg.norm(waves), drawn.uniform(-1.0, 1.0, int(asked.turns))])
