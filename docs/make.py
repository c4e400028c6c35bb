"""Write into the pages what they show of the code and of other files: ``python docs/make.py``.

A page has a comment for each place, and ``<!-- end -->`` below what was written there:

- ``<!-- frictionlab.curve -->``: the entry of a function or class, from its signature and docstring;
- ``<!-- frictionlab.Run: plot report -->``: of a class with these methods, ``: *`` with all of its own that are
  public, ``: **`` with those of its bases, ``: * -count`` without one;
- ``<!-- file ../studies/first.yaml -->``: a file as it is.

Pages of the gallery are written with the text of their studies; their pictures are those of ``docs/gallery/make.py``.
The part of the first page about Python is written as a notebook, too.
"""

from __future__ import annotations

import importlib.util
import inspect
import json
import re
from functools import cached_property
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

DOCS = Path(__file__).parent
PLACE = re.compile(
    r"^<!-- ((?:frictionlab\.|file )[^\n]*) -->\n(?:.*?^<!-- end -->\n)?", re.MULTILINE | re.DOTALL
)
LISTS = "Parameters", "Attributes", "Returns", "Raises"
"""Sections of a docstring that are lists of names."""
LANGUAGES = {".yaml": "yaml", ".py": "python", ".csv": "text"}
WIDTH = 110


def written(page: Path) -> str:
    """Text of a page with every place filled anew."""
    return PLACE.sub(
        lambda place: f"<!-- {place[1]} -->\n{_filled(place[1], page)}<!-- end -->\n", page.read_text()
    )


def _filled(place: str, page: Path) -> str:
    kind, _, name = place.partition(" ")
    if kind == "file":
        file = page.parent / name
        return f"```{LANGUAGES[file.suffix]}\n{file.read_text()}```\n"
    entry, _, members = place.partition(": ")
    thing = resolve_name(entry)
    called = f"fl.{thing.__qualname__}" if inspect.isroutine(thing) else thing.__name__
    text = _entry(called, thing, "###", page)
    for member in _members(thing, members.split()):
        text += _entry(f"{thing.__name__}.{member}", inspect.getattr_static(thing, member), "####", page)
    return text


def _members(kind: Any, wanted: list[str]) -> list[str]:
    """Return names of methods and properties in the order of the source, those of the class before its bases'."""
    if wanted[:1] not in (["*"], ["**"]):
        return wanted
    bases = (
        [kind]
        if wanted[0] == "*"
        else [base for base in kind.__mro__ if base.__module__.startswith("frictionlab")]
    )
    own = [each for base in bases for each in vars(base).items()]
    kinds = property, cached_property, classmethod, staticmethod
    names = [
        name for name, one in own if name[0] != "_" and (inspect.isfunction(one) or isinstance(one, kinds))
    ]
    return [name for name in dict.fromkeys(names) if f"-{name}" not in wanted]


def _entry(called: str, thing: Any, level: str, page: Path) -> str:
    """Heading, signature and docstring of one name."""
    if isinstance(thing, classmethod | staticmethod):
        thing = thing.__func__
    if isinstance(thing, property | cached_property):
        signature = ""
        docstring = getattr(thing, "fget", None) or thing.func  # type: ignore[union-attr]
    else:
        docstring = thing
        signature = (
            ""
            if inspect.isclass(thing) and "Attributes\n" in (thing.__doc__ or "")
            else _signature(called, thing)
        )
    return f"\n{level} {called}\n\n{signature}{_body(inspect.getdoc(docstring) or '', page)}\n"


def _signature(called: str, thing: Any) -> str:
    signature = inspect.signature(thing)
    own = [
        each.replace(annotation=each.empty)
        for name, each in signature.parameters.items()
        if name not in ("self", "cls")
    ]
    told = str(signature.replace(parameters=own, return_annotation=signature.empty)).replace("'", '"')
    told = re.sub(r"<function (\w+) at \w+>", r"\1", told)
    name = called if called.startswith("fl.") or "." in called else f"fl.{called}"
    if len(name + told) > WIDTH:  # as ruff breaks lines
        inside = told[1:-1]
        lines = (
            [inside]
            if len(inside) + 4 <= WIDTH
            else [f"{each}," for each in re.split(r", (?=[\w*])", inside)]
        )
        told = "(\n" + "".join(f"    {line}\n" for line in lines) + ")"
    return f"```python\n{name}{told}\n```\n\n"


