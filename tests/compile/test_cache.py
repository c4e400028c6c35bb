"""Compiled kernels: never stale, reused when nothing changed, and never in the way when they cannot be had."""

from __future__ import annotations

import functools
import math
import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from profiles import deep

from frictionlab.compile import cache, law_addresses
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import inner, njit
from frictionlab.compile.dispatch import KnownLaw, by_dimension
from frictionlab.laws.base import Positive, SlidingLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.faults import CannotCompile
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.march.laps import march_laps
from frictionlab.methods.periodic.continuation import answer_curve
from frictionlab.methods.periodic.setting import maps_of
from frictionlab.methods.shooting.undriven_path import follow_undriven

FILES = {
    "law_constants.py": "LEVEL = 3.0\n",
    "law_package/__init__.py": "",
    "law_package/inside.py": "SHIFT = 0.25\n",
    "law_helper.py": """
from frictionlab.tools import inner
FACTOR = 2.0

@inner
def scaled(mu, speed):
    '''One docstring.'''
    return FACTOR * mu
""",
    "edited.py": """
import law_package.inside
from law_constants import LEVEL
from law_helper import scaled
from frictionlab.laws.base import Positive, SlidingLaw

class Edited(SlidingLaw):
    mu: Positive

    def sliding_friction(self, speed):
        # a comment
        return LEVEL + scaled(self.mu, speed) + law_package.inside.SHIFT
""",
    "pair.py": """
from frictionlab.compile.dispatch import by_dimension, by_law

def on_the_line(v):
    return 100.0

def in_the_plane(v):
    return 200.0

body = by_dimension(on_the_line, in_the_plane)

def of_sliding(law, v):
    return 0.0

def of_bristle(law, v):
    return 1000.0

kind = by_law(of_sliding, of_bristle)
""",
    "kernel_of_test.py": """
from frictionlab.tools import njit
from pair import body, kind

@njit
def answer(law, speed):
    return law.sliding_friction(speed) + body(speed) + kind(law, speed)
""",
    "main.py": """
from frictionlab.compile.cache import compiled
from kernel_of_test import answer
from edited import Edited
print(repr(compiled(answer, Edited(mu=0.5))(2.0)))
""",
}


class Folder:
    """A law, what it is made of, and a kernel in files of their own, run in processes of their own."""

    def __init__(self, path: Path) -> None:
        self.path, self.cache = path, path / "cache"
        for name, text in FILES.items():
            (path / name).parent.mkdir(exist_ok=True)
            (path / name).write_text(text)

    def edit(self, name: str, before: str, after: str) -> None:
        """Replace one passage of a file."""
        text = (self.path / name).read_text()
        assert before in text
        (self.path / name).write_text(text.replace(before, after))

    def start(self) -> subprocess.Popen[str]:
        """Run the kernel in a new process."""
        inherited = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
        environment = inherited | {"FRICTIONLAB_CACHE": str(self.cache), "PYTHONDONTWRITEBYTECODE": "1"}
        command = [sys.executable, "-W", "error", str(self.path / "main.py")]
        return subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    def number(self) -> float:
        """What the kernel answers in a new process."""
        return finished(self.start())

    def kept(self) -> dict[str, int]:
        """What the cache holds: the time of writing by file, of Python's own bytecode leaving none."""
        return {str(path): path.stat().st_mtime_ns for path in self.cache.rglob("*") if path.is_file()}


def finished(process: subprocess.Popen[str]) -> float:
    out, problems = process.communicate(timeout=600)
    assert process.returncode == 0, problems
    return float(out)


@pytest.fixture(scope="module")
def compiled_once(tmp_path_factory):
    """The folder after its first run."""
    folder = Folder(tmp_path_factory.mktemp("kernel"))
    assert folder.number() == 104.25
    return folder


