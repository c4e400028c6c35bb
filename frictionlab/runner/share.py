"""One of several shares of the chunks of a study, solved and kept: what a task of a job array does."""

from __future__ import annotations

from concurrent.futures import Executor

from frictionlab.runner.chunks import task_of
from frictionlab.runner.kept_chunks import KeptChunks, Keys
from frictionlab.runner.progress import Progress, silent
from frictionlab.runner.solving import Keeping, Solving
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.study import Mistake, Study, StudyError


def run_share(
    study: Study,
    part: tuple[int, int],
    kept: KeptChunks,
    executor: Executor | Workforce | None = None,
    progress: Progress = silent,
) -> Solving:
    """Solve and keep every N-th chunk of a study, from the I-th on, for part = (I, N).

    Which chunks those are hangs on the study alone. Points that fail by a defect are not kept: the run that gathers
    all parts tries them again. Raises BrokenPlugin, SaveError, BrokenExecutor, KeyboardInterrupt; what was solved by
    then is kept. Raises StudyError where belt speeds are chosen as a run goes.
    """
    if study.chosen_range is not None:
        within = f"belt speeds within {study.chosen_range.within:g} are chosen as a run goes"
        what = f"{within}, and a part of it cannot know them: run it whole, or give num"
        raise StudyError([Mistake("--part", None, "", what)])
    solving = Solving(list(study.curves()), task_of(study), Keeping(kept, Keys(study.code), must_keep=True))
    with workforce(executor) as force:
        solving.solve(force, progress, part)
    return solving
