"""Docstrings as the site shows them: a table of the parameters, with types; what is raised; then the example."""

from __future__ import annotations

import inspect
import re
from itertools import pairwise
from typing import Any

from said_of_parameters import COMMON, SHORT, TYPES
from sphinx.application import Sphinx

SETTING = {
    ">>> import frictionlab as fl",
    ">>> drive = fl.Drive(unbalance=10, frequency=1)",
    ">>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)",
    ">>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, "
    "drive=fl.Drive(unbalance=10, frequency=1))",
    ">>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4))",
    ">>> done = fl.compare(scene, [fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=40)], belt_speed=[5, 25, 45])",
}
"""Lines that nearly every example begins with; the pages show them once."""
CODE = re.compile(r"(``[^`]+``)")
MARKS = re.compile(r"([\\*|_`])")
UNIT = r"(?: \[[^\]]*\])?"
RAISED = re.compile(r"(?<![\w`.])([A-Z]\w*(?:Error|Plugin|Values)|Interrupted)\b")
BY_ALL = re.compile(
    r"(?:^|,\s+)ValueError or TypeError for what\s+makes no\s+sense(?:, BrokenPlugin)?(?=\.$)"
)
"""What every function raises, which the page says once."""
LONGEST_OF_MEMBERS = 2
"""Lines: a longer example of a method or property has a setting of its own, which its class shows."""
MADE_BY_OTHERS = {"SteadyState", "Run", "Comparison", "Needs", "Study", "FittedLaws"} | {
    "Equivalent",
    "Experiments",
}
"""Classes that a user is handed: what they hold is told in words."""