@deep("processes")
def test_a_second_process_takes_the_compiled_kernel_from_the_cache(compiled_once):
    before = compiled_once.kept()

    assert any(name.endswith(".kernel") for name in before)
    assert compiled_once.number() == 104.25
    assert compiled_once.kept() == before


@deep("two processes each")
@pytest.mark.parametrize(
    ("name", "before", "after", "number"),
    [
        ("edited.py", "return LEVEL", "return 2.0*LEVEL", 107.25),
        ("edited.py", "mu: Positive", "mu: Positive\n    nu: Positive = 1.0", 104.25),
        ("law_helper.py", "FACTOR * mu", "10.0 * FACTOR * mu", 113.25),
        ("law_helper.py", "FACTOR = 2.0", "FACTOR = 4.0", 105.25),
        ("law_constants.py", "LEVEL = 3.0", "LEVEL = 5.0", 106.25),
        ("law_package/inside.py", "SHIFT = 0.25", "SHIFT = 0.75", 104.75),
        ("pair.py", "return 100.0", "return 300.0", 304.25),
        ("pair.py", "return 0.0", "return 7.0", 111.25),
        ("pair.py", "of_sliding, of_bristle)", "of_sliding, of_bristle, None, of_bristle)", 104.25),
        ("kernel_of_test.py", "+ body(speed)", "- body(speed)", -95.75),
    ],
    ids=[
        "the law",
        "a parameter of the law",
        "its helper",
        "a constant of its helper",
        "a constant it imports",
        "a constant inside a package",
        "a body chosen by dimension",
        "a body chosen by law",
        "the laws that a body is for",
        "the kernel",
    ],
)
def test_an_edit_is_never_answered_by_a_stale_kernel(compiled_once, name, before, after, number):
    kept = compiled_once.kept()
    compiled_once.edit(name, before, after)
    try:
        assert compiled_once.number() == number
        assert set(compiled_once.kept()) > set(kept)
    finally:
        compiled_once.edit(name, after, before)


@deep("processes")
@pytest.mark.parametrize(
    ("name", "before", "after"),
    [
        ("edited.py", "# a comment", "# another\n        # comment"),
        ("law_helper.py", "'''One docstring.'''", "'''Another\n\n    docstring.'''"),
    ],
    ids=["a comment", "a docstring"],
)
def test_words_and_the_place_in_the_file_change_nothing(compiled_once, name, before, after):
    kept = compiled_once.kept()
    compiled_once.edit(name, before, after)
    try:
        assert compiled_once.number() == 104.25
        assert compiled_once.kept() == kept
    finally:
        compiled_once.edit(name, after, before)


@pytest.mark.parametrize(
    "root",
    [
        answer_curve, maps_of, follow_undriven, march_laps, LuGre,
        law_addresses._on_the_line(law_addresses._called(Coulomb(mu=0.4))),
    ],
)  # fmt: skip
def test_the_name_of_a_kept_kernel_holds_no_address(root):
    assert not [piece for piece in cache._pieces([root], set()) if " at 0x" in piece]


def test_how_records_check_what_they_are_given_is_no_part_of_a_kernel():
    pieces = list(cache._pieces([LuGre, Coulomb], set()))

    assert [piece for piece in pieces if "LuGre.rate" in piece]
    assert not [
        piece for piece in pieces if "frictionlab.values.validation" in piece or "pydantic_core" in piece
    ]


def _vowel(letter):
    return letter in {"a", "e", "i", "o", "u"}


@functools.cache
def _cached(number):
    return 2.0 * number


def test_the_name_of_a_kept_kernel_is_the_same_in_every_process():
    pieces = list(cache._pieces([_vowel, _cached], set()))

    assert repr(sorted(map(repr, "aeiou"))) in pieces
    assert f"{__name__}._cached" in pieces
    assert "2.0" in pieces


