"""What each special solver buys over a general one: python tests/benchmarks/specialists.py [SOLVER ...].

Every special solver answers a list of scenes of its own use, and so does each general way that could take its place.
For each tolerance and way this prints: processor time of a whole call and wall time of its kernels (least of some
repetitions; least, median and largest over the scenes), the same over those of the special solver, the digits by
which means agree with references of a third kind, and every scene without an answer, with an error above the
tolerance or with one that does not cover the difference.

A special solver stays where it is 1.5 times faster or a digit more accurate than every general way that answers all
of its scenes.
"""

from __future__ import annotations

import inspect
import itertools
import math
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, cast

import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import frictionlab as fl
from frictionlab.compile.cache import compiled, timed
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import PER_AXIS, ROTATED, BristleLaw, MemoryLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.march import prescribed as sampling
from frictionlab.methods.march import prescribed_bristle as bristle_sampling
from frictionlab.methods.march.method import March
from frictionlab.methods.prescribed import (
    closed_loop_line,
    closed_loop_plane,
    deflection_path,
    exact_legs,
    periodic_deflection,
    quadrature,
)
from frictionlab.methods.prescribed.bristle import BristlePoint
from frictionlab.methods.prescribed.loop import Closed, Open
from frictionlab.methods.prescribed.memory import MemoryPoint
from frictionlab.methods.reduced.amplitudes import contact_of
from frictionlab.methods.reduced.contact import harmonic_friction
from frictionlab.methods.shooting import decoupled, saturated
from frictionlab.methods.shooting.driven import solve_driven
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity

TOLERANCES = 1e-6, 1e-9
REPEATS, ENOUGH = 7, 0.5
"""Repetitions at most, and seconds after which there are no more."""
REFERENCE = Path(__file__).parent.parent / "reference"
LOAD = 1e-9
"""Normal load of a mass that friction does not move: what it does then is as good as prescribed."""


@dataclass(frozen=True)
class Case:
    """A scene, a law, and the mean friction coefficient that a third way found, to ``known`` or better."""

    name: str
    scene: Scene
    law: FrictionLaw
    mean: float
    known: float


@dataclass(frozen=True)
class Answer:
    """A mean and its stated error (NaN where none is stated); seconds of the whole call and of its kernels."""

    mean: float
    error: float
    status: str = "ok"
    kernel: float = math.nan
    seconds: float = math.nan


Way = Callable[[Scene, Any, float], Answer]


@dataclass(frozen=True)
class Solver:
    """A special solver: its modules, its scenes, and the ways to answer them, the special one first."""

    modules: tuple[ModuleType, ...]
    cases: Callable[[], list[Case]]
    ways: dict[str, Way]
    tolerances: tuple[float, ...] = TOLERANCES


def taken(way: Way, case: Case, tolerance: float) -> Answer:
    """The answer, with the least time of some repetitions."""
    best, kernel, spent = math.inf, math.inf, 0.0
    answer = way(case.scene, case.law, tolerance)  # compiles
    for _ in range(REPEATS):
        start = time.process_time()
        answer = way(case.scene, case.law, tolerance)
        seconds = time.process_time() - start
        best, kernel, spent = min(best, seconds), min(kernel, answer.kernel), spent + seconds
        if spent > ENOUGH:
            break
    return Answer(answer.mean, answer.error, answer.status, kernel, best)


# --- a bristle as a memory of one number ---------------------------------------------------------------------------


def rate(self: Any, v: Any, memory: Any, k: int) -> Any:
    return bristle_rate(self, v, memory[0])  # type: ignore[name-defined]  # noqa: F821  # of the law's own class


def rate_by_axis(self: Any, v: Any, memory: Any, k: int) -> Any:
    along = bristle_rate(self, v.real, memory[0].real)  # type: ignore[name-defined]  # noqa: F821
    return complex(along, bristle_rate(self, v.imag, memory[0].imag))  # type: ignore[name-defined]  # noqa: F821


def rate_of_speed(self: Any, v: Any, memory: Any, k: int) -> Any:
    """Along the slip, whatever its direction; a second part, which means nothing, dies out."""
    speed, z = abs(v), memory[0]
    along = bristle_rate(self, speed, z.real)  # type: ignore[name-defined]  # noqa: F821
    return complex(along, -speed * z.imag / bristle_reach(self))  # type: ignore[name-defined]  # noqa: F821


