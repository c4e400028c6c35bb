"""``bench``: error against time of methods and of solvers from outside."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from frictionlab.cli import options
from frictionlab.cli.output import INTERRUPTED, CommandError, print_message, print_result

if TYPE_CHECKING:
    from frictionlab.bench import SectionResult


@click.command("bench")
@click.argument("bench_list", metavar="LIST", type=options.PATH)
@options.folder("runs/bench-<list name>")
@click.option(
    "--only", multiple=True, metavar="NAME", help="Measure this curve or section alone; may be repeated."
)
@click.option(
    "--first-runs",
    is_flag=True,
    help="Also time the first setting of each method where no kernel is compiled.",
)
def bench_command(bench_list: Path, out: Path | None, only: tuple[str, ...], first_runs: bool) -> None:
    """Measure error against time per point of every method and peer in LIST; one chart and table per curve, and
    those of each section.
    """
    from frictionlab import bench
    from frictionlab.bench.page import check_folder, save
    from frictionlab.runner.progress import spoken

    try:
        asked = bench.load_bench(bench_list).only(only)
    except bench.UnknownCurve as problem:
        raise click.UsageError(str(problem)) from None
    folder = out or Path("runs") / f"bench-{asked.name}"
    check_folder(folder)
    done: list[SectionResult] = []
    start = last = time.monotonic()

    def tell(what: str) -> None:
        """Tell what is measured now, and the time left if parts take as long as those before."""
        left = (last - start) * len(asked.names) / len(done) - (time.monotonic() - start) if done else 0.0
        print_message(f"{what}, about {spoken(left)} left" if left > 0.5 else what)

    try:
        for finished in bench.measure(asked, tell, first_runs):
            page = save(finished, folder)
            done.append(finished)
            last = time.monotonic()
    except KeyboardInterrupt:
        raise CommandError(
            INTERRUPTED, f"interrupted: {len(done)} of {len(asked.names)} {asked.parts} done"
        ) from None
    print_result(bench.bench_summary(done))
    print_message(f"tables and charts in {folder}, all of them on {page}")
