"""``check``: what a study will take, before it is run.

Studies with measurements, as ``run`` and ``check`` take them: solved where something was measured.
"""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import click

from frictionlab.cli import options
from frictionlab.cli.output import WRONG, CommandError, metered, print_records, print_result
from frictionlab.values.columns import BELT_SPEEDS

if TYPE_CHECKING:
    from frictionlab.runner.batch import Job, Planned
    from frictionlab.runner.price import Price
    from frictionlab.study.law_files import Plugins
    from frictionlab.values.units import ShownUnit


def at_measured(jobs: list[Job]) -> list[Job]:
    """Return the jobs, those with measurements at their points. Raises CommandError."""
    if all(job.study.data is None for job in jobs):
        return jobs
    from frictionlab.analysis.fit.api import at_measured_points
    from frictionlab.analysis.fit.measured import WrongData

    try:
        return [job._replace(study=at_measured_points(job.study)) for job in jobs]
    except WrongData as problem:
        raise CommandError(WRONG, str(problem)) from None


@click.command("check")
@click.argument("study", type=options.PATH)
@options.overrides
@options.law_files
@options.no_plugins
@options.as_json
def check_command(
    study: Path, overrides: tuple[str, ...], law_files: tuple[Path, ...], plugins: Plugins, as_json: bool
) -> None:
    """Check STUDY and tell what it will take: models, refusals, time. No answer is kept, no kernel is compiled.

    The time follows from that of five points of each law and method, which may take three seconds each. The plugins
    that STUDY lists are Python code, which is run to check it, unless --no-plugins is given.
    """
    from frictionlab.runner import batch
    from frictionlab.runner.batch import plan
    from frictionlab.runner.pieces import task_of
    from frictionlab.runner.price import prices

    jobs = at_measured(batch.jobs(study, None, overrides, law_files, plugins))
    planned = [(job.name, plan(job.study)) for job in jobs]
    clock, processor = time.perf_counter(), time.process_time()
    with metered() as meter:
        meter.begins("timing", "laws and methods")
        priced = [
            list(prices(list(job.study.foreseen().curves()), task_of(job.study), meter).values())
            for job in jobs
        ]
    # what other programs leave of a core
    busy = max(1.0, (time.perf_counter() - clock) / (time.process_time() - processor))
    if as_json:
        print_records(
            [
                {"study": name, **entry.record(), **price.record()}
                for (name, entries), each in zip(planned, priced, strict=True)
                for entry, price in zip(entries, each, strict=True)
            ]
        )
    else:
        lines = [
            line
            for (name, entries), job in zip(planned, jobs, strict=True)
            for line in [
                *_planned_lines(name, entries, job.study.units.get(BELT_SPEEDS[1])),
                *(
                    f"  {first} and {second} are one law with these numbers: their curves are one line"
                    for first, second in batch.laws_twice(job.study)
                ),
            ]
        ]
        print_result("\n".join([*lines, *_price_lines([entries for _, entries in planned], priced, busy)]))


def _planned_lines(name: str, planned: Sequence[Planned], unit: ShownUnit | None) -> list[str]:
    """Return what a study will take. unit: of its belt speeds, where they were written with one."""
    lines = [name]
    for entry in planned:
        about = "about " if entry.about else ""
        lines.append(f"  {entry.law} by {entry.method}: points {about}{entry.points}, curves {entry.curves}")
        lines += [f"    {count} by {model}" for model, count in entry.models.items()]
        lines += [f"    {count} refused: {reason}" for reason, count in entry.refused.items()]
    for speeds in dict.fromkeys(tuple(entry.add_belt_speeds) for entry in planned if entry.shapeless):
        lacking = [entry for entry in planned if entry.shapeless and tuple(entry.add_belt_speeds) == speeds]
        whose = ", ".join(dict.fromkeys(entry.law for entry in lacking))
        which = f"{sum(entry.shapeless for entry in lacking)} of {sum(entry.curves for entry in lacking)}"
        told = ", ".join(f"{speed:g}" if unit is None else unit.text(speed) for speed in speeds)
        lines.append(f"  {whose}: {which} curves lack points for a measure of shape; add belt speeds {told}")
    return lines


def _price_lines(
    planned: Sequence[Sequence[Planned]], priced: Sequence[Sequence[Price]], busy: float
) -> list[str]:
    """Tell the time of all studies, run one after another. busy: how much longer than alone everything takes."""
    from frictionlab.runner.price import (
        A_CURVE,
        BESIDES,
        COMPILING,
        MOST_DRAWN,
        MOST_SECONDS,
        solving_seconds,
    )
    from frictionlab.runner.progress import spoken

    kinds = list(zip(chain.from_iterable(planned), chain.from_iterable(priced), strict=True))
    prices = [price for _, price in kinds]
    kernels = sorted(frozenset[str]().union(*(each.to_compile for each in prices)))
    solving = sum(solving_seconds(each) for each in priced)
    drawn = sum(min(sum(each.curves for each in entries), MOST_DRAWN) for entries in planned)
    compiling, besides = busy * COMPILING * len(kernels), busy * (BESIDES * len(planned) + A_CURVE * drawn)
    points = sum(entry.points for entry, _ in kinds)
    whole = "at least" if any(each.over for each in prices) else "about"
    measured = min(points, sum(each.measured for each in prices))
    how = f"{spoken(solving)} of it to solve, as measured on {measured} of {points} points"
    lines = [f"{whole} {spoken(solving + compiling + besides)} on {os.cpu_count()} cores, {how}"]
    lines += [
        f"{entry.law} by {entry.method}: {price.over} of {price.measured} tried points take over {MOST_SECONDS:g} s"
        for entry, price in kinds
        if price.over
    ]
    if kernels:
        names = ", ".join(each.split("_", 1)[1].rpartition("_")[0].replace("_", " ") for each in kernels)
        lines.append(f"{spoken(compiling)} of it to compile what is not kept here yet, once: {names}")
    if any(not each.measured for each in prices if each.to_compile):
        lines.append("more where points take long: known once frictionlab warm, or a run, has compiled it")
    return lines
