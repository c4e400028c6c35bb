"""Python runs a kernel while that costs less than compiling it, and answers the same."""

from __future__ import annotations

import math
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from profiles import deep, some

import frictionlab as fl
from frictionlab.compile import cache, call, interpret
from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner, njit
from frictionlab.compile.interpret import interpreted, limited_to
from frictionlab.compile.notice import compiled_here


def suffixes(folder: Path) -> set[str]:
    """The kinds of files there."""
    return {file.suffix for file in folder.glob("*")}


@inner
def _halved(x):
    return 0.5 * x


@njit
def halve_slowly(numbers, times):
    """Halve every number, in so many loops of nothing."""
    for i in range(numbers.size):
        for _ in range(times):
            numbers[i] = _halved(numbers[i]) * 2.0
        numbers[i] = _halved(numbers[i])
    return numbers[0]


def test_what_is_called_once_is_run_by_python(without_kernels):
    numbers = np.array([1.0, 3.0])

    assert KernelCall(halve_slowly)(numbers, 1) == 0.5
    assert numbers.tolist() == [0.5, 1.5]
    assert suffixes(without_kernels) == set()


@deep("seconds of Python")
def test_what_has_taken_long_enough_in_all_calls_together_is_compiled(without_kernels, monkeypatch):
    monkeypatch.setattr(call, "PYTHON_AT_MOST", 0.15)
    for _ in range(50):
        KernelCall(halve_slowly)(np.array([1.0]), 300_000)
        if ".kernel" in suffixes(without_kernels):
            break

    assert suffixes(without_kernels) == {".kernel"}


def test_what_another_process_has_compiled_is_not_run_by_python(without_kernels, monkeypatch):
    with call.compiling_at_once():
        KernelCall(halve_slowly)(np.array([1.0]), 1)
    cache._entry.cache_clear()
    monkeypatch.setattr(call, "_ready", set())
    monkeypatch.setattr(call, "interpreted", None)

    assert KernelCall(halve_slowly)(np.array([1.0]), 1) == 0.5


def test_a_call_that_takes_too_long_is_begun_anew_by_machine_code(without_kernels, monkeypatch):
    """The interpreted one had already changed what it was given."""
    monkeypatch.setattr(call, "PYTHON_AT_MOST", 0.1)
    monkeypatch.setattr(interpret, "LONG", 0)
    numbers = np.array([1.0, 3.0, 5.0])
    KernelCall(give_up_late)(numbers, 600)

    assert numbers.tolist() == [0.5, 1.5, 2.5]
    assert ".kernel" in suffixes(without_kernels)


@inner
def _work(x):
    for _ in range(20_000):
        x = _halved(x) * 2.0
    return x


@njit
def give_up_late(numbers, times):
    """The first number is halved at once, the others after much work."""
    for i in range(numbers.size):
        numbers[i] = 0.5 * numbers[i]
        for _ in range(times):
            numbers[i] = _work(numbers[i])
    return numbers[0]


@njit
def root_of(x):
    """A root that Python refuses."""
    return math.sqrt(x)


def test_what_python_refuses_and_machine_code_does_not_is_compiled(without_kernels):
    assert math.isnan(KernelCall(root_of)(-1.0))


def test_methods_of_a_law_of_others_are_compiled_at_once(without_kernels):
    """What numba cannot compile is told at the first point."""

    class Mine(fl.Coulomb):
        """Coulomb friction."""

    assert KernelCall(friction_at, fl.Coulomb(mu=0.4))(1.0) == 0.4
    assert suffixes(without_kernels) == set()
    assert KernelCall(friction_at, Mine(mu=0.4))(1.0) == 0.4
    assert [file.name.rpartition("_")[0][:-25] for file in without_kernels.iterdir()] == [
        "frictionlab_methods_on_the_line"
    ]


@njit
def friction_at(law, v):
    return law.sliding_vector(v)


def test_a_limit_of_time_is_that_of_one_thread():
    done = []
    with limited_to(0.0):
        other = threading.Thread(target=lambda: done.append(interpreted(_work)(1.0)))
        other.start()
        other.join()
    assert done == [1.0]