def _body(docstring: str, page: Path) -> str:
    """Docstring in numpydoc form as Markdown."""
    first, *others = re.split(r"^(\S.*)\n-{3,}\n", docstring, flags=re.MULTILINE)
    parts = [_prose(first)]
    for name, text in zip(others[::2], others[1::2], strict=True):
        told = (
            _list(name, text, page)
            if name in LISTS
            else _examples(text)
            if name == "Examples"
            else _prose(text)
        )
        parts.append(f"**{name}**\n\n{told}")
    return "\n\n".join(part.strip() for part in parts if part.strip()) + "\n"


def _list(section: str, text: str, page: Path) -> str:
    """Names with their kinds and meanings, one a line; what is returned has a kind alone."""
    lines = []
    for head, meaning in re.findall(
        r"^(\S.*)\n((?:(?: +\S.*)?(?:\n|\Z))*)", f"{text.rstrip()}\n", re.MULTILINE
    ):
        name, _, kind = head.partition(" : ")
        shown = _linked(name, page) if section == "Returns" and not kind else f"`{name}`"
        shown += f" ({_linked(kind, page)})" if kind else ""
        lines.append(f"- {shown}: {_line(' '.join(meaning.split()))}")
    return "\n".join(lines)


def _examples(text: str) -> str:
    return f"```python\n{text.strip()}\n```"


def _prose(text: str) -> str:
    return "\n".join(_line(line) for line in text.splitlines())


def _line(text: str) -> str:
    """Words of a docstring as Markdown: what is code in it stays, what Markdown would take for its own is escaped."""
    parts = re.split(r"(``.*?``)", text)
    return "".join(
        f"`{part[2:-2]}`"
        if part.startswith("``") and len(part) > 4
        else re.sub(r"([*<\\`])|\](?=\()", r"\\\g<0>", part)
        for part in parts
    )


def _linked(kind: str, page: Path) -> str:
    """Kinds of a parameter, each that has an entry a link to it."""

    def link(found: re.Match[str]) -> str:
        name = found[0]
        there = _homes().get(name)
        if there is None:
            return name
        return f"[{name}]({'' if there == page.name else there}#{name.lower()})"

    return re.sub(r"\b[A-Z]\w+\b(?![\"'.])", link, _line(kind))


_found: dict[str, str] = {}


def _homes() -> dict[str, str]:
    """Page of the entry of each class, by its name."""
    if not _found:
        for page in sorted(DOCS.glob("*.md")):
            for entry in re.findall(r"^<!-- (frictionlab\.[\w.]+)", page.read_text(), re.MULTILINE):
                if inspect.isclass(thing := resolve_name(entry)):
                    _found[thing.__name__] = page.name
    return _found


def notebook(page: Path, heading: str) -> str:
    """Part of a page as a notebook: its sentences and its programs, cell by cell."""
    part = page.read_text().partition(f"## {heading}\n")[2].partition("\n## ")[0]
    parts = re.split(r"^(?:<!-- .* -->\n)?```python\n(.*?)^```\n", part, flags=re.MULTILINE | re.DOTALL)
    texts = [f"# {heading}\n\n{parts[0].strip()}", *(each.strip() for each in parts[1:])]
    cells = [
        {"cell_type": "code" if place % 2 else "markdown", "id": f"cell-{place}", "metadata": {}}
        | ({"execution_count": None, "outputs": []} if place % 2 else {})
        | {"source": text.splitlines(keepends=True)}
        for place, text in enumerate(texts)
    ]
    python = {"display_name": "Python 3", "language": "python", "name": "python3"}
    book = {"cells": cells, "metadata": {"kernelspec": python}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(book, indent=1, ensure_ascii=False) + "\n"


def pages() -> dict[Path, str]:
    """Every page of this folder and of the gallery, and the notebook, with the text that it should have."""
    spec = importlib.util.spec_from_file_location("gallery", DOCS / "gallery" / "make.py")
    assert spec is not None
    assert spec.loader is not None
    gallery = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(gallery)
    shown = gallery.exhibits()
    texts = {page: written(page) for page in sorted([*DOCS.glob("*.md"), *DOCS.glob("theory/*.md")])}
    texts[DOCS / "start.ipynb"] = notebook(DOCS / "start.md", "From Python")
    texts |= {DOCS / "gallery" / f"{each.name}.md": each.page() for each in shown}
    return texts | {DOCS / "gallery" / "index.md": gallery.index(shown)}


if __name__ == "__main__":
    for page, text in pages().items():
        page.write_text(text)