@deep("processes that compile")
def test_two_processes_on_a_cold_cache_are_both_right(tmp_path):
    folder = Folder(tmp_path)
    racing = [folder.start(), folder.start()]

    assert [finished(process) for process in racing] == [104.25, 104.25]
    assert not list(folder.cache.glob("*.tmp"))
    assert folder.number() == 104.25


class Interpreted(SlidingLaw):
    """A law whose arithmetic numba does not know."""

    mu: Positive

    def sliding_friction(self, speed):
        """Through a dictionary of Python objects."""
        return {"mu": self.mu, None: object()}["mu"]


@njit
def friction_at(law, speed):
    return law.sliding_friction(speed)


LOOKALIKES = {
    "lookalikes.py": """
from frictionlab.laws.base import Positive, SlidingLaw

class Single(SlidingLaw):
    mu: Positive

    def sliding_friction(self, speed):
        return self.mu

class Double(SlidingLaw):
    mu: Positive

    def sliding_friction(self, speed):
        return 2.0 * self.mu
""",
    "heavy.py": """
import math
from frictionlab.compile.decorators import inner, njit

@inner
def heavy(law, speed):  # heavy, and called from three places: it is linked and not inlined
    total = law.sliding_friction(speed)
    total += 0.0 * (WORK)
    return total

@njit
def answer(law, speed):
    return heavy(law, speed) + 0.0 * heavy(law, 2.0 * speed) + 0.0 * heavy(law, 3.0 * speed)

@njit
def thrice(law, speed):  # shares it with the entry before
    return 3.0 * heavy(law, speed) + 0.0 * heavy(law, 2.0 * speed)
""".replace("WORK", " + ".join(f"math.sin(speed + {k}.5) * math.exp(-{k}.0 * speed)" for k in range(80))),
    "look.py": """
import sys
from frictionlab.compile.cache import compiled
from heavy import answer, thrice
import lookalikes
for word in sys.argv[1:]:
    kernel, name = {"3": (thrice, word[2:]), "1": (answer, word[2:])}[word[0]]
    print(compiled(kernel, getattr(lookalikes, name)(mu=0.5))(2.0))
""",
}


@deep("processes that compile")
def test_kernels_kept_by_two_processes_do_not_take_each_others_place(tmp_path):
    for name, text in LOOKALIKES.items():
        (tmp_path / name).write_text(text)
    environment = {**os.environ, "FRICTIONLAB_CACHE": str(tmp_path / "cache")}

    def answers(*names: str) -> list[float]:
        command = [sys.executable, "look.py", *names]
        done = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
        )
        return [float(line) for line in done.stdout.split()]

    assert answers("1 Single") == [0.5]
    assert answers("1 Double", "3 Double") == [1.0, 3.0]
    assert answers("3 Single") == [1.5]
    assert answers("1 Single", "3 Double", "3 Single", "1 Double") == [0.5, 3.0, 1.5, 1.0]
    assert answers("3 Double", "1 Single") == [3.0, 0.5]


def test_a_law_that_numba_cannot_compile_says_so_and_still_runs_interpreted():
    law = Interpreted(mu=0.4)
    run = compiled(friction_at, law)

    with pytest.raises(CannotCompile) as caught:
        run(1.0)
    assert "law Interpreted (test_cache) cannot be compiled by numba" in str(caught.value)
    assert "In its methods use only float and complex arithmetic, the math module" in str(caught.value)
    assert friction_at.py_func(law, 1.0) == 0.4


def test_a_mistake_in_the_arguments_of_a_compiled_kernel_is_not_blamed_on_the_law():
    with pytest.raises(TypeError):
        compiled(friction_at, Coulomb(mu=0.4))(1.0, 2.0, 3.0)


@njit
def summed_friction(law, speeds):
    total = 0.0
    for speed in speeds:
        total += law.sliding_friction(speed)
    return total


class Linear(SlidingLaw):
    """Two parameters, which must not be mixed up."""

    slope: Positive
    mu: Positive

    def sliding_friction(self, speed):
        """Rises with speed."""
        return self.mu + self.slope * speed


