"""Every public name has a docstring with an example, and every example gives what it shows."""

from __future__ import annotations

import doctest
import inspect
from functools import cached_property
from pathlib import Path
from typing import Any

import matplotlib
import pytest

import frictionlab as fl
from frictionlab.analysis.needs.needs import Needs
from frictionlab.runner.run import Run

RESULTS = fl.Comparison, fl.SteadyState, Run, Needs
"""What users are handed: every method and property of theirs is public."""
METHODS = {fl.Scene: ["with_"], fl.Study: ["of", "to_yaml", "cases"]}


def _members(kind: type[Any]) -> dict[str, Any]:
    """Methods and properties that a class defines."""
    wanted = property, cached_property
    return {
        name: member
        for name, member in vars(kind).items()
        if name[0] != "_" and (inspect.isfunction(member) or isinstance(member, wanted))
    }


PUBLIC: dict[str, Any] = {name: getattr(fl, name) for name in fl.__all__ if name != "__version__"}
PUBLIC |= {kind.__name__: kind for kind in RESULTS}
PUBLIC |= {f"{kind.__name__}.{name}": each for kind in RESULTS for name, each in _members(kind).items()}
PUBLIC |= {
    f"{kind.__name__}.{name}": getattr(kind, name) for kind, names in METHODS.items() for name in names
}


def _examples(thing: Any) -> list[doctest.Example]:
    return doctest.DocTestParser().get_examples(inspect.getdoc(thing) or "")


@pytest.mark.parametrize("name", PUBLIC)
def test_the_example_of_a_public_name_gives_what_it_shows(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    test = doctest.DocTest(_examples(PUBLIC[name]), {}, name, None, None, None)
    said: list[str] = []

    found = doctest.DocTestRunner().run(test, out=said.append)

    assert found.attempted > 0, f"{name} has no example in its docstring"
    assert found.failed == 0, "".join(said)


def test_a_docstring_without_an_example_is_noticed() -> None:
    assert not _examples(fl.Scene.at)
    assert len(_examples(fl.Scene)) > 1