def friction(self: Any, v: Any, memory: Any, rates: Any) -> Any:
    return bristle_friction(self, v, memory[0], rates[0])  # type: ignore[name-defined]  # noqa: F821


def friction_by_axis(self: Any, v: Any, memory: Any, rates: Any) -> Any:
    along = bristle_friction(self, v.real, memory[0].real, rates[0].real)  # type: ignore[name-defined]  # noqa: F821
    across = bristle_friction(self, v.imag, memory[0].imag, rates[0].imag)  # type: ignore[name-defined]  # noqa: F821
    return complex(along, across)


def friction_of_speed(self: Any, v: Any, memory: Any, rates: Any) -> Any:
    speed = abs(v)
    if speed == 0.0:
        return 0.0 * v
    along = bristle_friction(self, speed, memory[0].real, rates[0].real)  # type: ignore[name-defined]  # noqa: F821
    return along * (v / speed)


def steady(self: Any, v: Any, k: int) -> Any:
    return bristle_reach(self) * (v / abs(v))  # type: ignore[name-defined]  # noqa: F821


def steady_of_speed(self: Any, v: Any, k: int) -> Any:
    return complex(bristle_reach(self), 0.0)  # type: ignore[name-defined]  # noqa: F821


def within(self: Any, memory: Any) -> bool:
    return bool(abs(memory[0]) <= bristle_reach(self) * (1.0 + 1e-9))  # type: ignore[name-defined]  # noqa: F821


def sliding_friction(self: Any, speed: float) -> Any:
    return bristle_sliding(self, speed)  # type: ignore[name-defined]  # noqa: F821


def largest_rate(self: Any, speed: float) -> Any:
    return bristle_quickest(self, speed)  # type: ignore[name-defined]  # noqa: F821


FORMS: dict[float, tuple[Any, Any, Any]] = {
    0.0: (rate, friction, steady),
    ROTATED: (rate_of_speed, friction_of_speed, steady_of_speed),
    PER_AXIS: (rate_by_axis, friction_by_axis, steady),
}


@cache
def memory_class(kind: type[BristleLaw], form: float) -> type[MemoryLaw]:
    """The law with its deflection as a memory of one number, its formulas those of the bristle law."""
    own = {
        "bristle_rate": kind.rate,
        "bristle_friction": kind.friction,
        "bristle_reach": kind.largest_deflection,
        "bristle_sliding": kind.sliding_friction,
        "bristle_quickest": kind.largest_rate,
    }
    methods = {
        name: FunctionType(method.__code__, globals() | own, name)
        for name, method in zip(("rate", "friction", "steady"), FORMS[form], strict=True)
    }
    for method in (within, sliding_friction, largest_rate):
        methods[method.__name__] = FunctionType(method.__code__, globals() | own, method.__name__)

    def numbers(self: Any) -> dict[str, Any]:
        return cast(dict[str, Any], self.bristle.numbers() | {"turning": self.turning})

    def other(self: Any, name: str) -> Any:
        return getattr(self.bristle, name)

    def structure(self: Any) -> tuple[str, ...]:
        return self.memory_kind, self.bristle.planar

    body: dict[str, Any] = methods | {"numbers": numbers, "structure": structure, "__getattr__": other}
    body |= {"__annotations__": {"bristle": BristleLaw}, "__module__": __name__}
    return type(f"{kind.__name__}Memory", (MemoryLaw,), body)


def as_memory(law: BristleLaw, planar: bool) -> MemoryLaw:
    """The same friction, told as a law with a memory of one number."""
    return memory_class(type(law), law.form if planar else 0.0)(bristle=law)  # type: ignore[call-arg]


# --- references under a prescribed slip ----------------------------------------------------------------------------


def slip_of(scene: Scene) -> Callable[[float], complex]:
    """The slip velocity at an angle of the period."""
    motion = scene.motion()

    def slip(angle: float) -> complex:
        turn = complex(math.cos(angle), math.sin(angle))
        along = (motion.velocity * turn).imag - scene.belt_speed
        return complex(along, (motion.transverse_velocity * turn).imag)

    return slip


