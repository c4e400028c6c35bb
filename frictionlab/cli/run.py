"""``run``: a study, or a folder of them, to its table, figures and report."""

from __future__ import annotations

import os
import signal
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import click

from frictionlab.cli import options
from frictionlab.cli.check import at_measured
from frictionlab.cli.output import (
    BROKEN_PLUGIN,
    FAILED,
    INTERRUPTED,
    OK,
    CommandError,
    metered,
    print_message,
    print_records,
    print_result,
)
from frictionlab.cli.report import draw_into
from frictionlab.values.columns import ONSETS_GROUP

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from frictionlab.charts.figures import FigureData
    from frictionlab.runner.batch import Job
    from frictionlab.runner.progress import Meter
    from frictionlab.runner.results import Results
    from frictionlab.runner.workforce import Workforce
    from frictionlab.study.law_files import Plugins


def _one_of_so_many(
    context: click.Context, option: click.Parameter, given: str | None
) -> tuple[int, int] | None:
    """I and N of I/N. Raises BadParameter."""
    if given is None:
        return None
    first, _, count = given.partition("/")
    if first.isdecimal() and count.isdecimal() and 1 <= int(first) <= int(count):
        return int(first), int(count)
    raise click.BadParameter(f"must be I/N with 1 <= I <= N, such as 3/16, got '{given}'")


class RunOptions(NamedTuple):
    """Options of ``run``."""

    study: Path
    out: Path | None
    overrides: tuple[str, ...]
    columns: str | None
    law_files: tuple[Path, ...]
    plugins: Plugins
    workers: int | None
    processes: int | None
    scheduler: str | None
    part: tuple[int, int] | None
    cache: Path | None
    cache_size: float
    csv: bool
    figures: bool
    as_json: bool
    cite: bool
    force: bool

    def check(self) -> None:
        """Raises UsageError for options that contradict each other."""
        forces = {"-j": self.workers, "--processes": self.processes, "--scheduler": self.scheduler}
        given = [name for name, value in forces.items() if value is not None]
        if len(given) > 1:
            raise click.UsageError(f"{' and '.join(given)} say who solves the points; give one of them")
        for first, second in (("--json", "--cite"), ("--part", "--json"), ("--part", "--cite")):
            chosen = {"--json": self.as_json, "--cite": self.cite, "--part": self.part is not None}
            if chosen[first] and chosen[second]:
                raise click.UsageError(f"{first} and {second} print different things; give one of them")

    @property
    def changes(self) -> tuple[str, ...]:
        """Return the overrides, with the columns as one of them."""
        return self.overrides if self.columns is None else (*self.overrides, f"columns=[{self.columns}]")

    @property
    def existing(self) -> Literal["reuse", "replace"]:
        """Return what becomes of results already in the folder."""
        return "replace" if self.force else "reuse"


@click.command("run")
@click.argument("study", type=options.PATH)
@options.folder("runs/<study name>")
@options.overrides
@options.law_files
@options.no_plugins
@click.option(
    "--columns",
    metavar="A,B",
    help="The result columns to find, and groups of them, as `frictionlab columns` tells them; all for every one.",
)
@options.workers
@click.option("--processes", type=click.IntRange(min=1), metavar="N", help="Processes instead of threads.")
@click.option(
    "--scheduler",
    metavar="tcp://HOST:PORT",
    help="Send pieces to the workers of this dask scheduler (needs frictionlab[cluster]).",
)
@click.option(
    "--part",
    callback=_one_of_so_many,
    metavar="I/N",
    help="Solve the I-th of N shares of the pieces, for job arrays; without it the same command gathers them.",
)
@click.option(
    "--cache",
    type=options.PATH,
    metavar="DIR",
    help="Where solved pieces are kept, and found by other runs; .cache beside the results if left out.",
)
@click.option(
    "--cache-size",
    type=click.FloatRange(min=0.0),
    default=4.0,
    show_default=True,
    metavar="GB",
    help="Above it the pieces used longest ago are removed.",
)
@click.option("--csv", is_flag=True, help="Write results.csv of more than 1e5 points, too.")
@click.option("--figures", is_flag=True, help="Draw every one of more than 1e5 points.")
@options.as_json
@click.option("--cite", is_flag=True, help="Print the publications to cite, as BibTeX, instead of text.")
@click.option("--force", is_flag=True, help="Replace the results of another study or version in DIR.")
def run_command(**given: Any) -> int:
    """Run STUDY, a file or a folder of studies, and write its table, figures and report to DIR.

    The same study into the same DIR takes over the points that are finished. The plugins that STUDY lists are
    Python code, which is run, unless --no-plugins is given.
    """
    # This process is the command's own: pages that arrow frees go back at once, a quarter of a long run's memory.
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
    from frictionlab.runner import batch  # with pandas
    from frictionlab.runner.files import alone_in

    asked = RunOptions(**given)
    asked.check()
    jobs = at_measured(batch.jobs(asked.study, asked.out, asked.changes, asked.law_files, asked.plugins))
    if asked.cache is not None and asked.cache.exists() and not asked.cache.is_dir():
        raise click.UsageError(f"--cache: {asked.cache} is a file, not a folder")
    batch.check_folders(jobs, asked.existing, alone=asked.part is None)
    index = batch.index_folder(asked.study, asked.out)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if asked.part is not None:
        for job in jobs:
            _run_part(job, asked, asked.part)
        return OK
    done = []
    for number, job in enumerate(jobs, 1):
        whose = f"study {number} of {len(jobs)}: " if len(jobs) > 1 else ""
        with alone_in(job.out), metered(whose) as meter:
            done.append(_run(job, asked, meter))
    if index is not None:
        _write_index(index, done)
    if asked.as_json:
        print_records(
            [record for job, result in zip(jobs, done, strict=True) for record in _rows(job, result, asked)]
        )
    if asked.cite:
        _cite(done)
    return max(_exit_code(result) for result in done)


