"""``needs``: what every curve of a study needs, and its smallest model within a tolerance."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from frictionlab.cli import options
from frictionlab.cli.output import FAILED, OK, print_message, print_records, print_result

if TYPE_CHECKING:
    from pandas import DataFrame

    from frictionlab.analysis.needs.needs import Needs
    from frictionlab.study.law_files import Plugins


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

    from frictionlab.analysis.needs.needs import needs_of_study
    from frictionlab.runner.table import records
    from frictionlab.study.load import load_study

    asked = load_study(study, overrides, law_files, plugins)
    if out is not None:
        options.make_folder(out)
    found = list(needs_of_study(asked, within))
    if not as_json:
        print_result("\n".join(_lines(found)))
    if out is not None:
        _write(pd.concat([each.table for each in found], ignore_index=True), asked.title or study.stem, out)
    if as_json:
        print_records([record for each in found for record in records(each.table)])
    return FAILED if any(each.failed for each in found) else OK


def _lines(found: Sequence[Needs]) -> list[str]:
    """Return what holds for every curve, but for its numbers, then what is left of each below what tells it apart."""
    from frictionlab.runner.summary import alike

    if len(found) == 1:
        return found[0].sentences
    said = [{_form(line): line for line in each.sentences} for each in found]
    shared = [form for form in said[0] if all(form in each for each in said)]
    lines = (
        ["every curve:", *(f"  {alike(each[form] for each in said)}" for form in shared)] if shared else []
    )
    for each, own in zip(found, said, strict=True):
        rest = [f"  {line}" for form, line in own.items() if form not in shared]
        lines += [f"{each.label}:", *rest] if rest else []
    return lines


def _form(line: str) -> tuple[str, str]:
    """A sentence with what it is about, and the rest of it without its numbers."""
    from frictionlab.runner.summary import pattern

    what, _, rest = line.partition(":")
    return what, pattern(rest)


def _write(table: DataFrame, title: str, out: Path) -> None:
    """Write the table and its figure into a folder. Raises SaveError."""
    from frictionlab.charts.needs import draw_needs  # with matplotlib, which takes a second
    from frictionlab.runner.files import SaveError, write_whole

    write_whole(out / "needs.csv", table.to_csv(None, index=False, lineterminator="\n").encode())
    try:
        draw_needs(table, title, out / "figures")
    except OSError as problem:
        raise SaveError(f"cannot write the figure in {out}: {problem.strerror or problem}") from problem
    print_message(f"table and figure in {out}")