def by_steps(scene: Scene, law: BristleLaw) -> float:
    """The mean by explicit steps of order 8 on the interpreted law, closed by Newton's method."""
    frequency, slip = scene.frequency, slip_of(scene)
    line = scene.transverse_slip is None or law.form == PER_AXIS
    scalar = line or law.form == ROTATED
    reach = law.largest_deflection()
    grid = np.linspace(0.0, 2.0 * math.pi, 721)
    along = np.array([slip(angle).real for angle in grid])
    stops = [
        brentq(lambda angle: slip(angle).real, grid[i], grid[i + 1], xtol=1e-15)
        for i in np.flatnonzero(along[1:] * along[:-1] < 0.0)
    ]
    edges = np.unique([0.0, *stops, 2.0 * math.pi])

    def rates(angle: float, state: Any) -> list[float]:
        v = slip(angle)
        w: Any = v.real if line else abs(v) if scalar else v
        z: Any = float(state[0]) * reach if scalar else complex(state[0], state[1]) * reach
        dz = law.rate(w, z)
        rub = complex(law.friction(w, z, dz))
        rub = rub * (v / abs(v)) if scalar and not line else rub
        dz = complex(dz) / (reach * frequency)
        return [dz.real, dz.imag, rub.real / (2.0 * math.pi)]

    def period(z: Any) -> Any:
        state = np.array([*z, 0.0])
        for low, high in itertools.pairwise(edges):
            found = solve_ivp(rates, (low, high), state, "DOP853", rtol=1e-12, atol=1e-14, max_step=0.1)
            state = found.y[:, -1]
        return state

    z, count = np.array([0.5, 0.0]), 1 if scalar else 2
    for _ in range(30):
        end = period(z)
        open_by = end[:2] - z
        if np.abs(open_by).max() < 2e-13:
            break
        matrix = np.zeros((2, 2))
        for column in range(count):
            moved = z.copy()
            moved[column] += 1e-6 if z[column] < 0.5 else -1e-6
            matrix[:, column] = (period(moved)[:2] - end[:2]) / (moved[column] - z[column])
        step = np.linalg.solve(np.eye(2) - matrix, open_by)
        z = z + step
        z = z / max(1.0, float(np.hypot(*z)))
    return -float(end[2])


def by_tractrix(scene: Scene, law: fl.Jenkins) -> float:
    """The mean of one Jenkins element: it goes with the slip, or turns on its circle, from corner to corner."""
    frequency, slip, reach = scene.frequency, slip_of(scene), law.reach
    angle, state, yields = 0.0, np.array([0.0, 0.0, 0.0]), False

    def deflection(state: Any) -> complex:
        return (
            reach * complex(math.cos(state[0]), math.sin(state[0])) if yields else complex(state[0], state[1])
        )

    def rates(angle: float, state: Any) -> list[float]:
        v, z = slip(angle) / frequency, deflection(state)
        moved = [(v * z.conjugate()).imag / reach**2, 0.0] if yields else [v.real, v.imag]
        return [*moved, law.bristle_stiffness * z.real / (2.0 * math.pi)]

    def corner(angle: float, state: Any) -> float:
        z = deflection(state)
        return (slip(angle) * z.conjugate()).real if yields else abs(z) - reach

    corner.terminal = True  # type: ignore[attr-defined]
    for period in range(1, 6):
        state[2] = 0.0
        while angle < period * 2.0 * math.pi:
            corner.direction = -1.0 if yields else 1.0  # type: ignore[attr-defined]
            more = {"events": corner, "rtol": 1e-12, "atol": 1e-14, "max_step": 0.05}
            leg = solve_ivp(rates, (angle, period * 2.0 * math.pi), state, "DOP853", **more)
            angle, state = float(leg.t[-1]), leg.y[:, -1].copy()
            if leg.status == 1:
                z = deflection(state) * (1.0 - 1e-14)
                state[:2] = (z.real, z.imag) if yields else (math.atan2(z.imag, z.real), 0.0)
                yields = not yields
    return -float(state[2])


def slipping(ratio: float, across: float | None = None, angle: float = 60.0) -> Scene:
    """Slip of unit amplitude along the belt, and across it if told."""
    other = fl.TransverseSlip(velocity_amplitude=across, phase=angle) if across is not None else None
    return Scene(belt_speed=ratio, slip=fl.Slip(velocity_amplitude=1.0, frequency=1.0), transverse_slip=other)


def followed_case(name: str, scene: Scene, law: BristleLaw) -> Case:
    """With its reference."""
    if isinstance(law, fl.Jenkins):
        return Case(name, scene, law, by_tractrix(scene, law), 2e-12)
    return Case(name, scene, law, by_steps(scene, law), 2e-12)


