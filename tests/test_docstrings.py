"""Every public name has a docstring in numpydoc form, and every example in it gives what it shows."""

from __future__ import annotations

import doctest
import inspect
import re
from ast import literal_eval
from functools import cached_property
from pathlib import Path
from types import FunctionType, MethodType
from typing import Any

import matplotlib
import pytest

import frictionlab as fl
from frictionlab.analysis.fit.equivalent import Equivalent
from frictionlab.analysis.fit.result import FittedLaws
from frictionlab.analysis.needs.needs import Needs
from frictionlab.runner.steady_state import DriftSpeed

RESULTS = fl.Run, fl.SteadyState, Needs, FittedLaws, Equivalent, DriftSpeed
"""What users are handed: every method and property of theirs is public."""
METHODS = {fl.Scene: ["with_"], fl.Study: ["of", "to_yaml", "cases"]}
HANDED = *RESULTS, fl.Study
"""Classes that users do not construct: their fields are attributes."""

SECTIONS = ["Parameters", "Attributes", "Returns", "Raises", "See Also", "Notes", "References", "Examples"]
"""Sections in the order of numpydoc."""
BAD_BEGINNINGS = "The", "What", "Whether", "Of", "How", "Where"


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


def _sections(docstring: str) -> dict[str, str]:
    """Text of each numpydoc section by its name; '' for what stands before the first."""
    first, *others = re.split(r"^(\S.*)\n(-+)\n", f"{docstring}\n", flags=re.MULTILINE)
    assert [len(name) for name in others[0::3]] == [len(line) for line in others[1::3]], "lines below names"
    return {"": first} | dict(zip(others[0::3], others[2::3], strict=True))


def _entries(text: str) -> dict[str, tuple[str, str]]:
    """Type and meaning by the name of an entry: ``name : type``, and the meaning indented below."""
    found = re.findall(r"^(\S.*)\n((?:(?: +\S.*)?\n)*)", text, re.MULTILINE)
    heads = [(head.partition(" : "), " ".join(meaning.split())) for head, meaning in found]
    return {name: (kind, meaning) for (name, _, kind), meaning in heads}


def _wanted(thing: Any) -> set[str]:
    """Names of the parameters of a function, or of the fields of a class. ``label`` is told once for all."""
    if not isinstance(thing, type | FunctionType | MethodType):
        return set()
    stars: dict[Any, str] = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    taken = inspect.signature(thing).parameters.values()
    return {f"{stars.get(each.kind, '')}{each.name}" for each in taken} - {"self", "label"}


def _returns(thing: Any) -> bool:
    said = isinstance(thing, FunctionType | MethodType) and inspect.signature(thing).return_annotation
    return said not in (False, None, "None")


def _other_defaults(thing: Any, fields: dict[str, tuple[str, str]]) -> list[str]:
    """Names of the parameters whose docstring has another default than their signature."""
    taken = inspect.signature(thing).parameters if fields else {}
    told = {name: kind.partition("default ")[2] for name, (kind, _) in fields.items() if name in taken}
    left_out = {name: taken[name].default for name, default in told.items() if default}
    return [name for name, value in left_out.items() if literal_eval(told[name]) not in (value, str(value))]


def mistakes(thing: Any) -> list[str]:
    """Tell in which points the docstring of a public name is not in numpydoc form."""
    docstring = inspect.getdoc(thing) or ""
    parts, (first, second) = _sections(docstring), [*docstring.split("\n"), ""][:2]
    names, text = [name for name in parts if name], "".join(parts.values())
    given, own, returned, raised = (_entries(parts.get(name, "")) for name in SECTIONS[:4])
    reasons = [why for part in (given, own, returned, raised) for _, why in part.values()]
    fields, of_class = (own, given) if thing in HANDED else (given, own)
    wanted, is_property = _wanted(thing), isinstance(thing, property | cached_property)
    found = {
        "first line is no sentence": not first.endswith(".") or second,
        "first line begins with": first.partition(" ")[0] in BAD_BEGINNINGS,
        "a colon, which napoleon reads as a type": is_property and ": " in first,
        "sections": names != [each for each in SECTIONS if each in names] or "---" in text,
        "not told": sorted(wanted - set(fields)),
        "told, but not there": sorted(set(fields) - wanted - {"label"})
        + [name for name in of_class if not hasattr(thing, name)],
        "without a type": [name for name, (kind, _) in [*given.items(), *own.items()] if not kind],
        "another default": _other_defaults(thing, fields),
        "without a meaning": "" in reasons,
        "Returns": bool(returned) != _returns(thing),
    }
    return [f"{point}: {where}" for point, where in found.items() if where]


@pytest.mark.parametrize("name", PUBLIC)
def test_a_public_name_has_a_docstring_in_numpydoc_form(name: str) -> None:
    assert mistakes(PUBLIC[name]) == []


def _right(speed: float, **others: float) -> float:
    """Return a number.

    Parameters
    ----------
    speed : float
        Speed.
    **others : float
        Others.

    Returns
    -------
    float
        Number.
    """
    return speed


@pytest.mark.parametrize(
    ("right", "wrong", "point"),
    [
        ("Return a number.", "Return a number", "first line is no sentence: True"),
        ("Return a number.", "The number.", "first line begins with: True"),
        ("speed : float\n        Speed.\n    ", "", "not told: ['speed']"),
        ("**others : float", "load : float", "told, but not there: ['load']"),
        ("speed : float", "speed", "without a type: ['speed']"),
        ("speed : float", "speed : float, default 1", "another default: ['speed']"),
        ("        Speed.\n", "", "without a meaning: True"),
        ("\n    Returns\n    -------\n    float\n        Number.\n", "", "Returns: True"),
        ("Returns\n    -------", "Result\n    ------", "sections: True"),
        ("Returns\n    -------", "Returns -------", "sections: True"),
        (
            "Return a number.",
            "Return a number.\n\n    Returns\n    -------\n    float\n        Number.",
            "sections: True",
        ),
    ],
)
def test_a_docstring_in_another_form_is_noticed(right: str, wrong: str, point: str) -> None:
    def other(speed: float, **others: float) -> float:
        return speed

    told = _right.__doc__ or ""
    assert mistakes(_right) == []
    assert right in told

    other.__doc__ = told.replace(right, wrong)
    assert point in mistakes(other)


def _examples(thing: Any) -> list[doctest.Example]:
    docstring = inspect.getdoc(thing) or ""
    return doctest.DocTestParser().get_examples(_sections(docstring).get("Examples", ""))


@pytest.mark.parametrize("name", PUBLIC)
def test_the_example_of_a_public_name_gives_what_it_shows(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    owner, _, member = name.rpartition(".")
    if owner and not _examples(PUBLIC[name]):  # then the example of its class uses it
        assert any(f".{member}" in each.source for each in _examples(PUBLIC[owner])), (
            f"no example uses {name}"
        )
        return
    test = doctest.DocTest(_examples(PUBLIC[name]), {}, name, None, None, None)
    said: list[str] = []

    found = doctest.DocTestRunner().run(test, out=said.append)

    assert found.attempted > 0, f"{name} has no example in its docstring"
    assert found.failed == 0, "".join(said)


def test_a_docstring_without_an_example_is_noticed() -> None:
    assert not _examples(fl.Scene.at)
    assert len(_examples(fl.Scene)) > 1
