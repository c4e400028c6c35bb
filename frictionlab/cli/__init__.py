"""The command line. Nothing heavy is imported before a command needs it: ``--help`` answers at once."""

from __future__ import annotations

import errno
import io
import json
import os
import shlex
import signal
import sys
import threading
import traceback
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import click

if TYPE_CHECKING:
    from pandas import DataFrame

    from frictionlab.bench import Measured
    from frictionlab.registry import Laws
    from frictionlab.results.run import Run
    from frictionlab.runner.batch import Job
    from frictionlab.runner.plan import Planned


OK, BUG, WRONG, FAILED, BROKEN_PLUGIN, INTERRUPTED = 0, 1, 2, 3, 4, 130

overrides_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="PATH=VALUE",
    help="Replace a value of the study; may be repeated.",
)
law_option = click.option(
    "--law",
    "law_files",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Take the laws of a Python file, too; may be repeated.",
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print a list of records instead of text.")


class CommandError(Exception):
    """A command that ends here, with an exit code and a message."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code = code


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; its exit code. Only our own bugs show a traceback."""
    _open_streams()
    try:
        code = _quietly(arguments)
    except BaseException as problem:
        code = _explained(problem)
    code = _flushed(code)
    if code == INTERRUPTED and threading.active_count() > 1:
        os._exit(code)  # a worker deep in a kernel cannot be stopped, and would be waited for
    return code


def _open_streams() -> None:
    """Python has no stdout, or no stderr, where the caller closed it: what is said there is then for nobody."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, io.StringIO())


def _quietly(arguments: Sequence[str] | None) -> int:
    result = cli.main(None if arguments is None else list(arguments), "frictionlab", standalone_mode=False)
    return result if isinstance(result, int) else OK


def _explained(problem: BaseException) -> int:
    """Print what went wrong, and choose the exit code."""
    if isinstance(problem, click.ClickException):
        problem.show()
        return problem.exit_code
    if isinstance(problem.__context__, BrokenPipeError):
        return _deaf(OK)  # the reader of a help text had enough: click's way to say so
    if isinstance(problem, click.Abort | KeyboardInterrupt):
        _tell("interrupted")
        return INTERRUPTED
    code, message = _classified(problem)
    _tell(message)
    return code


def _classified(problem: BaseException) -> tuple[int, str]:
    from frictionlab.faults import BrokenPlugin, blamed
    from frictionlab.runner.errors import FolderError, SaveError
    from frictionlab.study import StudyError

    if isinstance(problem, CommandError):
        return problem.code, str(problem)
    if isinstance(problem, StudyError | FolderError):
        return WRONG, str(problem)
    if isinstance(problem, SaveError):
        return FAILED, str(problem)
    if isinstance(problem, BrokenPlugin):
        return BROKEN_PLUGIN, str(problem)
    if isinstance(problem, OSError) and problem.errno in (errno.ENOSPC, errno.EDQUOT):
        return FAILED, f"cannot write the output: {problem.strerror}"
    if law := blamed(problem):
        return BROKEN_PLUGIN, law
    text = "".join(traceback.format_exception(problem))
    return BUG, f"{text}\nThis is a bug of frictionlab; please report it with the lines above and the study."


def _tell(message: str) -> None:
    """A message, on stderr; a closed stderr is nobody's trouble."""
    with suppress(OSError):
        click.echo(message, err=True)


def _print(text: str) -> None:
    """A result, on stdout; a reader may have enough of it."""
    try:
        click.echo(text)
        sys.stdout.flush()
    except BrokenPipeError:
        _deaf(OK)


def _flushed(code: int) -> int:
    """Flush stdout while its errors can still be told."""
    try:
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        return _deaf(code)
    except OSError as problem:
        _tell(f"cannot write the output: {problem.strerror}")
        return _deaf(code or FAILED)


def _deaf(code: int) -> int:
    """Let nothing more be written to a stdout that takes nothing."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return code


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="frictionlab", message="%(prog)s %(version)s")
def cli() -> None:
    """Average-friction curves of vibrated sliding bodies, every point with a true error.

    Exit codes: 0 ok; 1 a bug of frictionlab; 2 wrong command or study; 3 some points failed or were killed,
    an expectation failed, or the results could not be written; 4 a plugin is broken; 130 interrupted, the
    same command continues.
    """


@cli.command()
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Where to; runs/<study name> if left out.",
)
@overrides_option
@law_option
@click.option(
    "-j", "workers", type=click.IntRange(min=1), metavar="N", help="Threads; all cores if left out."
)
@json_option
@click.option("--cite", is_flag=True, help="Print the publications to cite, as BibTeX, instead of text.")
@click.option("--force", is_flag=True, help="Replace the results of another study or version in DIR.")
def run(**options: Any) -> int:
    """Run STUDY, a file or a folder of studies, and write its table, figures and report to DIR.

    The same study into the same DIR takes over the points that are finished.
    """
    from frictionlab.runner import batch  # with pandas

    given = RunOptions(**options)
    if given.as_json and given.cite:
        raise click.UsageError("--json and --cite print different things; give one of them")
    jobs = batch.jobs(given.study, given.out, given.overrides, given.law_files)
    batch.check_folders(jobs, given.existing)
    index = batch.index_folder(given.study, given.out)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    done = [_run(job, given) for job in jobs]
    if index is not None:
        _write_index(index, done)
    if given.as_json:
        _print_records(
            [record for job, result in zip(jobs, done, strict=True) for record in _rows(job, result, given)]
        )
    if given.cite:
        _cite(done)
    return max(_code(result) for result in done)


class RunOptions(NamedTuple):
    """The options of ``run``."""

    study: Path
    out: Path | None
    overrides: tuple[str, ...]
    law_files: tuple[Path, ...]
    workers: int | None
    as_json: bool
    cite: bool
    force: bool

    @property
    def existing(self) -> Literal["reuse", "replace"]:
        """What becomes of results already in the folder."""
        return "replace" if self.force else "reuse"


def _run(job: Job, given: RunOptions) -> Run:
    """Run one study, print what it found, then draw it: figures wait for nobody's table."""
    from concurrent.futures import ThreadPoolExecutor

    from frictionlab.runner import api
    from frictionlab.runner.progress import Meter

    meter = Meter(sys.stderr)
    pool = ThreadPoolExecutor(given.workers or os.cpu_count())
    try:
        result = api.run(job.study, job.out, given.overrides, given.existing, pool, meter)
    except api.Interrupted as problem:
        raise CommandError(INTERRUPTED, _how_far(problem.run)) from problem
    except api.UnsavedError as problem:
        _print_records(_rows(job, problem.run, given)) if given.as_json else _show(problem.run)
        raise
    finally:
        meter.close()
        pool.shutdown(wait=False, cancel_futures=True)
    _show_failed(result) if given.as_json or given.cite else _show(result)
    _draw(job, result)
    _report(result)
    return result


def _how_far(result: Run) -> str:
    done = len(result.table) - result.counts.get("killed", 0)
    kept = f" and kept in {result.folder}" if result.folder and done else ""
    return f"interrupted: {done} of {len(result.table)} points are done{kept}; the same command continues"


def _show(result: Run) -> None:
    from frictionlab.results.summary import summary

    _print(summary(result))


def _show_failed(result: Run) -> None:
    """What was expected and is not so, beside the records."""
    from frictionlab.results.summary import failed_lines

    for line in failed_lines(result.verdicts):
        _tell(line)


def _draw(job: Job, result: Run) -> None:
    if _drawn(result.table, job.study.title or job.name, job.out):
        _tell(f"figures in {job.out / 'figures'}")


def _drawn(table: DataFrame, title: str, folder: Path) -> list[Path]:
    """Draw the figures of a run; the files. Raises SaveError."""
    from frictionlab.charts.figures import draw  # with matplotlib, which takes a second
    from frictionlab.runner.errors import SaveError

    try:
        return draw(table, title, folder / "figures")
    except OSError as problem:
        raise SaveError(f"cannot write the figures in {folder}: {problem.strerror or problem}") from problem


def _report(result: Run) -> None:
    from frictionlab.report import write_report
    from frictionlab.runner.saved import saved_as

    _tell(f"report in {write_report(saved_as(result))}")


def _write_index(folder: Path, done: Sequence[Run]) -> None:
    from frictionlab.report import write_index
    from frictionlab.runner.saved import saved_as

    _tell(f"index in {write_index(folder, [saved_as(result) for result in done])}")


def _cite(done: Sequence[Run]) -> None:
    from frictionlab.report import bibtex
    from frictionlab.runner.saved import saved_as

    _print(bibtex([saved_as(result) for result in done]))


def _rows(job: Job, result: Run, given: RunOptions) -> list[dict[str, Any]]:
    from frictionlab.results.table import records

    whose = {"study": job.name} if given.study.is_dir() else {}
    return [whose | record for record in records(result.table)]


def _print_records(records: list[dict[str, Any]]) -> None:
    """One record a line, null for an empty cell."""
    lines = ",\n".join(json.dumps(record, allow_nan=False) for record in records)
    _print(f"[\n{lines}\n]")


def _code(result: Run) -> int:
    from frictionlab.faults import MARK

    if result.table["reason"].astype("str").str.startswith(MARK).any():
        return BROKEN_PLUGIN
    bad = result.counts.keys() & {"failed", "killed"}
    return FAILED if bad or not all(verdict.passed for verdict in result.verdicts) else OK


@cli.command()
@click.argument("run", type=click.Path(path_type=Path))
def plot(run: Path) -> None:
    """Draw the figures of RUN anew, a folder that ``run`` wrote. Nothing is computed."""
    from frictionlab.runner.saved import read_saved

    saved = read_saved(run)
    files = _drawn(saved.table, saved.title, run)
    _print("\n".join(map(str, files))) if files else _tell(f"no figures: the study of {run} sweeps nothing")


@cli.command()
@click.argument("run", type=click.Path(path_type=Path))
def report(run: Path) -> None:
    """Write the figures and the report.html of RUN anew, a folder that ``run`` wrote. Nothing is computed."""
    from frictionlab.report import write_report
    from frictionlab.runner.saved import read_saved

    saved = read_saved(run)
    _drawn(saved.table, saved.title, run)
    _print(str(write_report(saved)))


@cli.group()
def new() -> None:
    """Write a file to begin from."""


@new.command("study")
@click.argument("path", type=click.Path(path_type=Path))
def new_study(path: Path) -> None:
    """Write a commented study to the file PATH, which ``run`` takes as it is. Never replaces a file."""
    from frictionlab.scaffold.study import new_study

    file = new_study(path)
    _print(str(file))
    _tell(f"change what it says, then: frictionlab run {shlex.quote(str(file))}")


@new.command("law")
@click.argument("path", metavar="NAME", type=click.Path(path_type=Path))
@click.option(
    "--memory",
    type=click.Choice(["none", "bristle"]),
    default="bristle",
    show_default=True,
    help="What friction remembers: none, set by slip alone; bristle, a deflection of the contact.",
)
def law(path: Path, memory: Literal["none", "bristle"]) -> None:
    """Write the folder NAME: a law that installs, with its test and a study. Never replaces anything."""
    from frictionlab.scaffold import law

    try:
        folder = law.new_law(path, memory)
    except law.BadName as problem:
        raise click.UsageError(str(problem)) from None
    module = folder / f"{path.name.replace('-', '_')}.py"
    _print(str(folder))
    _tell(
        f"the law is in {module}; try it: "
        f"frictionlab run {shlex.quote(str(folder / 'study.yaml'))} --law {shlex.quote(str(module))}"
    )


@cli.command()
@click.argument("study", type=click.Path(path_type=Path))
@overrides_option
@law_option
@json_option
def check(study: Path, overrides: tuple[str, ...], law_files: tuple[Path, ...], as_json: bool) -> None:
    """Check STUDY and tell what it will take: models, refusals, cost. Nothing is computed."""
    from frictionlab.runner import batch
    from frictionlab.runner.plan import plan

    planned = [(job.name, plan(job.study)) for job in batch.jobs(study, None, overrides, law_files)]
    if as_json:
        _print_records([{"study": name, **entry.record()} for name, entries in planned for entry in entries])
    else:
        lines = [line for name, entries in planned for line in _planned_lines(name, entries)]
        _print("\n".join([*lines, *_cost_lines([entry for _, entries in planned for entry in entries])]))


def _planned_lines(name: str, planned: Sequence[Planned]) -> list[str]:
    lines = [name]
    for entry in planned:
        lines.append(f"  {entry.law} by {entry.method}: points {entry.points}, curves {entry.curves}")
        lines += [f"    {count} by {model}" for model, count in entry.models.items()]
        lines += [f"    {count} refused: {reason}" for reason, count in entry.refused.items()]
    return lines


def _cost_lines(planned: Sequence[Planned]) -> list[str]:
    kernel, cores = sum(entry.seconds for entry in planned), os.cpu_count() or 1
    return [
        f"about {_time(kernel)} of kernel time, {_time(kernel / cores)} on {cores} cores",
        "not counted: compiling kernels, once per machine, which may take longer than all the rest",
    ]


def _time(seconds: float) -> str:
    return f"{seconds * 1e3:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


@cli.command()
@click.argument("names", nargs=-1, metavar="[NAME | test NAME...]")
@law_option
@json_option
@click.option("--markdown", is_flag=True, help="With test: print a table to publish beside the law.")
@click.option(
    "--examples",
    type=click.IntRange(min=1),
    metavar="N",
    help="With test: examples per check, 100 if left out; fewer where they are dear.",
)
def laws(names: tuple[str, ...], law_files: tuple[Path, ...], **options: Any) -> int:
    """List the installed laws, tell all about the law NAME, or test NAME: put it through the conformance battery.

    With test and no NAME, the laws of --law, else every installed law. Broken laws are told on stderr, and the exit
    code is then 4; it is 3 where a check fails that was not expected to.
    """
    from frictionlab.study import laws_of_files

    known = laws_of_files(law_files)
    testing = names[:1] == ("test",)
    asked = names[1:] if testing else names
    for name in asked:
        if name not in known.names():
            raise click.UsageError(f"no law '{name}'; installed: {', '.join(known.names())}")
    if testing:
        return _test_laws(asked or _to_test(known, law_files), known, TestOptions(**options))
    if len(names) > 1 or options["markdown"] or options["examples"]:
        raise click.UsageError("one NAME, or: laws test NAME; --markdown and --examples go with test")
    return _list_laws(asked, known, options["as_json"])


def _list_laws(asked: tuple[str, ...], known: Laws, as_json: bool) -> int:
    from frictionlab.registry.records import details, law_record, one_line_each

    records = [law_record(each, known.named(each)) for each in asked or known.usable()]
    _print_records(records) if as_json else _print(details(records[0]) if asked else one_line_each(records))
    return OK if asked else _told_broken(known)


def _told_broken(known: Laws) -> int:
    """Tell which laws are broken; the exit code."""
    broken = known.broken()
    for message in broken:
        _tell(message)
    return BROKEN_PLUGIN if broken else OK


class TestOptions(NamedTuple):
    """The options of ``laws test``."""

    as_json: bool
    markdown: bool
    examples: int | None


def _to_test(known: Laws, law_files: Sequence[Path]) -> tuple[str, ...]:
    """The laws of the files given, else every law; one of two names of the same law."""
    from frictionlab import registry

    names = [name for name in known.usable() if not law_files or name not in registry.law_names()]
    first = {known.named(name): name for name in reversed(names)}
    return tuple(name for name in names if first[known.named(name)] == name)


def _test_laws(names: Sequence[str], known: Laws, given: TestOptions) -> int:
    """Put laws through the battery, one after the other; the table grows as checks end."""
    from frictionlab.testing import EXAMPLES, check_law, heading

    reports = []
    say = _tell if given.as_json or given.markdown else _print
    for name in names:
        say(heading(name))
        examples = given.examples or EXAMPLES
        law = known.named(name)
        report = check_law(law, examples=examples, on_failure="return", tell=lambda one: say(one.line()))
        say(report.summary(name))
        reports.append((name, report))
        if given.markdown:
            _print(f"{report.markdown(name)}\n")
    if given.as_json:
        _print_records([{"name": name, **record} for name, report in reports for record in report.records()])
    return OK if all(report.passed for _, report in reports) else FAILED


@cli.command()
@json_option
def methods(as_json: bool) -> None:
    """List the installed methods and what they refuse."""
    from frictionlab import registry
    from frictionlab.registry.records import method_record, one_line_each

    records = [method_record(each) for each in registry.method_names()]
    _print_records(records) if as_json else _print(one_line_each(records))


@cli.command()
@law_option
def schema(law_files: tuple[Path, ...]) -> None:
    """Print the JSON Schema of a study file."""
    from frictionlab.study import laws_of_files
    from frictionlab.study.schema import schema as study_schema

    _print(json.dumps(study_schema(laws_of_files(law_files)), indent=2))


@cli.command()
@click.argument("bench_list", metavar="LIST", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Where to; runs/bench-<list name> if left out.",
)
@click.option("--only", multiple=True, metavar="NAME", help="Measure this curve alone; may be repeated.")
def bench(bench_list: Path, out: Path | None, only: tuple[str, ...]) -> None:
    """Measure error against time per point of every method and peer in LIST; one chart and table per curve."""
    from frictionlab import bench as benches

    try:
        asked = benches.load_bench(bench_list).only(only)
    except benches.UnknownCurve as problem:
        raise click.UsageError(str(problem)) from None
    folder = out or Path("runs") / f"bench-{asked.name}"
    try:
        done = benches.measure(asked, _tell)
    except benches.Interrupted as problem:
        _save_bench(problem.done, folder)
        raise CommandError(
            INTERRUPTED, f"interrupted: {len(problem.done)} of {len(asked.workloads)} curves done"
        ) from problem
    _print(benches.summary(done))
    _save_bench(done, folder)


def _save_bench(done: Sequence[Measured], folder: Path) -> None:
    """Write tables, then charts: tables wait for nobody's matplotlib."""
    if not done:
        return
    from frictionlab.bench import write
    from frictionlab.bench.chart import draw as draw_chart

    write(done, folder)
    draw_chart(done, folder)
    _tell(f"tables and charts in {folder}")