@deep("seconds of Python")
def test_threads_that_ask_at_once_are_given_whole_functions():
    """One was given a function whose names another thread had not filled in yet."""
    for _ in range(20):
        interpreted.cache_clear()
        interpret._OF_NUMBERS.twins.clear()
        with ThreadPoolExecutor(8) as pool:
            assert list(pool.map(lambda _: interpreted(_work)(1.0), range(8))) == [1.0] * 8


LINE = fl.Scene(damping_ratio=0.05, normal_load=10, belt_speed=5, drive=fl.Drive(amplitude=30, frequency=1.5))
PLANE = LINE.with_(
    transverse=fl.Transverse(natural_frequency=2, damping_ratio=0.05, load={"amplitude": 20, "phase": 90})
)
SLIP = fl.Scene(slip=fl.Slip(velocity_amplitude=2, frequency=1), belt_speed=1)
dear = deep("kernels slow to compile")
CASES = [
    (LINE, fl.Coulomb(mu=0.4), "exact"),
    (LINE, fl.Coulomb(mu=0.4), "shooting"),
    (LINE, fl.Coulomb(mu=0.4), "harmonic_balance"),
    (LINE, fl.Stribeck(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=5), "auto"),
    (LINE, fl.Dahl(mu=0.4, presliding_length=0.1), "shooting"),
    pytest.param(
        LINE,
        fl.LuGre(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=5, presliding_length=0.1),
        "auto",
        marks=dear,
    ),
    pytest.param(LINE, fl.Jenkins(mu=0.4, presliding_length=0.1), "auto", marks=dear),
    pytest.param(PLANE, fl.Dahl(mu=0.4, presliding_length=0.1), "auto", marks=dear),
    (PLANE, fl.Coulomb(mu=0.4), "auto"),
    (PLANE, fl.Coulomb(mu=0.4), "mdsm"),
    (SLIP, fl.Dahl(mu=0.4, presliding_length=0.1), "auto"),
    (SLIP, fl.LuGre(mu_kinetic=0.4, presliding_length=0.1, damping=0.01), "auto"),
]
EXACT = 1e-11
"""On the line both answer the same but for rounding; in the plane other roundings may lead to other steps."""


@some(1, "seconds of Python")
@pytest.mark.parametrize(("scene", "law", "method"), CASES)
def test_python_and_machine_code_answer_the_same(scene, law, method, monkeypatch):
    quick = fl.steady_state(scene, law, method=method, tolerance=1e-6)
    monkeypatch.setattr(call._choice, "always_compile", False)
    monkeypatch.setattr(call, "_ready", set())
    monkeypatch.setattr(call, "PYTHON_AT_MOST", 1e9)
    monkeypatch.setattr(KernelCall, "not_kept", lambda *_: {"a kernel"})
    slow = fl.steady_state(scene, law, method=method, tolerance=1e-6)

    assert slow.status == quick.status == "ok"
    assert slow.model == quick.model
    either = slow.error + quick.error
    allowed, near, alike = (EXACT, 1e-9, 1e-7) if scene.degrees_of_freedom < 2 else (either, 1e-5, 1e-4)
    assert abs(slow.mean_friction - quick.mean_friction) <= allowed
    assert slow.velocity_amplitude == pytest.approx(quick.velocity_amplitude, rel=near, nan_ok=True)
    assert slow.energy_friction == pytest.approx(quick.energy_friction, rel=alike, nan_ok=True)


FIRST = """
import frictionlab as fl
drive = fl.Drive(amplitude=30, frequency=1.5)
scene = fl.Scene(damping_ratio=0.05, normal_load=10, belt_speed=5, drive=drive)
print(fl.steady_state(scene, fl.Coulomb(mu=0.4)).status)
"""


def test_a_first_answer_compiles_nothing(without_kernels):
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", FIRST], capture_output=True, text=True, check=True
    )

    assert done.stdout == "ok\n"
    assert suffixes(without_kernels) == set()


@dear
def test_the_columns_of_a_table_count_no_time_of_compiling(without_kernels, monkeypatch):
    """A kernel of columns that is compiled while they are read; numba takes seconds, the points milliseconds."""
    monkeypatch.setattr(call._choice, "always_compile", True)
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    compiled, start = len(compiled_here), time.perf_counter()
    table = fl.curve(scene, fl.Coulomb(mu=0.4), [5.0, 6.0], columns="all")

    assert len(compiled_here) > compiled
    assert table["seconds"].sum() < 0.5 * (time.perf_counter() - start)
