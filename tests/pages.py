"""Reading a page as a browser and a screen reader do: its elements, their text, and what is wrong with it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from html.parser import HTMLParser
from itertools import pairwise

VOID = {"meta", "img", "br", "link", "hr", "input"}
WITH_ADDRESS = {"src", "href", "srcset", "data", "action", "poster", "background", "formaction"}
RUNNING = {"script", "iframe", "object", "embed", "link", "base", "form"}


@dataclass
class Element:
    """One element of a page; text: its own and that of all inside it."""

    tag: str
    attributes: dict[str, str]
    text: str = ""
    inside: list[Element] = field(default_factory=list)


class Page(HTMLParser):
    """A page taken apart. wrong: every tag that does not close what was opened last."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[Element] = []
        self.wrong: list[str] = []
        self._open: list[Element] = []
        self.feed(text)
        self.close()
        self.wrong += [f"<{element.tag}> stays open" for element in self._open]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        element = Element(tag, {name: value or "" for name, value in attrs})
        self.elements.append(element)
        for around in self._open[-1:]:
            around.inside.append(element)
        if tag not in VOID:
            self._open.append(element)

    def handle_endtag(self, tag: str) -> None:
        if not self._open or self._open[-1].tag != tag:
            self.wrong.append(f"</{tag}> closes nothing")
        else:
            self._open.pop()

    def handle_data(self, data: str) -> None:
        for element in self._open:
            element.text += data

    def all(self, tag: str) -> list[Element]:
        """Every element of this kind."""
        return [element for element in self.elements if element.tag == tag]

    @property
    def title(self) -> str:
        """The first heading."""
        return self.all("h1")[0].text

    def table(self, caption: str) -> list[list[str]]:
        """The rows of the table whose caption begins so, heads first."""
        (table,) = [each for each in self.all("table") if each.inside[0].text.startswith(caption)]
        rows = [row for part in table.inside for row in part.inside if row.tag == "tr"]
        return [[" ".join(cell.text.split()) for cell in row.inside] for row in rows]


def complaints(text: str) -> list[str]:
    """What is wrong with a page as HTML, as a page that needs nothing else, and for who cannot see it."""
    page = Page(text)
    return page.wrong + _not_html(page) + _not_alone(page, text) + _not_accessible(page)


def _not_html(page: Page) -> list[str]:
    names = [element.attributes["id"] for element in page.elements if "id" in element.attributes]
    pointed = [element.attributes.get("href", "") for element in page.all("a")]
    lost = [target for target in pointed if target.startswith("#") and target[1:] not in names]
    twice = {name for name in names if names.count(name) > 1}
    return [f"link to nowhere: {target}" for target in lost] + [f"id twice: {name}" for name in twice]


def _not_alone(page: Page, text: str) -> list[str]:
    """What would run, or be fetched from elsewhere."""
    found = [f"<{element.tag}>" for element in page.elements if element.tag in RUNNING]
    for element in page.elements:
        for name, value in element.attributes.items():
            own = value.startswith(("data:image/", "#")) or re.fullmatch(r"[^:/]+/report\.html", value)
            if name.startswith("on") or (name in WITH_ADDRESS and not own):
                found.append(f"<{element.tag} {name}={value[:40]}>")
    style = "".join(element.text for element in page.all("style")) + "".join(
        element.attributes.get("style", "") for element in page.elements
    )
    return found + re.findall(r"url\(|@import|https?:", style)


def _not_accessible(page: Page) -> list[str]:
    levels = [int(element.tag[1]) for element in page.elements if re.fullmatch("h[1-6]", element.tag)]
    jumps = [after for before, after in pairwise(levels) if after > before + 1]
    return [
        *(["no language"] if not page.all("html")[0].attributes.get("lang") else []),
        *(["headings do not start with one h1"] if levels[:1] != [1] or levels.count(1) != 1 else []),
        *[f"heading of level {level} after a gap" for level in jumps],
        *[
            "picture without words"
            for image in page.all("img")
            if not image.attributes.get("alt", "").strip()
        ],
        *["table head without scope" for head in page.all("th") if "scope" not in head.attributes],
        *["table without caption" for table in page.all("table") if table.inside[0].tag != "caption"],
        *["figure without caption" for each in page.all("figure") if each.inside[-1].tag != "figcaption"],
    ]
