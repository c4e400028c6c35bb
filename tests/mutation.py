"""Change our laws and closed forms one thing at a time, and ask whether tests notice.

    python tests/mutation.py [--every N] [FILE...]

FILEs of frictionlab/laws and frictionlab/theory, all where left out; every N-th mutant of each. A law is put through
the tests of ``tests/laws`` that compile nothing and the default run has; a closed form through those of
``tests/theory/test_*.py``, then these. With ``HYPOTHESIS_PROFILE=deep`` a law goes through the conformance battery
first (what compiles nothing, few examples a check), and tests of the deep profile count, too. Everything is imported
once; each mutant is tried in a fork of this process. The last lines are the survivors and the score.
"""

from __future__ import annotations

import argparse
import gc
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import FunctionType
from typing import Any

import hypothesis
import pytest
from _pytest.runner import runtestprotocol
from mutants import Mutant, mutants
from profiles import DEEP

from frictionlab.laws.base import FrictionLaw
from frictionlab.study import registry
from frictionlab.testing import CHECKS, check_law, running
from frictionlab.testing.strategies import quietly, unloaded_laws

ROOT = Path(__file__).parents[1]
SECONDS = 40.0
"""Of processor time for one mutant. One that goes on for longer (a loop without end) has been noticed."""
EXAMPLES = 6
KILLED, SURVIVED = 1, 0
USED_BY = {
    "base": ("coulomb", "stribeck", "dahl"),
    "compliant": ("dahl", "lugre", "jenkins"),
    "decay": ("stribeck", "dahl", "lugre"),
    "stribeck_bristle": ("lugre", "elasto-plastic"),
    "memory": ("dahl", "lugre"),
    "arrays": (),
    "labelled": (),
}
"""Laws to put through the battery for files that hold none themselves."""
QUICK = [check.name for check in CHECKS if check.patience == 1.0]


class Session:
    """Runs in place of pytest's own loop, with its tests collected and ready."""

    def __init__(self, chosen: list[Mutant]) -> None:
        self.chosen = chosen
        self.ends: list[tuple[Mutant, str]] = []

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: Any) -> bool:
        for name in registry.law_names():  # which parameters go together is found out once, for all forks
            unloaded_laws(registry.law_class(name))
        for check in (
            lambda: DEEP and _battery_notices(_laws(ROOT / "dahl.py")),
            lambda: _tests_notice(session.items),
        ):
            assert not check(), "the tests fail without any mutant"
        for number, mutant in enumerate(self.chosen, 1):
            end = _tried(mutant, _noticing(mutant, session.items))
            self.ends.append((mutant, end))
            print(f"{number}/{len(self.chosen)} {end:8} {mutant}", flush=True)
        return True


def _noticing(mutant: Mutant, items: list[Any]) -> Callable[[], bool]:
    """What must notice a mutant."""
    theory = mutant.file.parent.name == "theory"
    of_theory = [item for item in items if "theory" in item.path.parts]
    of_laws = [item for item in items if item not in of_theory]
    if theory:
        return lambda: _tests_notice(of_theory + of_laws)
    laws = _laws(mutant.file)
    own = [item for item in of_laws if _is_for(item, laws)]
    return lambda: (DEEP and _battery_notices(laws)) or _tests_notice(own)


def _is_for(item: Any, laws: list[type[FrictionLaw]]) -> bool:
    """Whether a test is of one of these laws, or of none in particular."""
    name = getattr(item, "callspec", None) and item.callspec.params.get("name")
    return not isinstance(name, str) or not laws or registry.law_class(name) in laws


def _laws(file: Path) -> list[type[FrictionLaw]]:
    names = USED_BY.get(file.stem, (file.stem.replace("_", "-"),))
    return [registry.law_class(name) for name in names]


def _battery_notices(laws: list[type[FrictionLaw]]) -> bool:
    for law in laws:
        for check in QUICK:
            if not check_law(law, only=[check], examples=EXAMPLES, on_failure="return").passed:
                return True
    return False


def _tests_notice(items: list[Any]) -> bool:
    for item in items:
        reports = runtestprotocol(item, log=False, nextitem=None)
        if any(report.failed for report in reports):
            return True
    return False


def _tried(mutant: Mutant, notices: Callable[[], bool]) -> str:
    """Fork, mutate, ask; what became of the mutant."""
    child = os.fork()
    if child == 0:
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(1, 2)
        try:
            _mutate(mutant)
            os._exit(KILLED if notices() else SURVIVED)
        except BaseException:
            os._exit(KILLED)
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return "timeout"
    return "killed" if os.WEXITSTATUS(status) == KILLED else "survived"


def _mutate(mutant: Mutant) -> None:
    """Give the function the mutant's code, wherever it is held: by a class, by pydantic, by another module."""
    for each in gc.get_objects():
        if isinstance(each, FunctionType) and _names(each) == (mutant.file, mutant.function):
            each.__code__ = mutant.code


def _names(function: FunctionType) -> tuple[Path, str]:
    """Its file and its name there."""
    return Path(function.__code__.co_filename), function.__code__.co_qualname


def _of(files: list[Path], every: int) -> list[Mutant]:
    folders = [ROOT / "frictionlab" / name for name in ("laws", "theory")]
    files = files or [
        file for folder in folders for file in sorted(folder.glob("*.py")) if file.name != "faults.py"
    ]
    return [mutant for file in files for mutant in list(mutants(file.resolve()))[::every]]


def main() -> None:
    """Try the mutants and print what became of them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("files", nargs="*", type=Path)
    asked = parser.parse_args()
    hypothesis.settings.register_profile("mutation", max_examples=EXAMPLES, deadline=None, database=None)
    running.quietly = lambda examples, *_: quietly(examples)  # the first counterexample will do
    session = Session(_of(asked.files, asked.every))
    where = [str(ROOT / "tests" / name) for name in ("laws", "theory")]
    quiet = ["-n", "0", "-q", "-W", "ignore", "-p", "no:cacheprovider"]
    few = ["--hypothesis-profile", "mutation"] if DEEP else []
    kinds = "not compiled and not machine" + (
        " and not conforms" if DEEP else ""
    )  # the battery is asked already
    pytest.main([*where, *quiet, *few, "-k", kinds], plugins=[session])
    _report(session.ends)


def _report(ends: list[tuple[Mutant, str]]) -> None:
    print("\nsurvivors:")
    for mutant, end in ends:
        if end == "survived":
            print(f"  {mutant}")
    for folder in ("laws", "theory"):
        mine = [end for mutant, end in ends if mutant.file.parent.name == folder]
        counts = ", ".join(f"{mine.count(end)} {end}" for end in ("killed", "timeout", "survived"))
        print(f"{folder}: {len(mine)} mutants: {counts}")


if __name__ == "__main__":
    sys.exit(main())
