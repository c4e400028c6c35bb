"""Publications that laws, methods and studies cite: BibTeX entries, and those that a text names.

A text names a publication by its authors and year, as in "Dahl (1968)", "Bo & Pavelescu (1982)" or, of three and more
authors, "Dupont et al. (2002)".
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

_HOMES = ("journal", "booktitle", "publisher", "institution", "howpublished", "note")


@dataclass(frozen=True)
class Publication:
    """An entry: its kind, such as article, its key and fields, and its BibTeX as written."""

    kind: str
    key: str
    fields: Mapping[str, str] = field(compare=False)
    bibtex: str

    @property
    def names(self) -> tuple[str, ...]:
        """Return the citations by which a text may name it; none without authors."""
        given = self.fields.get("author", "")
        if not given:
            return ()
        families = [_family(author) for author in re.split(r"\s+and\s+", given)]
        whole = " & ".join([", ".join(families[:-1]), families[-1]] if families[1:] else families)
        year = f" ({self.fields['year']})" if "year" in self.fields else ""
        return (whole + year, f"{families[0]} et al.{year}") if families[2:] else (whole + year,)

    @property
    def text(self) -> str:
        """Authors (year), title, journal."""
        said = [*self.names[:1], self.fields.get("title", ""), self._home]
        doi = [f"doi:{self.fields['doi']}"] if "doi" in self.fields else []
        return ". ".join([*(_plain(each) for each in said if each), *doi])

    @property
    def _home(self) -> str:
        """Journal volume, pages, as far as known."""
        home = next((self.fields[name] for name in _HOMES if name in self.fields), "")
        number = self.fields.get("volume", self.fields.get("number", ""))
        volume = f"{home} {number}".strip()
        return ", ".join(part for part in (volume, self.fields.get("pages", "")) if part)


def _family(author: str) -> str:
    """Return the family name, of ``Family, Given``, of ``Given Family`` or of a name in braces."""
    if "," in author or author.startswith("{"):
        return _plain(author).partition(",")[0]
    return author.split()[-1]


def _plain(text: str) -> str:
    return re.sub(r"[{}]", "", text).replace("--", "-")


@cache
def bibliography() -> tuple[Publication, ...]:
    """Return the publications cited by the laws and methods of frictionlab."""
    return read_bibtex(files("frictionlab.study").joinpath("bibliography.bib").read_text(encoding="utf-8"))


def publications(text: str, bibtex: str) -> list[Publication]:
    """Publications that a text names, and its own entries, which replace those of frictionlab's bibliography."""
    brought = read_bibtex(bibtex)
    taken = {name for each in brought for name in each.names}
    known = [*brought, *(each for each in bibliography() if taken.isdisjoint(each.names))]
    named = publications_named(text, known)
    return [*named, *(each for each in brought if each not in named)]


def unpublished_source(key: str, words: str) -> Publication:
    """An entry for a source that is given as text only."""
    said = " ".join(re.sub(r"[\\{}]", "", words.replace("@", " at ")).split())
    note = re.sub(r"([&%$#_])", r"\\\1", said).replace("~", r"\~{}").replace("^", r"\^{}")
    name = "-".join(re.findall(r"\w+", key))
    fields = {"title": key, "note": note}
    lines = "".join(f"  {field} = {{{value}}},\n" for field, value in fields.items())
    return Publication("misc", name, fields, f"@misc{{{name},\n{lines}}}")


def publications_named(text: str, known: Iterable[Publication]) -> list[Publication]:
    """Return the known publications that a text names, in the order of the text."""
    words = " ".join(text.split())
    places = {each: _place(each, words) for each in known}
    return sorted((each for each, place in places.items() if place >= 0), key=lambda each: places[each])


def _place(reference: Publication, words: str) -> int:
    found = [re.search(rf"(?<!\w){re.escape(name)}(?!\w)", words) for name in reference.names]
    return min((match.start() for match in found if match), default=-1)


_BRACED = r"\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\}"
_VALUE = rf'{_BRACED}|"(?:[^"{{}}]|{_BRACED})*"|\w+'
_FIELD = re.compile(rf"(\w+)\s*=\s*({_VALUE})")
_ENTRY = re.compile(rf"@(\w+)\s*\{{\s*([^\s,{{}}]+)\s*(?:,\s*(?:\w+\s*=\s*(?:{_VALUE})\s*)?)*\}}")
"""Values in braces, three deep, in quotes or bare; an entry of them."""


def read_bibtex(bibtex: str) -> tuple[Publication, ...]:
    """Return the entries of BibTeX text; text between them is comment. Raises ValueError for a broken entry."""
    if not isinstance(bibtex, str):
        raise ValueError(f"must be one text of BibTeX entries, not a {type(bibtex).__name__}")
    if "@" in (left := _ENTRY.sub("", bibtex)):
        start = " ".join(left[left.index("@") :].split())[:40]
        raise ValueError(f"no BibTeX entry such as @article{{key, title = {{...}}}}: {start}")
    return tuple(
        Publication(entry[1].lower(), entry[2], _fields(entry[0]), entry[0])
        for entry in _ENTRY.finditer(bibtex)
    )


def _fields(entry: str) -> dict[str, str]:
    found = _FIELD.findall(entry)
    return {
        name.lower(): " ".join((value if value[0].isalnum() else value[1:-1]).split())
        for name, value in found
    }