def dahl(softness: float, **more: Any) -> fl.Dahl:
    """Unit friction."""
    return fl.Dahl(mu=1.0, presliding_length=softness, **more)


def lugre(softness: float, **more: Any) -> fl.LuGre:
    """Unit friction in quick slip, damped."""
    return fl.LuGre(mu_kinetic=1.0, presliding_length=softness, damping=0.1, **more)


def dupont(softness: float, **more: Any) -> fl.ElastoPlastic:
    """Unit friction in quick slip."""
    return fl.ElastoPlastic(mu_kinetic=1.0, presliding_length=softness, **more)


def jenkins(softness: float, **more: Any) -> fl.Jenkins:
    """Unit friction."""
    return fl.Jenkins(mu=1.0, presliding_length=softness, **more)


def legs_cases() -> list[Case]:
    """Laws whose path is exact, along the belt."""
    laws: list[tuple[str, BristleLaw]] = [
        (f"dahl {softness:g}", dahl(softness)) for softness in (1e-3, 0.05, 1.0, 10.0)
    ]
    laws += [("dahl 0.3, exponent 2", dahl(0.3, exponent=2.0)), ("jenkins 0.05", jenkins(0.05))]
    laws += [("jenkins 0.5", jenkins(0.5)), ("lugre 0.05", lugre(0.05))]
    cases = [
        followed_case(f"{name} at {ratio}", slipping(ratio), law)
        for name, law in laws
        for ratio in (0.2, 0.9)
    ]
    ratio, angle = 0.5, math.asin(0.5)
    stiff = 2.0 / math.pi * (angle + 1e-7 / 3.0 * ratio / (1.0 - ratio**2))
    soft = 0.5 * math.pi * ratio / (ratio * angle + math.cos(angle))
    cases.append(Case("dahl 1e-7 at 0.5", slipping(ratio), dahl(1e-7), stiff, 1e-10))
    return [*cases, Case("dahl 1e8 at 0.5", slipping(ratio), dahl(1e8), soft, 1e-13)]


def line_cases() -> list[Case]:
    """Laws without an exact path, along the belt."""
    laws: list[tuple[str, BristleLaw]] = [
        (f"elasto-plastic {softness:g}", dupont(softness)) for softness in (2e-3, 0.1, 1.0)
    ]
    laws += [
        (f"lugre on a Stribeck curve {softness:g}", lugre(softness, mu_static=1.3, stribeck_speed=0.3))
        for softness in (2e-3, 0.1, 1.0)
    ]
    return [
        followed_case(f"{name} at {ratio}", slipping(ratio), law)
        for name, law in laws
        for ratio in (0.2, 0.9, 1.2)
        if ratio < 1.0 or "Stribeck" in name
    ]


def plane_cases() -> list[Case]:
    """Vectorial laws in the plane."""
    laws: list[tuple[str, BristleLaw]] = [(f"dahl {softness:g}", dahl(softness)) for softness in (1e-2, 1.0)]
    laws += [("jenkins 0.05", jenkins(0.05)), ("jenkins 0.5", jenkins(0.5))]
    laws += [("elasto-plastic 0.03", dupont(0.03)), ("elasto-plastic 0.5", dupont(0.5))]
    laws += [("lugre on a Stribeck curve 0.1", lugre(0.1, mu_static=1.3, stribeck_speed=0.3))]
    return [
        followed_case(f"{name} at {ratio}, across {across}", slipping(ratio, across, angle), law)
        for name, law in laws
        for ratio, across, angle in ((0.3, 0.7, 60.0), (0.9, 1.5, 90.0))
    ]


def rotated_cases() -> list[Case]:
    """One deflection along the slip, on a Stribeck curve: not the friction of sliding."""
    return [
        followed_case(
            f"lugre on a Stribeck curve {softness:g} at {ratio}",
            slipping(ratio, across, 60.0),
            lugre(softness, mu_static=1.3, stribeck_speed=0.3, planar="rotated"),
        )
        for softness in (0.02, 0.1, 1.0)
        for ratio, across in ((0.3, 0.7), (0.9, 1.5), (1.2, 0.3))
    ]


