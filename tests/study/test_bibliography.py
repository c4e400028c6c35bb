"""Every law and method names its sources so that a reader can find them and a paper can cite them."""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import Any

import pytest
from profiles import deep

from frictionlab.study import registry
from frictionlab.study.bibliography import (
    bibliography,
    publications,
    publications_named,
    read_bibtex,
    unpublished_source,
)
from frictionlab.study.records import law_record

STUDIES = sorted((Path(__file__).parents[2] / "studies").rglob("*.yaml"))
SOLVERS = [name for name in registry.method_names() if name != "auto"]  # auto answers by another's work
CLASSES: list[Any] = [registry.law_class(name) for name in registry.law_names()]
CLASSES += [registry.method_class(name) for name in SOLVERS]
OURS = [kind for kind in dict.fromkeys(CLASSES) if kind.__module__.startswith("frictionlab.")]
FOLDERS = [kind for kind in dict.fromkeys(CLASSES) if kind not in OURS]
REQUIRED = {
    "article": {"author", "title", "journal", "year"},
    "book": {"author", "title", "publisher", "year"},
    "incollection": {"author", "title", "booktitle", "publisher", "year"},
    "inproceedings": {"author", "title", "booktitle", "year"},
    "misc": {"author", "title"},
    "techreport": {"author", "title", "institution", "year"},
}
"""What BibTeX asks of an entry of each kind, and authors and a title of all."""
CITED = re.compile(r"\(\d{4}\)")


@pytest.mark.parametrize("kind", [*OURS, *FOLDERS], ids=lambda kind: kind.__name__)
def test_every_law_and_method_names_publications_that_have_an_entry(kind: Any) -> None:
    assert publications(inspect.getdoc(kind) or "", kind.bibtex)


@pytest.mark.parametrize("kind", [*OURS, *FOLDERS], ids=lambda kind: kind.__name__)
def test_every_year_in_a_docstring_belongs_to_a_publication_that_has_an_entry(kind: Any) -> None:
    text = " ".join((inspect.getdoc(kind) or "").split())
    for found in publications(text, kind.bibtex):
        for name in found.names:
            text = text.replace(name, "")

    assert CITED.findall(text) == []


ENTRIES = [*bibliography(), *(entry for law in FOLDERS for entry in read_bibtex(law.bibtex))]


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.key)
def test_an_entry_has_what_its_kind_asks_for(entry: Any) -> None:
    assert set(entry.fields) >= REQUIRED[entry.kind]
    assert all(entry.fields.values())
    assert entry.bibtex.count("{") == entry.bibtex.count("}")
    assert entry.fields.get("doi", "10.1/x").startswith("10.")
    assert entry.fields.get("year", entry.key[-4:]) == entry.key[-4:]


def test_no_two_entries_share_a_key_or_a_name() -> None:
    keys = [entry.key for entry in bibliography()]
    names = [name for entry in bibliography() for name in entry.names]

    assert keys == sorted(set(keys))
    assert len(names) == len(set(names))


@deep("reads all sources")
def test_the_bibliography_holds_nothing_that_nobody_names() -> None:
    used = {each.key for kind in OURS for each in publications(inspect.getdoc(kind) or "", kind.bibtex)}
    studies = " ".join(file.read_text(encoding="utf-8") for file in STUDIES)

    assert {entry.key for entry in bibliography()} == used | {
        each.key for each in publications_named(studies, bibliography())
    }


def test_a_text_names_a_publication_by_its_authors_and_year() -> None:
    found = publications_named(
        "after Bo &\n  Pavelescu (1982), as Dupont et al. (2002) do; not Kindahl (1968)", bibliography()
    )

    assert [each.key for each in found] == ["bo1982", "dupont2002"]


def test_entries_are_read_as_people_write_them() -> None:
    braced, quoted, bare = read_bibtex(
        "Of mine:\n@Article{ruina1983, author = {Ruina, Andy}, title = {Slip {I}n}, year = 1983}\n"
        '@book{a:b, author="de la Cruz, A. and {The {B} group}", title="X" , year={2001},}\n@misc{only}'
    )

    assert (braced.kind, braced.names, braced.fields["title"]) == ("article", ("Ruina (1983)",), "Slip {I}n")
    assert quoted.names == ("de la Cruz & The B group (2001)",)
    assert (bare.key, bare.names, bare.bibtex) == ("only", (), "@misc{only}")


@pytest.mark.parametrize(
    "broken",
    [
        "@article ruina1983",
        "@article{a, title = {never closed",
        "@misc{a, title = }",
        "@misc{a, note = {x} y}",
    ],
)
def test_a_broken_entry_says_where_it_breaks(broken: str) -> None:
    with pytest.raises(ValueError, match="BibTeX"):
        read_bibtex(broken)


def test_what_a_law_brings_goes_before_our_own_of_the_same_name() -> None:
    mine = "@misc{mine, author = {Dahl, P.}, year = {1968}, title = {Mine}}\n@misc{other, title = {Unnamed}}"

    assert [each.key for each in publications("Dahl (1968)", mine)] == ["mine", "other"]


def test_words_alone_become_an_entry_that_tex_can_read() -> None:
    (entry,) = read_bibtex(unpublished_source("law my_law", r"Me & mine, 50% @home {1} \x_2").bibtex)

    assert entry.key == "law-my_law"
    assert entry.fields["note"] == r"Me \& mine, 50\% at home 1 x\_2"


def test_a_law_lists_its_publications_in_full() -> None:
    assert law_record("dahl", registry.law_class("dahl"))["sources"][1] == (
        "Dahl (1976). Solid friction damping of mechanical vibrations. AIAA Journal 14, 1675-1682. "
        "doi:10.2514/3.61511"
    )
