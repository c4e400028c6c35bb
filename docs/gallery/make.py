"""Run the studies of the gallery and write its pages and figures: ``python docs/gallery/make.py [STUDY ...]``.

A new study wants a page with its question, how to read it and what comes out, and a link ``[](NAME.md)`` in a group
of ``index.md``. About fifteen minutes, and more for kernels on a machine that has none. The site shows what is kept.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ruamel.yaml import YAML

from frictionlab.study.figure_options import FIGURE_NAMES
from frictionlab.study.load import load_study

GALLERY = Path(__file__).parent
STUDIES = GALLERY.parent.parent / "studies"
FOUND = {
    "paper": "The paper, claim by claim",
    "atlas": "Where friction curves are concave",
    "rivals": "Who else makes a concave curve",
    "dynamic_laws": "What dynamic laws change",
    "reviews": "Which law of friction changes the curve",
}
"""Pages beside this folder, of what many studies found together."""
ACROSS = 3
"""Pictures in a row of the first page."""
COMMAND = Path(sys.executable).parent / "frictionlab"


SAID = re.compile(
    r"# (?P<question>.+)\n[\s\S]*?\*\*How to read it\.\*\* (?P<read>.+)\n\n\*\*What comes out\.\*\* (?P<found>.+)\n"
)
"""What a page is written anew from: of a new one its first lines are enough."""


class Exhibit(NamedTuple):
    """A study in the gallery: its group, name and title, and what its page says of it."""

    group: str
    name: str
    title: str
    question: str
    read: str
    found: str

    @property
    def study(self) -> str:
        """Its file, seen from the project."""
        return study_named(self.name).relative_to(STUDIES.parent).as_posix()

    def page(self) -> str:
        """The page of the study."""
        study = f"../../{self.study}"
        return f"""# {self.question}

![{self.title}](figures/{self.name}.svg)

**How to read it.** {self.read}

**What comes out.** {self.found}

## The study

```sh
frictionlab run {self.study}
```

runs [{self.name}.yaml]({study}):

```yaml
{(STUDIES.parent / self.study).read_text()}```
"""

    @property
    def picture(self) -> str:
        """Its picture on the first page, which leads to its page."""
        return f"[![{self.title}](figures/{self.name}.svg)]({self.name}.md)"


def study_named(name: str) -> Path:
    """Its file, in whichever folder of studies it is."""
    (file,) = STUDIES.rglob(f"{name}.yaml")
    return file


def exhibits() -> list[Exhibit]:
    """Every page that the first page leads to, by group, in their order."""
    yaml = YAML(typ="safe")
    groups = re.split(r"^## (.*)\n", (GALLERY / "index.md").read_text(), flags=re.MULTILINE)[1:]
    return [
        Exhibit(group, name, yaml.load(study_named(name))["title"], **said_of(name))
        for group, inside in zip(groups[::2], groups[1::2], strict=True)
        for name in re.findall(r"\]\((\w+)\.md\)", inside)
    ]


def said_of(name: str) -> dict[str, str]:
    """The words of a page. Raises ValueError where it has no question, no way to read it or no answer."""
    if (said := SAID.match((GALLERY / f"{name}.md").read_text())) is None:
        raise ValueError(
            f"{name}.md: wants '# question', '**How to read it.** ...' and '**What comes out.** ...'"
        )
    return said.groupdict()


def drawn(exhibit: Exhibit) -> str:
    """Run the study; its most telling figure, as SVG."""
    with tempfile.TemporaryDirectory() as folder:
        finding = load_study(study_named(exhibit.name)).figures.finding
        command = [COMMAND, "run", exhibit.study, "-o", f"{folder}/run"]
        subprocess.run(command, cwd=STUDIES.parent, stdout=subprocess.DEVNULL, check=True)
        there = [name for name in FIGURE_NAMES if Path(folder, "run", "figures", f"{name}.svg").exists()]
        return Path(folder, "run", "figures", f"{finding or there[0]}.svg").read_text("utf-8")


def make(exhibit: Exhibit) -> None:
    """Write its page and its figure."""
    (GALLERY / "figures" / f"{exhibit.name}.svg").write_text(drawn(exhibit), "utf-8")
    (GALLERY / f"{exhibit.name}.md").write_text(exhibit.page())


def index(shown: list[Exhibit]) -> str:
    """The first page: the pictures of each group, then what the other studies found."""
    found = ", ".join(f"[{title}](../{page}.md)" for page, title in FOUND.items())
    groups = {exhibit.group: [each for each in shown if each.group == exhibit.group] for exhibit in shown}
    sections = [f"## {group}\n\n{pictures(inside)}" for group, inside in groups.items()]
    return f"""# Gallery

What have others computed? Each picture leads to a page with the answer and the study.
`python docs/gallery/make.py` runs them all again. What many studies found together: {found}.

{chr(10).join(sections)}
{more(shown)}"""


def pictures(shown: Sequence[Exhibit]) -> str:
    """A table of pictures, each above its question."""
    rows = [shown[at : at + ACROSS] for at in range(0, len(shown), ACROSS)]
    lines = ["|" + "   |" * ACROSS, "|" + "---|" * ACROSS]
    for row in rows:
        for cells in ([each.picture for each in row], [each.question for each in row]):
            lines.append(f"| {' | '.join([*cells, *[''] * (ACROSS - len(row))])} |")
    return "\n".join(lines) + "\n"


def table_of(folder: str, left_out: Sequence[str] = ()) -> str:
    """Of every study in a folder but those left out: a link, and its title, which is the finding."""
    studies = {path: YAML(typ="safe").load(path) for path in sorted((STUDIES / folder).glob("*.yaml"))}
    rows = [
        f"| [{path.stem.replace('_', ' ')}](../../studies/{folder}/{path.name}) | {read['title']} |"
        for path, read in studies.items()
        if path.stem not in left_out
    ]
    return "\n".join(["| study | finding |", "|---|---|", *rows])


def more(shown: list[Exhibit]) -> str:
    """The studies that have no page: others' models against their formulas, and those in SI units."""
    return f"""## Others' models against their formulas

{table_of("literature", [exhibit.name for exhibit in shown])}

## More applications in SI units

Studies as one writes them from the table of a paper, with units. Each names the paper that its model is from and
says which numbers are only typical; what it expects was found a second way too. `frictionlab run studies/si` runs
all of them.

{table_of("si")}
"""


def main(wanted: list[str]) -> None:
    """All studies, or those named."""
    shown = exhibits()
    for exhibit in shown:
        if not wanted or exhibit.name in wanted:
            make(exhibit)
    (GALLERY / "index.md").write_text(index(shown))


if __name__ == "__main__":
    main(sys.argv[1:])