def full_cases() -> list[Case]:
    """One deflection along the slip, which stays at its limit."""
    cases = []
    for ratio, across, angle in ((0.1, 0.2, 90.0), (0.3, 0.7, 60.0), (0.5, 1.0, 90.0), (0.9, 1.5, 20.0)):
        scene = slipping(ratio, across, angle)
        mean = sliding_mean(scene, fl.Coulomb(mu=1.0))
        cases += [
            Case(
                f"dahl {softness:g} at {ratio}, across {across}",
                scene,
                dahl(softness, planar="rotated"),
                mean,
                1e-13,
            )
            for softness in (0.1, 1.0)
        ]
    return cases


def axes_cases() -> list[Case]:
    """Each axis for itself."""
    laws: list[tuple[str, BristleLaw]] = [("dahl 0.05", dahl(0.05, planar="per-axis"))]
    laws += [("dahl 1", dahl(1.0, planar="per-axis"))]
    laws += [("elasto-plastic 0.1", dupont(0.1, planar="per-axis"))]
    laws += [("elasto-plastic 0.5", dupont(0.5, planar="per-axis"))]
    return [
        followed_case(f"{name} at {ratio}", slipping(ratio, across, 60.0), law)
        for name, law in laws
        for ratio, across in ((0.3, 0.7), (0.9, 1.5))
    ]


# --- ways under a prescribed slip ----------------------------------------------------------------------------------


def told(answers: Answers) -> Answer:
    """The one answer of a method."""
    mean, error = float(answers.mean[0].real), float(answers.error[0])
    return Answer(mean, error, answers.status[0], float(answers.seconds[0]))


def as_it_is(scene: Scene, law: FrictionLaw, tolerance: float) -> Answer:
    """The special solver, as shooting calls it."""
    return told(Shooting().solve([scene], law, tolerance))


def by_memory(scene: Scene, law: BristleLaw, tolerance: float) -> Answer:
    """The period map of a memory of any size, without a mass."""
    point = MemoryPoint(scene, as_memory(law, scene.transverse_slip is not None), tolerance)
    return Answer(point.found.mean.real, point.found.error, point.status, point.seconds)


LoopBy = Callable[[BristleLaw, Scene, float], Closed | Open]


def by_loop(loop: LoopBy) -> Way:
    """With another loop of the deflection in the place of the one that would be taken."""

    class Point(BristlePoint):
        def __init__(self, scene: Scene, law: BristleLaw, tolerance: float) -> None:
            self.scene = scene
            super().__init__(scene, law, tolerance)

        def _loops(self, one_line: bool, tolerance: float) -> list[Closed | Open]:
            return [loop(self.law, self.scene, tolerance)]

    def way(scene: Scene, law: BristleLaw, tolerance: float) -> Answer:
        point = Point(scene, law, tolerance)
        return Answer(point.found.mean.real, point.found.error, point.status, point.seconds)

    return way


def along(scene: Scene) -> closed_loop_line.Along:
    """The slip along the belt."""
    return closed_loop_line.Along(scene.motion().velocity, scene.belt_speed, scene.frequency)


def followed_on_the_line(law: BristleLaw, scene: Scene, tolerance: float) -> Closed | Open:
    """By collocation, whether or not a path is exact."""
    return closed_loop_line._collocated(law, along(scene), tolerance)


def followed_in_the_plane(law: BristleLaw, scene: Scene, tolerance: float) -> Closed | Open:
    """By collocation, as if the slip left the belt's line."""
    return closed_loop_plane.plane_loop(law, scene.motion(), scene.belt_speed, tolerance)


def by_harmonic_kernel(scene: Scene, law: BristleLaw, tolerance: float) -> Answer:
    """The kernel of harmonic balance, on panels that do not adapt: no error is told."""
    motion = scene.motion()
    call = compiled(harmonic_friction, law)
    found, seconds = timed(
        call, contact_of(law), abs(motion.velocity), abs(scene.belt_speed), scene.frequency
    )
    return Answer(-math.copysign(1.0, scene.belt_speed) * found[0], math.nan, "ok", seconds)


# --- driven scenes -------------------------------------------------------------------------------------------------


def on_a_curve(way: Callable[[list[Scene], Any, float], Answers]) -> Way:
    """With three more belt speeds, of which each costs as much."""

    def first(scene: Scene, law: FrictionLaw, tolerance: float) -> Answer:
        scenes = [scene.at(share * scene.belt_speed) for share in (1.0, 1.05, 1.1, 1.15)]
        return told(way(scenes, law, tolerance))

    return first


