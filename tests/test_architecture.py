"""The page on the architecture says what the code is: its drawing, its rooms and the files it sends a reader to."""

from __future__ import annotations

import re

import architecture
from profiles import deep
from structure import arrows, floors, tree_of

PAGE = (architecture.PROJECT / "docs" / "architecture.md").read_text()


@deep("reads all sources")
def test_the_drawing_is_that_of_the_imports() -> None:
    assert architecture.PICTURE.read_text() == architecture.picture(), "run: python tests/architecture.py"


@deep("reads all sources")
def test_every_room_has_its_line() -> None:
    rooms = set(arrows(tree_of(architecture.PROJECT)))
    table = PAGE.partition("| room |")[2].partition("\n\n")[0]

    assert rooms == {
        name for line in table.splitlines()[1:] for name in re.findall(r"`(\w+)`", line.split("|")[1])
    }


def test_every_file_named_is_there() -> None:
    places = set(re.findall(r"`((?:[\w*]+/)+(?:[\w*]+\.py)?|\w+\.py|\w+\.toml)`", PAGE))
    roots = architecture.PROJECT, architecture.PROJECT / "frictionlab"

    assert [each for each in places if not any(list(root.glob(each.rstrip("/"))) for root in roots)] == []


@deep("reads all sources")
def test_a_room_stands_above_all_it_imports() -> None:
    drawn = arrows(tree_of(architecture.PROJECT))
    height = floors(drawn)

    assert all(height[above] > height[below] for above, rooms in drawn.items() for below in rooms)


def test_the_tests_run_as_other_machines_round_are_there() -> None:
    named = (architecture.PROJECT / "tests" / "other_machines.sh").read_text().partition("numbers=(")[2]
    folders = re.findall(r"tests/\{([\w,]+)\}", named.partition(")")[0])[0].split(",")

    assert [
        each for each in folders if not list((architecture.PROJECT / "tests" / each).glob("**/test_*.py"))
    ] == []