def _run(job: Job, asked: RunOptions, meter: Meter) -> Results:
    """Run one study, print its summary, then draw it: the summary does not wait for the figures."""
    from frictionlab.runner import api, study_run
    from frictionlab.runner.folder import run_folder
    from frictionlab.runner.store import store_of

    for line in [] if asked.force else run_folder(job.study, job.out).damaged():
        print_message(line)
    store = store_of(job.out, asked.cache, asked.cache_size)
    try:
        meter.begins("starting")
        with _force(asked) as force:
            meter.begins("solving", "points")
            ways = study_run.RunWays(asked.changes, asked.existing, force, meter, asked.csv)
            result = api.solve_study(job.study, job.out, store, ways)
    except study_run.Interrupted as problem:
        raise CommandError(INTERRUPTED, _how_far(problem.run)) from problem
    except study_run.UnsavedError as problem:
        print_records(_rows(job, problem.run, asked)) if asked.as_json else _show(problem.run)
        raise
    _show_failed(result) if asked.as_json or asked.cite else _show(result)
    try:
        return _shown(job, result, asked, meter)
    except KeyboardInterrupt:
        left = f"the table in {job.out} is whole; the same command makes figures and report"
        raise CommandError(INTERRUPTED, f"interrupted: {left}") from None


def _shown(job: Job, result: Results, asked: RunOptions, meter: Meter) -> Results:
    """Draw the run and write its report and its onsets where asked for; nothing is made again that is there."""
    from frictionlab.runner import api, pages

    if job.study.asks_for(ONSETS_GROUP) and not result.curves.empty:
        meter.begins("finding onsets")
        api.write_derived(result, "onsets")
    if job.study.boundaries:
        meter.begins("finding boundaries")
        api.write_derived(result, "boundaries")
    if pages.pages_are_there(result, asked.figures):
        for what, there in {"figures": job.out / "figures", "report": job.out / "report.html"}.items():
            if there.exists():
                print_message(f"{what} in {there}")
        return result
    meter.begins("drawing", "figures")
    drawn = _draw(result, asked.figures, meter) if result.study.sweep else None
    meter.begins("writing the report")
    _report(result, drawn)
    pages.know_pages(result, asked.figures)
    return result


def _force(asked: RunOptions) -> AbstractContextManager[Workforce]:
    """Give those who solve the pieces."""
    from frictionlab.runner import workforce

    if asked.scheduler is not None:
        return workforce.cluster(asked.scheduler)
    if asked.processes is not None:
        return workforce.processes(asked.processes)
    return workforce.threads(asked.workers or os.cpu_count() or 1)


def _run_part(job: Job, asked: RunOptions, part: tuple[int, int]) -> None:
    """Solve a share of the pieces of a study and keep them; the table is for the run that gathers them."""
    from frictionlab.runner.solving import run_share
    from frictionlab.runner.store import store_of

    store = store_of(job.out, asked.cache, asked.cache_size, must_keep=True)
    with metered() as meter, _force(asked) as force:
        done, points = run_share(job.study, part, store, force, meter)
    print_result(
        f"{job.name}, part {part[0]} of {part[1]}: {done.computed} points solved and {done.found} found of "
        f"{points}, kept in {store.folder}"
    )


def _how_far(result: Results) -> str:
    done = result.size - result.counts.get("killed", 0)
    kept = f" and kept in {result.folder}" if result.folder and done else ""
    told = f"interrupted: {done} of {result.size} points are done{kept}; the same command continues"
    return f"{told}, and begins those under way again"


def _show(result: Results) -> None:
    from frictionlab.runner.summary import summary

    print_result(summary(result))


def _show_failed(result: Results) -> None:
    """Print the expectations that failed, on stderr: stdout belongs to the records."""
    from frictionlab.runner.summary import failed_lines

    for line in failed_lines(result.verdicts):
        print_message(line)


def _draw(done: Results, every: bool, meter: Meter) -> FigureData:
    """Draw the figures of a run, every point of it if asked; return what they are drawn of but for that."""
    from frictionlab.report.run import figure_data
    from frictionlab.runner.table import whole

    assert done.folder is not None
    data = figure_data(done)
    if draw_into(done.folder, replace(data, table=whole(done.table)) if every else data, meter):
        print_message(f"figures in {done.folder / 'figures'}")
    return data


def _report(done: Results, drawn: FigureData | None) -> None:
    from frictionlab.report.page import write_report

    print_message(f"report in {write_report(done, drawn)}")


def _write_index(folder: Path, done: Sequence[Results]) -> None:
    from frictionlab.report.page import write_index

    print_message(f"index in {write_index(folder, done)}")


def _cite(done: Sequence[Results]) -> None:
    from frictionlab.report.sources import bibtex

    print_result(bibtex(done))


def _rows(job: Job, result: Results, asked: RunOptions) -> list[dict[str, Any]]:
    """Return the records of a run; of a folder of studies, each names its study."""
    from frictionlab.runner.table import records

    whose = {"study": job.name} if asked.study.is_dir() else {}
    return [whose | record for record in records(result.table)]


def _exit_code(result: Results) -> int:
    from frictionlab.laws.faults import MARK

    if result.shown["reason"].astype("str").str.startswith(MARK).any():
        return BROKEN_PLUGIN
    bad = sum(result.counts.get(status, 0) for status in ("failed", "killed"))
    if bad and any(each.status == "failed" for each in result.study.expect):
        from frictionlab.runner.expectations import expected_failures

        bad -= expected_failures(result.study.expect, result.table)
    return FAILED if bad or not all(verdict.passed for verdict in result.verdicts) else OK