def fig8a(omega_r: float, belt_speed: float, normal_load: float = 1.0) -> Scene:
    """The planar scene of the references."""
    load = fl.Load(unbalance=10.0)
    across = fl.Transverse(natural_frequency=omega_r, damping_ratio=0.1, load=load)
    drive = fl.Drive(unbalance=10.0, frequency=4.0)
    return Scene(
        damping_ratio=0.1, normal_load=normal_load, belt_speed=belt_speed, drive=drive, transverse=across
    )


def saturated_cases() -> list[Case]:
    """The references of Coulomb friction in the plane, for bristles that end at their limit."""
    cases = []
    for omega_r in (0.5, 4.0):
        rows = pd.read_csv(REFERENCE / f"planar_fig8a_Om4_g1_wr{omega_r:g}.csv").set_index("v_b")
        for speed in (2.0, 10.0, 40.0):
            for law in (
                fl.Dahl(mu=0.4, presliding_length=0.1, planar="rotated"),
                fl.ElastoPlastic(mu_kinetic=0.4, presliding_length=0.1, planar="rotated"),
            ):
                name = f"{type(law).__name__}, omega_r {omega_r:g}, belt speed {speed:g}"
                cases.append(
                    Case(name, fig8a(omega_r, speed), law, float(rows.loc[speed, "mu_bar_dop853"]), 1e-8)
                )
    return cases


def w4(belt_speed: float) -> Scene:
    """One degree of freedom at resonance, of the references of bristles."""
    drive = fl.Drive(unbalance=10.0, frequency=1.0)
    return Scene(damping_ratio=0.1, normal_load=10.0, belt_speed=belt_speed, drive=drive)


def bristle_rows() -> Iterator[tuple[str, Scene, BristleLaw, float, float]]:
    """References of bristles on the line: name, scene, law, mean and what it is known to."""
    rows = pd.concat([pd.read_csv(REFERENCE / f"bristle_{file}.csv") for file in ("w4", "more")])
    rows = rows[rows["omega_r"].isin(["none"]) | rows["omega_r"].isna()]
    for _, row in rows[rows["belt_speed"].isin([5.0, 20.0, 45.0])].iterrows():
        law, speed = law_of(row), float(row["belt_speed"])
        softness = law.presliding_length
        if softness is not None and softness < 1e-3:
            continue
        name = f"{row['kind']} {softness:g} at {speed:g}"
        yield name, w4(speed), law, float(row["mean_friction"]), float(row["accuracy"])


def law_of(row: Any) -> fl.Dahl | fl.LuGre | fl.ElastoPlastic:
    """The law of a row of references."""
    softness = float(row["presliding_length"])
    if row["kind"] == "dahl":
        return fl.Dahl(mu=0.4, presliding_length=softness)
    kinetic = float(row["mu_kinetic"]) if row["mu_kinetic"] > 0.0 else 0.4
    given: dict[str, Any] = {"mu_kinetic": kinetic, "presliding_length": softness}
    given["damping"] = float(row["damping"]) if row["damping"] > 0.0 else 0.0
    if row["mu_static"] > kinetic:
        given |= {"mu_static": float(row["mu_static"]), "stribeck_speed": float(row["stribeck_speed"])}
    return fl.LuGre(**given) if row["kind"] == "lugre" else fl.ElastoPlastic(**given)


def apart_cases() -> list[Case]:
    """Scenes of the line, with a motion across the belt that friction by axis does not couple to it."""
    cases = []
    for name, scene, law, mean, known in bristle_rows():
        across = fl.Transverse(natural_frequency=0.7, damping_ratio=0.1, load=fl.Load(unbalance=10.0))
        scene = scene.model_copy(update={"transverse": across})
        cases.append(Case(name, scene, law.model_copy(update={"planar": "per-axis"}), mean, known))
    return cases


# --- time stepping under a prescribed slip -------------------------------------------------------------------------


def by_march(**given: Any) -> Way:
    """March, as it is."""

    def way(scene: Scene, law: FrictionLaw, tolerance: float) -> Answer:
        return told(March(**given).solve([scene], law, tolerance))

    return way


def by_laps(**given: Any) -> Way:
    """The laps of march, of a mass that friction does not move and that moves as the slip would."""

    def way(scene: Scene, law: FrictionLaw, tolerance: float) -> Answer:
        return told(March(**given).solve([heavy(scene)], law, tolerance))

    return way


