"""``needs``: what every curve of a study needs, and its smallest model within a tolerance."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from frictionlab.cli import options
from frictionlab.cli.output import FAILED, OK, print_message, print_records, print_result

if TYPE_CHECKING:
    from pandas import DataFrame

    from frictionlab.least_model.result import Needs
    from frictionlab.study import Plugins


@click.command("needs")
@click.argument("study", type=options.PATH)
@options.folder("nothing is written")
@click.option(
    "--within",
    type=click.FloatRange(min=0.0, min_open=True),
    metavar="X",
    help="The tolerance on the mean friction coefficient; 1 % of friction in quick sliding if left out.",
)
@options.overrides
@options.law_files
@options.no_plugins
@options.as_json
def needs_command(
    study: Path,
    out: Path | None,
    within: float | None,
    overrides: tuple[str, ...],
    law_files: tuple[Path, ...],
    plugins: Plugins,
    as_json: bool,
) -> int:
    """Tell what every curve of STUDY needs: each part of it is taken away, the smaller model solved, and compared.

    Parts are the compliance of the contact, the fall of friction with speed, the motion and the load across the
    belt, waveforms, the change of the normal load, friction's effect on the motion and its higher harmonics. Those
    that may go are taken away together, and the smallest model within the tolerance is named. The methods of the
    study do not matter. The plugins that STUDY lists are Python code, which is run, unless --no-plugins is given.
    """
    import pandas as pd

    from frictionlab.least_model.needs import needs_of_study
    from frictionlab.results.table import records
    from frictionlab.study import load_study

    asked = load_study(study, overrides, law_files, plugins)
    if out is not None:
        _make(out)
    found = []
    for each in needs_of_study(asked, within):
        found.append(each)
        if not as_json:
            print_result("\n".join(_lines(each)))
    if out is not None:
        _write(pd.concat([each.table for each in found], ignore_index=True), asked.title or study.stem, out)
    if as_json:
        print_records([record for each in found for record in records(each.table)])
    return FAILED if any(each.failed for each in found) else OK


def _lines(found: Needs) -> list[str]:
    """The sentences of a curve, below what tells it from the others."""
    head = [f"{found.label}:"] if found.label else []
    return [*head, *(f"{'  ' if head else ''}{line}" for line in found.sentences)]


def _make(out: Path) -> None:
    """Make the folder, before anything is computed. Raises FolderError."""
    from frictionlab.runner.errors import FolderError

    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise FolderError(
            f"cannot make the folder {out}: {problem.strerror}; give another one with -o"
        ) from problem


def _write(table: DataFrame, title: str, out: Path) -> None:
    """The table and its figure into a folder. Raises SaveError."""
    from frictionlab.charts.needs import draw_needs  # with matplotlib, which takes a second
    from frictionlab.runner.errors import SaveError
    from frictionlab.runner.files import write_whole

    write_whole(out / "needs.csv", table.to_csv(None, index=False, lineterminator="\n").encode())
    try:
        draw_needs(table, title, out / "figures")
    except OSError as problem:
        raise SaveError(f"cannot write the figure in {out}: {problem.strerror or problem}") from problem
    print_message(f"table and figure in {out}")
