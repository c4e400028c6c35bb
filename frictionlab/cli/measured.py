"""Studies with measurements, as ``run`` and ``check`` take them: solved where something was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frictionlab.cli.output import WRONG, CommandError

if TYPE_CHECKING:
    from frictionlab.runner.batch import Job


def at_measured(jobs: list[Job]) -> list[Job]:
    """The jobs, those with measurements at their points. Raises CommandError."""
    if all(job.study.data is None for job in jobs):
        return jobs
    from frictionlab.fitting.files import at_measured_points
    from frictionlab.fitting.measured import WrongData

    try:
        return [job._replace(study=at_measured_points(job.study)) for job in jobs]
    except WrongData as problem:
        raise CommandError(WRONG, str(problem)) from None
