"""One meaning a name: no public class, function or constant is defined in two modules."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path

from profiles import deep

import frictionlab

PACKAGE = Path(frictionlab.__file__).parent
ROLES = {"command", "on_the_line", "in_the_plane", "stepper"}
"""Names of a role: the command of a file, one thing along a line and in the plane, the function that makes a step."""
OPEN = ("motion", "methods")
"""Rooms of kernels whose names are still being told apart."""
MOST_OPEN = 39
"""Names with two meanings that are left in them: lower it, never raise it."""


def _names(path: Path) -> list[str]:
    """The public names that a module defines at its top level."""
    names: list[str] = []
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.append(node.name)
        elif isinstance(node, ast.Assign):
            names += [target.id for target in node.targets if isinstance(target, ast.Name)]
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.append(node.target.id)
    return [name for name in dict.fromkeys(names) if name[0] != "_"]


def _doubles() -> dict[str, list[str]]:
    """Public names with the modules that define them, where these are two or more."""
    homes = defaultdict(list)
    for path in sorted(PACKAGE.rglob("*.py")):
        for name in _names(path):
            homes[name].append(".".join(path.relative_to(PACKAGE).with_suffix("").parts))
    return {name: where for name, where in homes.items() if len(where) > 1 and name not in ROLES}


@deep("reads all sources")
def test_a_name_has_one_meaning() -> None:
    settled = {
        name: [home for home in homes if home.partition(".")[0] not in OPEN]
        for name, homes in _doubles().items()
    }

    assert {name: homes for name, homes in settled.items() if len(homes) > 1} == {}


@deep("reads all sources")
def test_names_with_two_meanings_get_fewer_in_the_rooms_of_kernels() -> None:
    assert len(_doubles()) <= MOST_OPEN


def test_no_two_files_of_tests_have_one_name() -> None:
    files = [path.name for path in Path(__file__).parent.rglob("test_*.py")]

    assert sorted(set(files)) == sorted(files)  # else pytest collects one of them and stops at the other


def test_docstrings_begin_with_a_verb_or_a_noun() -> None:
    bad = re.compile(r'^\s*r?"""(The|What|Whether|Of|How|Where|That|Those|These|This|Which|Who|It)\b')
    sources = [*PACKAGE.rglob("*.py"), *(PACKAGE.parent / "plugins").rglob("*.py")]
    found = [
        f"{path}: {line}"
        for path in sources
        for line in path.read_text("utf-8").split("\n")
        if bad.match(line)
    ]

    assert found == []
