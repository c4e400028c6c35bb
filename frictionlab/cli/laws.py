"""``laws``: the installed laws, and their conformance."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from frictionlab.cli import options
from frictionlab.cli.output import BROKEN_PLUGIN, FAILED, OK, print_message, print_records, print_result

if TYPE_CHECKING:
    from frictionlab.study.registry import Laws
    from frictionlab.testing import Report
    from frictionlab.testing.running import Outcome


@click.command("laws")
@click.argument("names", nargs=-1, metavar="[NAME | test NAME...]")
@options.law_files
@options.as_json
@click.option("--markdown", is_flag=True, help="With test: print a table to publish beside the law.")
@click.option(
    "--examples",
    type=click.IntRange(min=1),
    metavar="N",
    help="With test: examples per check, 100 if left out; fewer where they are dear.",
)
def laws_command(names: tuple[str, ...], law_files: tuple[Path, ...], **given: Any) -> int:
    """List the installed laws, tell all about the law NAME, or test NAME: put it through the conformance battery.

    With test and no NAME, the laws of --law, else every installed law. Broken laws are told on stderr, and the exit
    code is then 4; it is 3 where a check fails that was not expected to.
    """
    from frictionlab.study.law_files import laws_of_files

    known = laws_of_files(law_files)
    testing = names[:1] == ("test",)
    asked = names[1:] if testing else names
    options.check_laws(asked, known)
    if testing:
        return _test(asked or _to_test(known, law_files), known, TestOptions(**given))
    if len(names) > 1 or given["markdown"] or given["examples"]:
        raise click.UsageError("one NAME, or: laws test NAME; --markdown and --examples go with test")
    return _list(asked, known, given["as_json"])


def _list(asked: tuple[str, ...], known: Laws, as_json: bool) -> int:
    from frictionlab.study.records import details, law_record, one_line_each

    aliases = known.aliases()
    records = [law_record(each, known.named(each), aliases.get(each, ())) for each in asked or aliases]
    if as_json:
        print_records(records)
    else:
        print_result(details(records[0]) if asked else one_line_each(records))
    return OK if asked else _print_broken(known)


def _print_broken(known: Laws) -> int:
    """Print which laws are broken, and why; the exit code."""
    broken = known.broken()
    for message in broken:
        print_message(message)
    return BROKEN_PLUGIN if broken else OK


class TestOptions(NamedTuple):
    """Options of ``laws test``."""

    as_json: bool
    markdown: bool
    examples: int | None


def _to_test(known: Laws, law_files: Sequence[Path]) -> tuple[str, ...]:
    """Return the laws of the files given, else every law, broken ones too; one of two names of the same law."""
    from frictionlab.study import registry

    others = {name for own in known.aliases().values() for name in own}
    names = [name for name in known.names() if not law_files or name not in registry.law_names()]
    return tuple(name for name in names if name not in others)


def _test(names: Sequence[str], known: Laws, given: TestOptions) -> int:
    """Put laws through the battery, one after the other; the table grows as checks end."""
    from frictionlab.study.registry import BrokenPlugin

    reports: dict[str, Report] = {}
    for name in names:
        try:
            reports[name] = _tested(name, known.named(name), given)
        except BrokenPlugin as problem:
            print_message(str(problem))
    if given.as_json:
        print_records([{"name": name, **record} for name, one in reports.items() for record in one.records()])
    if len(reports) < len(names):
        return BROKEN_PLUGIN
    return OK if all(report.passed for report in reports.values()) else FAILED


def _tested(name: str, law: Any, given: TestOptions) -> Report:
    """Put one law through the battery. Where the result is a record or Markdown, stderr has progress alone."""
    from frictionlab.testing import EXAMPLES, check_law, heading

    apart = given.as_json or given.markdown
    say = print_message if apart else print_result
    say(heading(name))

    def tell(one: Outcome) -> None:
        if one.result != "skipped":
            say(one.line(remark="" if apart else one.remark))

    report = check_law(law, examples=given.examples or EXAMPLES, on_failure="return", tell=tell)
    for line in report.skips():
        say(line)
    say(report.summary(name))
    if given.markdown:
        print_result(f"{report.markdown(name)}\n")
    return report
