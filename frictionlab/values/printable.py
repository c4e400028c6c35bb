"""Text and numbers as they are shown.

A character that steers a terminal or cannot be seen is written with a backslash; a number has the digits that its
error leaves, and the error to match.
"""

from __future__ import annotations

import math
import re
from decimal import ROUND_CEILING, Decimal

_UNSEEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f"  # control characters, but for tab and line feed
    "\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufff9-\ufffb"  # line ends and directions of writing
    "\ud800-\udfff\ufeff\ufffe\uffff]"  # halves of characters, marks of byte order and what is no character
)
_BREAK = re.compile(r"[\t\n]")
MOST_DIGITS = 6
PLUS_MINUS = " \N{PLUS-MINUS SIGN} "
_LEAST_PLAIN, _MOST_PLAIN = -4, 7
"""Powers of ten between which a number is written out."""
_NEARLY_ONE = Decimal(1) - Decimal("1e-9")
"""Share of an error that is kept: rounding in its last bits does not cost a digit."""


def printable(text: str) -> str:
    """Return the text with its unseen characters as ``\\x1b`` or ``\\u2028``; tabs and line feeds stay."""
    return _UNSEEN.sub(_escaped, text)


def one_line(text: str) -> str:
    """Return the same on one line: tabs and line feeds as ``\\t`` and ``\\n``, too."""
    return _BREAK.sub(_escaped, printable(text))


def _escaped(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape").decode("ascii")


def with_error(value: float, error: float | None, most: int = MOST_DIGITS, between: str = PLUS_MINUS) -> str:
    """A number with its error, as in ``0.0577 ± 0.0002``; '' for no number.

    The error has at most two digits and is rounded up: what is written encloses what was given. A
    number stands alone where ``most`` digits are too few to show its error, and where it has none.
    """
    if value is None or math.isnan(value):
        return ""
    alone = f"{value:.{most}g}"
    if error is None or math.isnan(error) or math.isinf(value):
        return alone
    if math.isinf(error):
        return f"{value:.{MOST_DIGITS}g}{between}inf"
    number, bound = Decimal(repr(float(value))), Decimal(repr(float(error)))
    if not bound or (number and bound <= Decimal(5).scaleb(number.adjusted() - most)):
        return alone
    return _matched(number, bound, most, between)


def _matched(number: Decimal, bound: Decimal, most: int, between: str) -> str:
    place = bound.adjusted() - 1
    if number:
        place = max(place, number.adjusted() - most + 1)
    written, error = _to_place(number, bound, place)
    shorter = _to_place(number, bound, place + 1)
    if shorter[1] == error:
        written, error = shorter
    power = max(written.adjusted(), error.adjusted()) if written else error.adjusted()
    if _LEAST_PLAIN <= power < _MOST_PLAIN:
        return f"{written:f}{between}{_plain_or_power(error)}"
    return f"({written.scaleb(-power):f}{between}{error.scaleb(-power):f})e{power}"


def _to_place(number: Decimal, bound: Decimal, place: int) -> tuple[Decimal, Decimal]:
    """Both to this power of ten; what the number loses is added to the error."""
    unit = Decimal(1).scaleb(place)
    written = number.quantize(unit) + 0  # which has no sign where it is zero
    return written, ((bound + abs(number - written)) * _NEARLY_ONE).quantize(unit, ROUND_CEILING)


def _plain_or_power(bound: Decimal) -> str:
    """An error that takes more zeros than a reader counts as a power of ten."""
    if bound.adjusted() > -MOST_DIGITS - 2:
        return f"{bound:f}"
    return f"{bound.scaleb(-bound.adjusted()).normalize():f}e{bound.adjusted()}"
