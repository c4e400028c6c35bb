"""``check``: what a study will take, before anything is computed."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from frictionlab.cli import options
from frictionlab.cli.output import print_records, print_result

if TYPE_CHECKING:
    from frictionlab.runner.plan import Planned
    from frictionlab.study import Plugins


@click.command("check")
@click.argument("study", type=options.PATH)
@options.overrides
@options.law_files
@options.no_plugins
@options.as_json
def check_command(
    study: Path, overrides: tuple[str, ...], law_files: tuple[Path, ...], plugins: Plugins, as_json: bool
) -> None:
    """Check STUDY and tell what it will take: models, refusals, cost. Nothing is computed.

    The plugins that STUDY lists are Python code, which is run to check it, unless --no-plugins is given.
    """
    from frictionlab.runner import batch
    from frictionlab.runner.plan import plan

    planned = [(job.name, plan(job.study)) for job in batch.jobs(study, None, overrides, law_files, plugins)]
    if as_json:
        print_records([{"study": name, **entry.record()} for name, entries in planned for entry in entries])
    else:
        lines = [line for name, entries in planned for line in _planned_lines(name, entries)]
        costs = _cost_lines([entry for _, entries in planned for entry in entries])
        print_result("\n".join([*lines, *costs]))


def _planned_lines(name: str, planned: Sequence[Planned]) -> list[str]:
    lines = [name]
    for entry in planned:
        about = "about " if entry.about else ""
        lines.append(f"  {entry.law} by {entry.method}: points {about}{entry.points}, curves {entry.curves}")
        lines += [f"    {count} by {model}" for model, count in entry.models.items()]
        lines += [f"    {count} refused: {reason}" for reason, count in entry.refused.items()]
        if entry.shapeless:
            which = (
                f"{entry.shapeless} of {entry.curves} curves lack" if entry.curves > 1 else "the curve lacks"
            )
            speeds = ", ".join(f"{speed:g}" for speed in entry.add_belt_speeds)
            lines.append(f"    {which} points for a measure of shape; add belt speeds {speeds}")
    return lines


def _cost_lines(planned: Sequence[Planned]) -> list[str]:
    kernel, cores = sum(entry.seconds for entry in planned), os.cpu_count() or 1
    return [
        f"about {_time(kernel)} of kernel time, {_time(kernel / cores)} on {cores} cores",
        "not counted: kernels that this machine has not kept yet are compiled once, 5 to 15 s each",
    ]


def _time(seconds: float) -> str:
    return f"{seconds * 1e3:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"