def same_code():
    class Doubled(SlidingLaw):
        """Made anew by each call, as by a file that is read twice."""

        mu: Positive

        def sliding_friction(self, speed):
            """Twice mu."""
            return 2.0 * self.mu

    return Doubled


def test_entries_of_one_law_see_it_as_one_type_and_another_class_of_its_code_takes_nothing_from_it():
    law, other = same_code()(mu=0.3), same_code()(mu=0.4)

    assert compiled(friction_at, law)(1.0) == 0.6
    assert compiled(friction_at, other)(1.0) == 0.8
    assert compiled(summed_friction, law)(np.ones(2)) == 1.2
    assert compiled(summed_friction, other)(np.ones(2)) == 1.6
    kinds = {
        type(compiled(run, each).bound[0]) for run in (friction_at, summed_friction) for each in (law, other)
    }
    assert len(kinds) == 1


def test_one_kernel_serves_laws_of_different_kinds_and_parameters():
    speeds = np.array([0.0, 1.0, 3.0])

    assert compiled(summed_friction, Coulomb(mu=0.5))(speeds) == 1.5
    assert compiled(summed_friction, Linear(mu=0.5, slope=2.0))(speeds) == 9.5
    assert compiled(summed_friction, Coulomb(mu=0.25))(speeds) == 0.75
    assert compiled(summed_friction, Linear(slope=0.5, mu=2.0))(speeds) == 8.0


def _line(scale, v):
    return scale * v


def _plane(scale, v):
    return scale * v.imag


chosen = by_dimension(_line, _plane)


@njit
def along_or_across(scale, v):
    return chosen(scale, v)


@pytest.mark.parametrize(("v", "expected"), [(3.0, 6.0), (3.0 + 5.0j, 10.0)])
def test_a_pair_of_bodies_is_chosen_by_the_type_of_the_last_argument(v, expected):
    assert along_or_across.py_func(2.0, v) == expected
    assert along_or_across(2.0, v) == expected
    assert compiled(along_or_across)(2.0, v) == expected
    assert chosen.bodies == (_line, _plane)


@njit
def quotient(a, b):
    return a / b


@inner
def _twice(v):
    return 2.0 * v


@njit
def twice_twice(v):
    return _twice(_twice(v))


def test_what_only_kernels_call_is_made_to_run_within_their_entries_alone(tmp_path, monkeypatch):
    monkeypatch.setenv("FRICTIONLAB_CACHE", str(tmp_path))
    run = compiled(twice_twice)
    assert run(3.0) == 12.0
    (part,), (whole,) = _twice.overloads.values(), run.entry.overloads.values()
    engine = whole.library.codegen._engine

    assert not twice_twice.overloads  # which Python has not called
    assert engine.is_symbol_defined(whole.fndesc.llvm_func_name)
    assert not engine.is_symbol_defined(part.fndesc.llvm_func_name)


def test_compiled_division_follows_ieee_754():
    assert compiled(quotient)(1.0, 0.0) == math.inf
    assert math.isnan(compiled(quotient)(0.0, 0.0))


def test_threads_that_ask_for_one_kernel_at_once_get_one_entry():
    threads = 8
    start = threading.Barrier(threads)

    def ask(_):
        start.wait()
        return compiled(friction_at, Coulomb(mu=0.25)).entry

    with ThreadPoolExecutor(threads) as pool:
        for _ in range(20):
            cache._entry.cache_clear()
            assert len(set(pool.map(ask, range(threads)))) == 1


def test_laws_that_a_process_has_met_change_no_name_of_a_kernel():
    """They did: what was compiled after another law had been used was compiled anew by every process that had not."""
    before = cache._fingerprint(maps_of, LuGre)
    cache._numbers(KnownLaw(Coulomb, ()), ("a_name_that_no_law_has",))

    assert cache._fingerprint(maps_of, LuGre) == before
