"""What every curve of the paper's figures needs, asked of the package: python tests/needs_table.py.

Writes the table of docs/needs.md between its marks, and docs/figures/needs.svg.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import pandas as pd

from frictionlab.charts.needs import PLUS, draw_needs
from frictionlab.least_model.needs import needs_of_study
from frictionlab.least_model.result import Needs
from frictionlab.study import load_study

PROJECT = Path(__file__).parents[1]
PAGE = PROJECT / "docs" / "needs.md"
PICTURE = PROJECT / "docs" / "figures" / "needs.svg"
DRAWN = "fig8a_transverse_resonance"
BEGIN, END = "<!-- made by tests/needs_table.py -->\n", "<!-- end -->\n"
DOUBLE = "load across the belt"
"""Nothing else shakes these bodies across: without it the transverse motion goes."""
HEAD = "| study | curve | needed | not needed | smallest model: without | its change |\n|---|---|---|---|---|---|\n"


def written() -> str:
    """The page with the table as it is now."""
    page = PAGE.read_text(encoding="utf-8")
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    found = {path.stem: list(needs_of_study(load_study(path))) for path in paper()}
    rows = "".join(row(name, each) for name, every in found.items() for each in every)
    return f"{before}{BEGIN}{HEAD}{rows}{END}{after}"


def paper() -> list[Path]:
    """The studies of the paper's figures."""
    return sorted((PROJECT / "studies").glob("fig*.yaml"))


def row(name: str, found: Needs) -> str:
    """One curve."""
    table = found.table
    alone = table[~table["without"].str.contains(PLUS, regex=False) & (table["without"] != DOUBLE)]
    told = [
        "; ".join(
            f"{each.without} {told_size(each)}" for each in alone.itertuples() if each.verdict == verdict
        )
        for verdict in ("needed", "not needed")
    ]
    least = table[table["smallest"]]
    without = least["without"].iloc[0].replace(PLUS, ", ") if len(least) else "nothing"
    change = told_size(next(least.itertuples())) if len(least) else "0"
    cells = [name.partition("_")[0], found.label or "-", *(each or "-" for each in told), without, change]
    return f"| {' | '.join(cells)} |\n"


def told_size(each: object) -> str:
    """The size of a change; where its error is larger, at most that."""
    size, error = abs(each.change), each.change_error  # type: ignore[attr-defined]
    return f"{size:.1e}" if size > error else f"< {size + error:.0e}"


def draw() -> None:
    """The picture of one study."""
    study = load_study(PROJECT / "studies" / f"{DRAWN}.yaml")
    table = pd.concat([each.table for each in needs_of_study(study)], ignore_index=True)
    with tempfile.TemporaryDirectory() as folder:
        drawn = draw_needs(table, study.title, Path(folder))[0]
        PICTURE.write_bytes(drawn.read_bytes())


if __name__ == "__main__":
    PAGE.write_text(written(), encoding="utf-8")
    draw()
