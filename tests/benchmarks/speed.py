"""Kernel time per curve point, warm, beside scipy: python tests/benchmarks/speed.py [REPEATS].

64 belt speeds in [0.5, 60]; damping ratios 0.1, mu 0.4, unbalance 10 along the belt and, where planar, across it.
W1: Omega 1, gamma^2 10. W1g: grazing, belt speeds [49, 50.02]. W2: Omega 4, gamma^2 1. W5: stick-rich, Omega 0.5,
load 2.5 below friction 4, belt speeds [0.05, 2.5]. W3_x: planar, Omega 4, gamma^2 1, omega_r = x.

``kernel``: mean_friction and error alone; ``all``: every column too, through the method. The least of REPEATS
(default 30) runs and, as the spread, their median over that. The peer runs in the same minute: scipy's DOP853 with
slip reversals as events (W1) or as it comes (W3), from rest until the transient is gone; it neither closes the
orbit nor knows its error. Then thread scaling on 2,000 points, of the kernel and of ``frictionlab.run``.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from statistics import median
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

import frictionlab as fl
from frictionlab.kernel import compiled, njit
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods import coulomb_curve, curve
from frictionlab.methods.exact import Exact
from frictionlab.methods.shooting import Shooting
from frictionlab.scene import Drive, Load, Scene, Transverse, in_the_plane

MU = 0.4
LAW = Coulomb(mu=MU)
THREADS = 2
POINTS = 2_000
SPEEDS = np.linspace(0.5, 60.0, 64)


class Workload(NamedTuple):
    """A curve: its scene at belt speed 1, and its belt speeds."""

    name: str
    scene: Scene
    speeds: np.ndarray


class Times(NamedTuple):
    """Least wall time of repeated runs [s], and their median over it."""

    least: float
    spread: float


def along(frequency: float, normal_load: float, **force: float) -> Scene:
    """One degree of freedom."""
    drive = Drive(frequency=frequency, **(force or {"unbalance": 10.0}))
    return Scene(damping_ratio=0.1, normal_load=normal_load, belt_speed=1.0, drive=drive)


def across(omega_r: float) -> Scene:
    """Two degrees of freedom, both loads."""
    transverse = Transverse(natural_frequency=omega_r, damping_ratio=0.1, load=Load(unbalance=10.0))
    drive = Drive(unbalance=10.0, frequency=4.0)
    return Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=1.0, drive=drive, transverse=transverse)


ON_THE_LINE = [
    Workload("W1", along(1.0, 10.0), SPEEDS),
    Workload("W1g", along(1.0, 10.0), np.linspace(49.0, 50.02, 64)),
    Workload("W2", along(4.0, 1.0), SPEEDS),
    Workload("W5", along(0.5, 10.0, amplitude=2.5), np.linspace(0.05, 2.5, 64)),
]
IN_THE_PLANE = [Workload(f"W3_{omega_r:g}", across(omega_r), SPEEDS) for omega_r in (0.5, 4.0, 10.0)]


def timed(task: Callable[[], object], repeats: int) -> Times:
    """Run a task so many times, after one run that does not count."""
    task()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        task()
        times.append(time.perf_counter() - start)
    return Times(min(times), median(times) / min(times))


def at(scene: Scene, speeds: np.ndarray) -> list[Scene]:
    """The scene at these belt speeds."""
    return [scene.model_copy(update={"belt_speed": float(speed)}) for speed in speeds]


def exact_kernel(scene: Scene, speeds: np.ndarray) -> Callable[[], np.ndarray]:
    """mean_friction and error on the line, as a task that returns the errors."""
    solve, mass, rows = compiled(coulomb_curve.solve_curve), scene.mass(), np.zeros((len(speeds), 9))

    def task() -> np.ndarray:
        solve(mass, MU, speeds, rows)
        return rows[:, coulomb_curve.ERROR]

    return task


def shooting_kernel(scene: Scene, speeds: np.ndarray, tolerance: float) -> Callable[[], np.ndarray]:
    """mean_friction and error in the plane, as a task that returns the errors."""
    solve, body, guess = compiled(curve.solve_curve, LAW), in_the_plane(scene.mass()), np.empty((0, 0))
    return lambda: solve(body, speeds, guess, tolerance, 0j)[1][:, 2]


def line(name: str, tolerance: float, kernel: Times, whole: Times, error: float) -> None:
    """One row of the table; times per point in microseconds."""
    per = 1e6 / 64
    print(
        f"{name:7s} {tolerance:7.0e} {per * kernel.least:9.2f} ({kernel.spread:4.2f}) "
        f"{per * whole.least:9.2f} ({whole.spread:4.2f})   {error:.1e}",
        flush=True,
    )


def report_line(work: Workload, repeats: int) -> None:
    """Exact on one workload."""
    task, scenes = exact_kernel(work.scene, work.speeds), at(work.scene, work.speeds)
    whole = timed(lambda: Exact().solve(scenes, LAW, 1e-11), repeats)
    line(work.name, 1e-11, timed(task, 10 * repeats), whole, float(task().max()))


def report_plane(work: Workload, tolerance: float, repeats: int) -> None:
    """Shooting on one workload."""
    task, scenes = shooting_kernel(work.scene, work.speeds, tolerance), at(work.scene, work.speeds)
    whole = timed(lambda: Shooting().solve(scenes, LAW, tolerance), repeats)
    line(work.name, tolerance, timed(task, repeats), whole, float(task().max()))


# --- the peer -----------------------------------------------------------------------------------------------------


def peer(scene: Scene, tolerance: float) -> tuple[float, float]:
    """Mean friction by scipy from rest, and the seconds it took; periods until the transient is gone."""
    mass, start = scene.mass(), time.perf_counter()
    period = 2.0 * math.pi / mass.frequency
    slowest = 0.5 * min(mass.damping, mass.transverse_damping or mass.damping)
    most, state = math.ceil(-math.log(0.1 * tolerance) / (slowest * period)), np.zeros(5)
    before, mean = math.inf, math.nan
    for _ in range(most):
        state[4] = 0.0
        state = one_period(scene, state, tolerance)
        before, mean = mean, -state[4] / period
        if abs(mean - before) < 0.1 * tolerance:
            break
    return mean, time.perf_counter() - start


def one_period(scene: Scene, state: np.ndarray, tolerance: float) -> np.ndarray:
    """(x1, v1, x2, v2, friction impulse) one period on; on the line each slip reversal starts a new leg."""
    period, tau = 2.0 * math.pi / scene.frequency, 0.0
    settings: dict[str, Any] = {"method": "DOP853", "rtol": tolerance, "atol": tolerance}
    while tau < period:
        side = slip_side(scene, tau, state) if scene.degrees_of_freedom == 1 else 0.0

        def stops(t: float, y: np.ndarray) -> float:
            return y[1] - scene.belt_speed

        stops.terminal, stops.direction = True, -side  # type: ignore[attr-defined]  # how solve_ivp is told
        events = stops if side else None
        found = solve_ivp(rates(scene, side), (tau, period), state, events=events, **settings)
        tau, state = float(found.t[-1]), found.y[:, -1]
        if found.status == 1:
            state[1] = scene.belt_speed
    return state


def slip_side(scene: Scene, tau: float, state: np.ndarray) -> float:
    """The sign of the slip; from zero slip that of the net force (the peer is given scenes without stick)."""
    mass = scene.mass()
    slip = state[1] - scene.belt_speed
    load = mass.force.real * math.sin(mass.frequency * tau)
    return math.copysign(1.0, slip if slip != 0.0 else load - mass.damping * state[1] - state[0])


def rates(scene: Scene, side: float) -> Callable[[float, np.ndarray], list[float]]:
    """The equations of motion; side: the sign of the slip on the line, 0 in the plane."""
    m, v_b = scene.mass(), scene.belt_speed
    force, force_2, n = m.force.real, m.transverse_force.real, m.normal_load

    def right_side(tau: float, y: np.ndarray) -> list[float]:
        x1, v1, x2, v2, _ = y
        if side:
            rub, rub_2 = MU * side, 0.0
        else:
            speed = math.hypot(v1 - v_b, v2)
            rub, rub_2 = MU * (v1 - v_b) / speed, MU * v2 / speed
        sine = math.sin(m.frequency * tau)
        a1 = force * sine - m.damping * v1 - x1 - n * rub
        a2 = force_2 * sine - m.transverse_damping * v2 - m.transverse_stiffness * x2 - n * rub_2
        return [v1, a1, v2, a2 if not side else 0.0, rub]

    return right_side


def report_peer(name: str, scene: Scene, tolerance: float, ours: Times) -> None:
    """Scipy on one point, against the time per point of our kernel on the whole curve and its answer."""
    mean, seconds = peer(scene, tolerance)
    method = Exact() if scene.degrees_of_freedom == 1 else Shooting()
    reference = method.solve([scene], LAW, 1e-12).columns["mean_friction"][0]
    per_point = ours.least / 64
    print(
        f"{name:7s} v_b {scene.belt_speed:4.1f} rtol {tolerance:.0e}: scipy {1e3 * seconds:8.1f} ms, "
        f"off by {abs(mean - reference):.1e}; ours {1e6 * per_point:8.2f} us; ratio {seconds / per_point:.0f}",
        flush=True,
    )


# --- threads ------------------------------------------------------------------------------------------------------


@njit
def busy(n: int) -> float:
    """Arithmetic that touches no memory."""
    total = 0.0
    for i in range(n):
        total += math.sin(i * 1e-3)
    return total


def report_control(repeats: int) -> None:
    """What two threads are worth on this machine right now: no kernel can do better."""
    spin = compiled(busy)
    ratio_of("(busy loop)", lambda pool: list(pool.map(spin, [200_000] * 16)), repeats)


def report_threads(name: str, task: Callable[[np.ndarray], object], high: float, repeats: int) -> None:
    """A kernel on chunks of 125 points, by one thread and by two."""
    chunks = np.array_split(np.linspace(0.5, high, POINTS), POINTS // 125)
    ratio_of(f"{name} kernel", lambda pool: list(pool.map(task, chunks)), repeats)


def ratio_of(name: str, work: Callable[[ThreadPoolExecutor], object], repeats: int) -> None:
    """Print the time of one thread over that of two."""
    found = []
    for threads in (1, THREADS):
        with ThreadPoolExecutor(threads) as pool:
            found.append(timed(lambda pool=pool: work(pool), repeats))  # type: ignore[misc]  # mypy cannot type a bound default
    one, two = found
    print(
        f"{name:16s} one thread {1e3 * one.least:8.1f} ms, two {1e3 * two.least:8.1f} ms, "
        f"ratio {one.least / two.least:.2f} (spread {one.spread:.2f}, {two.spread:.2f})",
        flush=True,
    )


def study(scene: Scene, high: float, tolerance: float) -> dict[str, Any]:
    """The scene over 2,000 belt speeds, as a study."""
    return {
        "schema": 1,
        "scene": scene.model_dump(exclude_none=True),
        "laws": [{"kind": "coulomb", "mu": MU}],
        "sweep": {"scene.belt_speed": {"start": 0.5, "stop": high, "num": POINTS}},
        "tolerance": tolerance,
    }


def report_runs(work: Workload, tolerance: float, repeats: int) -> None:
    """The public runner on 2,000 points."""
    ready = study(work.scene, 49.9, tolerance)
    ratio_of(f"{work.name} run", lambda pool: fl.run(ready, executor=pool), repeats)


def main(repeats: int) -> None:
    """Everything."""
    print("per point [us]: kernel (spread), all columns (spread), largest error")
    for work in ON_THE_LINE:
        report_line(work, repeats)
    for work in IN_THE_PLANE:
        for tolerance in (1e-6, 1e-9, 1e-12):
            report_plane(work, tolerance, max(3, repeats // 3))
    print("\nbeside scipy")
    first, planar = ON_THE_LINE[0], IN_THE_PLANE[1]
    for tolerance in (1e-6, 1e-9):
        ours = timed(exact_kernel(first.scene, first.speeds), 10 * repeats)
        report_peer(first.name, at(first.scene, np.array([20.0]))[0], tolerance, ours)
        ours = timed(shooting_kernel(planar.scene, planar.speeds, tolerance), max(3, repeats // 3))
        report_peer(planar.name, at(planar.scene, np.array([20.0]))[0], tolerance, ours)
    print(f"\n{POINTS} points, threads")
    report_control(repeats)
    report_threads("W1", lambda v: exact_kernel(first.scene, v)(), 49.9, repeats)
    report_threads("W3_4", lambda v: shooting_kernel(planar.scene, v, 1e-9)(), 60.0, max(3, repeats // 3))
    report_runs(first, 1e-11, max(3, repeats // 5))
    report_runs(planar, 1e-9, max(3, repeats // 10))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 30)
