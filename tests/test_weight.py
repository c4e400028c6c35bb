"""Every room keeps to its budget of code lines. A limit is lowered when a room shrinks and never raised."""

from __future__ import annotations

from profiles import deep
from weight import code_lines, files_of_package, lines_of_rooms

LIMITS = {
    "analysis": 2196,
    "bench": 2177,
    "beside the rooms": 87,
    "charts": 1741,
    "cli": 993,
    "compile": 1409,
    "curves": 845,
    "laws": 710,
    "methods": 8046,
    "motion": 4600,
    "report": 1435,
    "runner": 4147,
    "scene": 1854,
    "study": 2719,
    "testing": 1484,
    "theory": 844,
    "tools": 19,
    "values": 1427,
    "tests": 26414,
    "plugins": 3939,
}
"""Lines of code that a room may have; a room that needs more takes them from another in the same commit."""
MOST_FILES = 328
"""Files that the package may have."""
SPARE = 0.02
"""Share of a limit by which a room may lie below it before the limit is lowered."""


@deep("reads all sources")
def test_every_room_keeps_to_its_budget() -> None:
    lines = lines_of_rooms()

    assert {room: (count, LIMITS[room]) for room, count in lines.items() if count > LIMITS[room]} == {}


@deep("reads all sources")
def test_limits_follow_a_room_that_shrinks() -> None:
    lines = lines_of_rooms()

    assert {room: lines[room] for room, limit in LIMITS.items() if lines[room] < (1 - SPARE) * limit} == {}


def test_the_package_has_few_files() -> None:
    assert len(files_of_package()) <= MOST_FILES


def test_words_and_white_space_are_no_lines_of_code() -> None:
    text = '"""A docstring.\n\nOf three lines."""\n\nimport os\n\n# a comment\nx = (  # another\n    1,\n)\n'

    assert code_lines(text) == 3
