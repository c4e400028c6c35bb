"""Text of a study: whole characters alone, and messages that show every character without obeying it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from study_mistakes import GOOD

from frictionlab.study.load import load_study, parse_study
from frictionlab.study.written import yaml_text
from frictionlab.values.notes import StudyError
from frictionlab.values.printable import one_line, printable


def told(path: Path, text: str, overrides: tuple[str, ...] = ()) -> str:
    """The mistakes of a study of this text."""
    path.write_text(text, encoding="utf-8", newline="")
    with pytest.raises(StudyError) as caught:
        load_study(path, overrides)
    return str(caught.value)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "study.yaml"


def with_title(written: str) -> str:
    return GOOD.replace("title: Two loads", f"title: {written}")


def test_two_halves_of_a_character_as_json_writes_them_are_the_character(file: Path) -> None:
    file.write_text(with_title(r'"\ud83d\ude00 \u0041"'))

    assert load_study(file).title == "\N{GRINNING FACE} A"


def test_half_a_character_is_shown_as_such(file: Path) -> None:
    file.write_text(with_title(r'"a \ud83d"'))

    assert load_study(file).title == "a \N{REPLACEMENT CHARACTER}"


@pytest.mark.parametrize(
    "mistake",
    [
        GOOD.replace("title:", '"\\e[31m\\a":'),
        GOOD.replace("kind: coulomb, mu: 0.4", 'kind: "\\e[2J"'),
        GOOD.replace("kind: coulomb, mu: 0.4", 'kind: coulomb, "\\a": 1'),
        GOOD.replace("auto", '"\\u202eotua"'),
        GOOD.replace("laws.soft.mu", '"laws.\\esoft.mu"'),
        GOOD.replace("law: coulomb, scene", '"\\x9b1m": 2, scene'),
        GOOD.replace("label: second", 'label: "a\\nb"'),
        GOOD.replace("Two loads", "\x1b[31m"),
        GOOD.replace("Two loads", "[\x85\u2028]"),
    ],
)
def test_a_message_shows_control_characters_and_does_not_obey_them(file: Path, mistake: str) -> None:
    message = told(file, mistake)

    assert printable(message) == message
    assert all(re.match(r"    |/.*study\.yaml:\d+:\d+: ", line) for line in message.splitlines())


def test_an_override_is_shown_on_one_line(file: Path) -> None:
    first, *_ = told(file, GOOD, ("no\nsuch\x1b=1",)).splitlines()

    assert first.startswith(r"--set no\nsuch\x1b=1: ")


def test_the_caret_stands_below_the_character_of_an_escaped_line(file: Path) -> None:
    line, caret = told(file, GOOD.replace("Two loads", "a\x1b\x1bb")).splitlines()[1:]

    assert line[caret.index("^") :].startswith(r"\x1b\x1bb")


def test_what_is_printable_stays_and_the_rest_is_escaped() -> None:
    assert printable("é 日本 \N{GRINNING FACE}\t\n~") == "é 日本 \N{GRINNING FACE}\t\n~"
    assert printable("\x00\x1b\x7f\x9b\u2028\ud83d") == r"\x00\x1b\x7f\x9b\u2028\ud83d"
    assert one_line("a\tb\n") == r"a\tb\n"


@pytest.mark.parametrize(
    "title", ["\x7f", "\x85", "\u2028", "\ufeff", "a\x1b[31m", "\\x7f", "\\", "a  b\n c "]
)
def test_a_text_of_any_characters_survives_the_saved_study(file: Path, title: str) -> None:
    file.write_text(GOOD)
    study = parse_study(load_study(file).resolved() | {"title": title})
    text = yaml_text(study.resolved())
    file.write_text(text, encoding="utf-8")

    assert printable(text) == text
    assert load_study(file) == study