def heavy(scene: Scene) -> Scene:
    """A driven mass whose friction-free motion is this slip."""
    frequency = 2.0 * 1.0
    slip, other = scene.slip, scene.transverse_slip
    assert slip is not None
    unit = Scene(
        damping_ratio=0.5,
        normal_load=LOAD,
        belt_speed=scene.belt_speed,
        drive=fl.Drive(amplitude=1.0, frequency=frequency),
    )
    size = 1.0 / friction_free_velocity(unit)
    across = None
    if other is not None:
        load = fl.Load(amplitude=size * other.velocity_amplitude, phase=other.phase)
        across = fl.Transverse(natural_frequency=1.0, damping_ratio=0.5, load=load)
    drive = fl.Drive(amplitude=size * slip.velocity_amplitude, frequency=frequency)
    return unit.model_copy(update={"drive": drive, "transverse": across})


def sliding_mean(scene: Scene, law: SlidingLaw) -> float:
    """The mean of friction without memory: Gauss-Legendre between reversals, panels halved towards slow slip."""
    slip = slip_of(scene)
    grid = np.linspace(0.0, 2.0 * math.pi, 2881)
    speed = np.array([abs(slip(angle)) for angle in grid[:-1]])
    slow = np.flatnonzero((speed <= np.roll(speed, 1)) & (speed < np.roll(speed, -1)))
    along = np.array([slip(angle).real for angle in grid])
    stops = [
        brentq(lambda angle: slip(angle).real, grid[i], grid[i + 1], xtol=1e-15)
        for i in np.flatnonzero(along[1:] * along[:-1] < 0.0)
    ]
    centres = stops if scene.transverse_slip is None else [*stops, *(grid[i] for i in slow)]
    edges = [0.0, 2.0 * math.pi]
    for centre in centres:
        away = [0.0, *(0.5**k for k in range(45))]
        edges += [(centre + side * gap) % (2.0 * math.pi) for side in (1.0, -1.0) for gap in away]
    ends = np.unique(np.concatenate([edges, np.linspace(0.0, 2.0 * math.pi, 65)]))
    points, weights = np.polynomial.legendre.leggauss(16)
    total = 0.0
    for low, high in itertools.pairwise(ends):
        half = 0.5 * (high - low)
        values = [complex(law.sliding_vector(slip(low + half * (1.0 + point)))).real for point in points]
        total += half * float(np.dot(weights, values))
    return -total / (2.0 * math.pi)


def sliding_cases() -> list[Case]:
    """Friction without memory, along the belt and in the plane."""
    falling = fl.Stribeck(mu_kinetic=1.0, mu_static=1.3, stribeck_speed=0.3)
    scenes = [slipping(0.2), slipping(0.9), slipping(1.2), slipping(0.3, 0.7), slipping(0.9, 1.5, 90.0)]
    names = "line at 0.2", "line at 0.9", "line at 1.2", "plane at 0.3", "plane at 0.9"
    laws: list[tuple[str, SlidingLaw]] = [("coulomb", fl.Coulomb(mu=1.0)), ("stribeck", falling)]
    return [
        Case(f"{law_name}, {name}", scene, law, sliding_mean(scene, law), 1e-13)
        for law_name, law in laws
        for name, scene in zip(names, scenes, strict=True)
    ]


def rubbed_cases() -> list[Case]:
    """Bristles that time stepping drags along."""
    laws: list[tuple[str, BristleLaw]] = [("dahl 0.1", dahl(0.1)), ("jenkins 0.3", jenkins(0.3))]
    laws += [("elasto-plastic 0.3", dupont(0.3))]
    laws += [("lugre on a Stribeck curve 0.3", lugre(0.3, mu_static=1.3, stribeck_speed=0.3))]
    places = [
        (f"{place}", scene.model_copy(update={"slip": fl.Slip(velocity_amplitude=1.0, frequency=2.0)}))
        for place, scene in (
            ("line at 0.2", slipping(0.2)),
            ("line at 0.9", slipping(0.9)),
            ("plane", slipping(0.3, 0.7)),
        )
    ]
    return [followed_case(f"{name}, {place}", scene, law) for name, law in laws for place, scene in places]


