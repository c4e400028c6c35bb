"""``fit``: the numbers of laws and of a scene, from measurements."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from frictionlab.cli import options
from frictionlab.cli.output import (
    FAILED,
    INTERRUPTED,
    OK,
    WRONG,
    CommandError,
    metered,
    print_records,
    print_result,
)

if TYPE_CHECKING:
    from frictionlab.analysis.fit.result import FittedLaws
    from frictionlab.study.law_files import Plugins


@click.command("fit")
@click.argument("study", type=options.PATH)
@options.folder("fits/<study name>")
@options.overrides
@options.law_files
@options.no_plugins
@options.workers
@options.as_json
@click.option("--force", is_flag=True, help="Replace the fit of another study in DIR.")
def fit_command(
    study: Path,
    out: Path | None,
    overrides: tuple[str, ...],
    law_files: tuple[Path, ...],
    plugins: Plugins,
    workers: int | None,
    as_json: bool,
    force: bool,
) -> int:
    """Fit the laws of STUDY to the measurements that its data name, by the numbers that its free names.

    fit.csv has each number with its errors and its interval of 95 %, fit_laws.csv how well each law fits and
    foretells blocks left out, residuals.csv what is left. A figure and a page stand beside. An interrupt keeps the
    laws that are fitted. study.yaml is the study as it was read.
    """
    from frictionlab.analysis.fit.api import fit_measured, measured_of
    from frictionlab.analysis.fit.measured import WrongData
    from frictionlab.analysis.fit.residuals import STARTS
    from frictionlab.runner.files import write_whole
    from frictionlab.runner.table import records
    from frictionlab.study.load import load_study

    asked = load_study(study, overrides, law_files, plugins)
    for key, example in (("data", "data: {file: measured.csv}"), ("free", "free: {mu: [0.1, 1.0]}")):
        if not getattr(asked, key):
            raise CommandError(WRONG, f"{study}: a study to fit has data and free; write {example}")
    folder = out or Path("fits") / study.stem
    kept, text = folder / "study.yaml", asked.to_yaml()
    if not force and kept.is_file() and kept.read_text("utf-8", "replace") != text:
        raise CommandError(WRONG, f"{folder} has a fit of another study: --force replaces it, or give -o DIR")
    try:
        measured = measured_of(asked)
        options.make_folder(folder)
        laws = [choice.law_class(**choice.parameters, label=choice.label) for choice in asked.laws]
        with metered() as meter:
            meter.begins("fitting")
            ways = (STARTS, meter.begins, workers or os.cpu_count() or 1)
            found = fit_measured(measured, laws, asked.scene, asked.free or {}, *ways)
            found = found.complete(meter.begins)
        write_whole(kept, text.encode())
    except (WrongData, ValueError) as problem:
        raise CommandError(WRONG, str(problem)) from None
    _write(found, asked.title or study.stem, folder)
    if as_json:
        print_records(records(found.table))
    else:
        print_result("\n".join([*found.sentences, f"tables, figure and page in {folder}"]))
    return INTERRUPTED if found.is_interrupted else FAILED if found.failed else OK


def _write(found: FittedLaws, title: str, folder: Path) -> None:
    """Tables, figure and page. Raises SaveError."""
    from frictionlab.runner.files import SaveError, write_whole

    for name, table in (("fit", found.table), ("fit_laws", found.laws), ("residuals", found.residuals)):
        write_whole(folder / f"{name}.csv", table.to_csv(None, index=False, lineterminator="\n").encode())
    try:
        found.report(folder / "report.html", title)
    except OSError as problem:
        raise SaveError(f"cannot write the figure in {folder}: {problem.strerror or problem}") from problem
