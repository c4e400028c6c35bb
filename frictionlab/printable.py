"""Text as it is shown: a character that steers a terminal or cannot be seen is written with a backslash."""

from __future__ import annotations

import re

_SURROGATE = re.compile("[\ud800-\udfff]")
_UNSEEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f"  # control characters, but for tab and line feed
    "\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufff9-\ufffb"  # line ends and directions of writing
    "\ud800-\udfff\ufeff\ufffe\uffff]"  # halves of characters, marks of byte order and what is no character
)
_BREAK = re.compile(r"[\t\n]")


def printable(text: str) -> str:
    """The text with its unseen characters as ``\\x1b`` or ``\\u2028``; tabs and line feeds stay."""
    return _UNSEEN.sub(_escaped, text)


def one_line(text: str) -> str:
    """The same on one line: tabs and line feeds as ``\\t`` and ``\\n``, too."""
    return _BREAK.sub(_escaped, printable(text))


def with_joined_pairs(text: str) -> str:
    """The text with each pair of surrogates as the character that the two stand for."""
    if not _SURROGATE.search(text):
        return text
    return text.encode("utf-16", "surrogatepass").decode("utf-16", "surrogatepass")


def lone_surrogate(text: str) -> str | None:
    """The first half of a character in a text, as ``\\ud83d``; None in sound text."""
    found = _SURROGATE.search(text)
    return _escaped(found) if found else None


def _escaped(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape").decode("ascii")