SOLVERS = {
    "quadrature": Solver(
        (quadrature,), sliding_cases, {"special": as_it_is, "samples of march": by_march(stepper="moreau")}
    ),
    "exact_legs": Solver(
        (exact_legs,),
        legs_cases,
        {
            "special": as_it_is,
            "followed": by_loop(followed_on_the_line),
            "harmonic kernel": by_harmonic_kernel,
            "memory map": by_memory,
        },
    ),
    "deflection_path on the line": Solver(
        (closed_loop_line, deflection_path, periodic_deflection),
        line_cases,
        {
            "special": as_it_is,
            "as in the plane": by_loop(followed_in_the_plane),
            "harmonic kernel": by_harmonic_kernel,
            "memory map": by_memory,
        },
    ),
    "deflection_path in the plane": Solver(
        (closed_loop_plane, deflection_path, periodic_deflection),
        plane_cases,
        {"special": as_it_is, "memory map": by_memory},
    ),
    "deflection_path, rotated": Solver(
        (closed_loop_plane,), rotated_cases, {"special": as_it_is, "memory map": by_memory}
    ),
    "saturates": Solver((), full_cases, {"special": as_it_is, "followed": by_loop(followed_in_the_plane)}),
    "two line loops": Solver((closed_loop_line,), axes_cases, {"special": as_it_is, "memory map": by_memory}),
    "saturated": Solver(
        (saturated,),
        saturated_cases,
        {"special": on_a_curve(Shooting().solve), "plane map": on_a_curve(solve_driven)},
    ),
    "decoupled": Solver(
        (decoupled,),
        apart_cases,
        {
            "special": on_a_curve(Shooting().solve),
            "plane map": on_a_curve(solve_driven),
        },
    ),
    "march.prescribed": Solver(
        (sampling,),
        sliding_cases,
        {
            "special": by_march(stepper="moreau"),
            "laps of march": by_laps(stepper="moreau"),
            "quadrature": as_it_is,
        },
        (1e-3, 1e-4),
    ),
    "march.prescribed_bristle": Solver(
        (bristle_sampling,),
        rubbed_cases,
        {"special": by_march(), "laps of march": by_laps(), "loop": as_it_is},
        (1e-3,),
    ),
}


def digits(case: Case, answer: Answer) -> float:
    """How many of the mean are right, as far as the reference tells."""
    return -math.log10(max(abs(answer.mean - case.mean), case.known)) if answer.status == "ok" else math.nan


def trouble(case: Case, answer: Answer, tolerance: float) -> str:
    """What is wrong with an answer, in a few words."""
    if answer.status != "ok":
        return answer.status
    off = abs(answer.mean - case.mean)
    if off > answer.error + 2.0 * case.known:
        return f"stated {answer.error:.1e}, off {off:.1e}"
    if answer.error > tolerance:
        return f"error {answer.error:.1e} above the tolerance"
    return ""


def spread(values: list[float]) -> str:
    """Least, median, largest."""
    known = [value for value in values if not math.isnan(value)]
    if not known:
        return "-"
    return f"{min(known):.3g} / {statistics.median(known):.3g} / {max(known):.3g}"


def main(names: list[str]) -> None:
    """Measure the solvers named, or all."""
    for name in names or SOLVERS:
        solver = SOLVERS[name]
        lines = sum(len(inspect.getsource(module).splitlines()) for module in solver.modules)
        cases = solver.cases()
        print(f"\n{name}: {lines} lines, {len(cases)} scenes", flush=True)
        for tolerance in solver.tolerances:
            found = {
                way: [taken(call, case, tolerance) for case in cases] for way, call in solver.ways.items()
            }
            first = found["special"]
            for way, answers in found.items():
                pairs = list(zip(answers, first, strict=True))
                right = [digits(case, answer) for case, answer in zip(cases, answers, strict=True)]
                print(f"  {tolerance:.0e} {way}:")
                print(f"    ms a point {spread([1e3 * one.seconds for one in answers])}", end="")
                print(f", kernels {spread([1e3 * one.kernel for one in answers])}")
                if way != "special":
                    print(f"    over special {spread([a.seconds / b.seconds for a, b in pairs])}", end="")
                    print(f", kernels {spread([a.kernel / max(b.kernel, 1e-9) for a, b in pairs])}")
                print(f"    digits {spread(right)}")
                for case, answer in zip(cases, answers, strict=True):
                    if wrong := trouble(case, answer, tolerance):
                        print(f"      {case.name}: {wrong}")
            sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