def _process(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    text, example = _without_example(lines, f"fl.{name.rpartition('.')[2]}(")
    handed = what == "class" and name.rpartition(".")[2] in MADE_BY_OTHERS
    parameters = {} if handed or what not in ("function", "class", "method") else _parameters(obj)
    text, entries = _without_entries(text, list(parameters))
    shared = {each for each in parameters if _says_nothing_new(each, entries, SHARED.get(what, {}))}
    table = _table(parameters, entries, shared) if (entries if what == "method" else parameters) else []
    text, raised = _without_raised(text)
    if what in ("method", "property") and len(example) > LONGEST_OF_MEMBERS:
        example = []
    lines[:] = [*_plain(text).splitlines(), "", *table, "", *raised, "", *example]


def _without_example(lines: list[str], call: str) -> tuple[str, list[str]]:
    """The text, and the example up to the next empty line without what all examples begin with, but for this call."""
    text: list[str] = []
    example: list[str] = []
    inside = False
    for line in lines:
        inside = line.startswith(">>>") or (inside and line != "")
        (example if inside else text).append(line)
    return "\n".join(text), [line for line in example if line not in SETTING or call in line]


def _parameters(obj: Any) -> dict[str, inspect.Parameter]:
    try:
        found = inspect.signature(obj).parameters
    except (TypeError, ValueError):
        return {}
    return {name: each for name, each in found.items() if name not in ("self", "label")}


def _without_entries(text: str, names: list[str]) -> tuple[str, dict[str, tuple[str, str, str]]]:
    """The text without what it says of parameters, and that: unit and range, meaning, by the first name.

    An entry begins a line or a sentence: one name or several, each perhaps with a unit, a range, then a colon.
    """
    if not names:
        return text, {}
    one = rf"(?:{'|'.join(map(re.escape, names))})\b{UNIT}"
    begin = re.compile(
        rf"(?:^|(?<=\. ))(?={one}(?:(?:,| or|;) {one})*(?:, [<>]=? ?[\w.]+)*(?: \([^)]*\))?(?::|;|\.$| \())",
        re.M,
    )
    kept: list[str] = []
    entries: dict[str, tuple[str, str, str]] = {}
    for block in re.split(r"\n\n+", text):
        starts = [found.start() for found in begin.finditer(block)]
        before = block[: starts[0]] if starts else block
        kept.append("" if starts and before.rstrip().endswith(":") else before)
        for start, end in pairwise([*starts, len(block)]):
            said, *more = re.split(r"\n(?=Sources?: |Raises )", block[start:end], maxsplit=1)
            head, colon, meaning = " ".join(said.split()).partition(": ")
            for part in [head] if colon else re.split(r"; |, (?=\w+ \[)| or ", head):
                bare = re.sub(r"\[[^\]]*\]|\([^)]*\)|[<>]=? ?\w+", "", part)
                told = [name for name in names if re.search(rf"(?<![\w.]){name}\b", bare)]
                limits = re.findall(r"(?<=\[)[^\]]*|[<>]=? ?[\w.]+", part)
                entries[told[0]] = ", ".join(told), ", ".join(limits), meaning.rstrip(".;\n ")
            kept += more
    return "\n\n".join(kept), entries


def _without_raised(text: str) -> tuple[str, list[str]]:
    """The text without its sources; what is raised, linked to the reasons."""
    told = re.sub(r"(?:^|\n|(?<=\. ))(?=Sources?: |Raises [A-Z])", "\n\n", text)
    paragraphs = re.split(r"\n\n+", told)
    raised = [
        BY_ALL.sub("", each.removeprefix("Raises ")) for each in paragraphs if each.startswith("Raises ")
    ]
    linked = [RAISED.sub(r":ref:`\1 <what-is-raised>`", each) for each in raised if each.strip(".\n ")]
    left_out = ("Raises ", "Source: ", "Sources: ")  # what is computed, and from whom, is in theory
    kept = "\n\n".join(each for each in paragraphs if not each.startswith(left_out))
    return kept, [line for each in linked for line in [f"**Raises** {each}", ""]]


def _plain(text: str) -> str:
    """Nothing in it is markup but code: ``|v|`` is a speed. Symbols are shown as symbols."""
    parts = CODE.split(text)
    return "".join(part if odd % 2 else MARKS.sub(r"\\\1", _symbols(part)) for odd, part in enumerate(parts))


def _symbols(text: str) -> str:
    for written, symbol in SYMBOLS.items():
        text = re.sub(rf"(?<!\w){re.escape(written)}(?!\w)", symbol, text)
    return text


SYMBOLS = {
    "omega_1": "ω₁",
    "omega_2": "ω₂",
    "omega_r": "ωᵣ",
    "K_1": "K₁",
    "K_2": "K₂",
    "C_1": "C₁",
    "C_2": "C₂",
}
SYMBOLS |= {"beta_1": "β₁", "beta_2": "β₂", "gamma^2": "γ²"}


def _says_nothing_new(name: str, entries: dict[str, tuple[str, str, str]], shared: dict[str, str]) -> bool:
    """Whether the table of what many take says all of this parameter."""
    _, _, meaning = entries.get(name, ("", "", ""))
    return name in shared and (not meaning or meaning.startswith(shared[name]))


OF_FUNCTIONS = dict.fromkeys(("scene", "law", "laws", "method", "methods", "executor", "progress"), "")
OF_FUNCTIONS |= {"tolerance": "absolute", "columns": "result columns"}
OF_CLASSES = dict.fromkeys(
    ("phase", "waveform", "direction", "frequency_ratio", "stribeck_speed", "viscosity"), ""
)
OF_CLASSES |= dict.fromkeys(("stiffness", "presliding_length", "contact_stiffness"), "exactly one")
OF_CLASSES |= dict.fromkeys(("damping", "contact_damping", "planar", "stribeck_exponent"), "-")
SHARED = {"function": OF_FUNCTIONS, "class": OF_CLASSES}
"""By parameter what an entry begins with that needs no row of its own; none is as good."""


def _table(
    parameters: dict[str, inspect.Parameter], entries: dict[str, tuple[str, str, str]], shared: set[str]
) -> list[str]:
    """A row for each parameter, in their order; those told of together are one, shared ones have none."""
    together = {name for told, _, _ in entries.values() for name in told.split(", ")[1:]} | shared
    rows = []
    for name, each in parameters.items():
        if name in together:
            continue
        told, limits, meaning = entries.get(name, (name, "", ""))
        meaning = re.sub(r"; or instead$", ", or instead the next", meaning)
        meaning = SHORT.get(name) or meaning or COMMON.get(name, "")
        names = ", ".join(f"``{one}{_default(parameters[one])}``" for one in told.split(", "))
        limits = "none" if limits == "-" else re.sub(r"^-, ", "", limits)
        rows.append([names, _type(each), _plain(limits), _plain(" ".join(meaning.split()))])
    heads = ["parameter", "type", "unit, range", "meaning"]
    columns = [0, 1, *(column for column in (2, 3) if any(row[column] for row in rows))]
    own = ", ".join(f"``{name}``" for name in parameters if name in shared.intersection(OF_CLASSES))
    said = f"{own}: :ref:`as in others <shared-by-classes>`." if own else ""
    said = said or f"{'Others' if rows else 'All'} are :ref:`the shared ones <shared-parameters>`."
    others = [said] if shared else []
    if not rows:
        return others
    lines = [".. list-table::", "   :header-rows: 1", "   :class: parameters", ""]
    for row in [heads, *rows]:
        cells = [row[column] for column in columns]
        lines += [
            f"   {'-' if column else '* -'} {cell}".replace("   - ", "     - ")
            for column, cell in enumerate(cells)
        ]
    return [*lines, "", *others]


def _default(parameter: inspect.Parameter) -> str:
    """What it is where left out, if that is said in few signs."""
    value = parameter.default
    plain = isinstance(value, (str, int, float, bool)) and value != ""
    return f"={value!r}" if plain else ""


def _type(parameter: inspect.Parameter) -> str:
    """In words; classes of this package lead to their entry."""
    said = parameter.annotation
    if said is inspect.Parameter.empty:
        return ""
    text = said if isinstance(said, str) else inspect.formatannotation(said)
    text = re.sub(r"\b(?:typing|collections\.abc|os|pd|concurrent\.futures(?:\._base)?)\.", "", text)
    text = re.sub(r"\bfrictionlab(?:\.\w+)*\.", "", text)
    text = re.sub(r"Literal\[([^\]]*)\]", r"\1", text)
    for said, told in TYPES.items():
        text = re.sub(said, told, text)
    text, optional = re.subn(r" \| None\b", "", text)
    told = _plain(" or ".join(text.split(" | ")))
    told = re.sub(r"(?<!\w)([A-Z][A-Za-z]+)(?!\w)", _linked, told)
    return told + (", optional" if optional or parameter.default is None else "")


def _linked(name: re.Match[str]) -> str:
    import frictionlab

    own = name[1] in frictionlab.__all__ and isinstance(getattr(frictionlab, name[1]), type)
    return f":py:class:`{name[1]} <frictionlab.{name[1]}>`" if own else name[1]


def _short(
    app: Sphinx, what: str, name: str, obj: Any, options: Any, args: str | None, back: str | None
) -> Any:
    """No list of parameters behind the name of a class: its table has them."""
    return ("", None) if what == "class" else (args, back)


def setup(app: Sphinx) -> dict[str, Any]:
    """Change docstrings before they are read."""
    app.connect("autodoc-process-docstring", _process)
    app.connect("autodoc-process-signature", _short)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
