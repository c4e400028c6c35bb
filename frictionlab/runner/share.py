"""One of several shares of the chunks of a study, solved and kept: what a task of a job array does."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass

from frictionlab.results.part import Part
from frictionlab.runner.chunks import task_of
from frictionlab.runner.kept_chunks import KeptChunks, Keys
from frictionlab.runner.open_chunks import OpenChunk, answered, each_once, open_chunks
from frictionlab.runner.progress import Progress, silent
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.study import Mistake, Study, StudyError


@dataclass
class ShareDone:
    """The points of a share: those found from earlier, and those computed and kept now."""

    points: int = 0
    found: int = 0
    computed: int = 0


def run_share(
    study: Study,
    part: tuple[int, int],
    kept: KeptChunks,
    executor: Executor | Workforce | None = None,
    progress: Progress = silent,
) -> ShareDone:
    """Solve and keep every N-th chunk of a study, from the I-th on, for part = (I, N).

    Which chunks those are hangs on the study alone. Points that fail by a defect are not kept: the run that gathers
    all parts tries them again. Raises BrokenPlugin, SaveError, BrokenExecutor, KeyboardInterrupt; what was solved by
    then is kept. Raises StudyError where belt speeds are chosen as a run goes.
    """
    if study.chosen_range is not None:
        within = f"belt speeds within {study.chosen_range.within:g} are chosen as a run goes"
        what = f"{within}, and a part of it cannot know them: run it whole, or give num"
        raise StudyError([Mistake("--part", None, "", what)])
    number, count = part
    done, unknown = ShareDone(), []
    for index, chunk in enumerate(open_chunks(study.curves(), task_of(study), keys=Keys(study.code))):
        if index % count != number - 1:
            continue
        done.points += len(chunk.whole)
        if chunk.key is not None and kept.found(chunk.key) is not None:
            done.found += len(chunk.whole)
        else:
            unknown.append(chunk)

    def take(chunk: OpenChunk, parts: list[Part]) -> None:
        whole = answered(chunk, parts)
        if whole is not None and chunk.key is not None:
            kept.keep(chunk.key, whole)
        done.computed += len(chunk.whole) * (1 + len(chunk.same))

    with workforce(executor) as force:
        force.solve(each_once(unknown), take, lambda: progress(done.found + done.computed, done.points))
    return done
