"""One study or a folder of them, read and checked as a whole before the first is run.

The plan of a study: curves and points per law and method, refusals, models, laws that are one. Nothing is computed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from itertools import combinations, product
from pathlib import Path
from typing import Any, NamedTuple

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.arguments import Existing
from frictionlab.runner.curve_loads import speeds_to_add
from frictionlab.runner.files import FolderError, check_free
from frictionlab.runner.folder import check_page, run_folder
from frictionlab.scene.free_body import bound
from frictionlab.scene.scenes import Scenes
from frictionlab.study import registry
from frictionlab.study.grid import StudyCurve
from frictionlab.study.law_files import Plugins
from frictionlab.study.load import load_study
from frictionlab.study.study import Study
from frictionlab.values.notes import Mistake, StudyError


class Job(NamedTuple):
    """A study, the name it goes by, and the folder its results go to."""

    name: str
    study: Study
    out: Path


def jobs(
    path: Path,
    out: Path | None,
    overrides: Sequence[str],
    law_files: Sequence[Path] = (),
    plugins: Plugins = "run",
) -> list[Job]:
    """Studies of a file or of a folder's ``*.yaml``. Raises StudyError with all their mistakes, BrokenPlugin.

    plugins: whether law files that a study itself lists are run, or refused.
    """
    folder = _folder(path, out)
    if not path.is_dir():
        return [Job(path.stem, load_study(path, overrides, law_files, plugins), folder)]
    files = sorted(path.glob("*.yaml"))
    if not files:
        raise StudyError([Mistake(str(path), None, "", "a folder without studies: no *.yaml in it")])
    studies = _all_read(files, lambda file: load_study(file, overrides, law_files, plugins))
    return [Job(file.stem, study, folder / file.stem) for file, study in zip(files, studies, strict=True)]


def index_folder(path: Path, out: Path | None) -> Path | None:
    """Return where a folder of studies gets its index; None for a single study. Raises FolderError."""
    if not path.is_dir():
        return None
    folder = _folder(path, out)
    check_page(folder / "index.html")
    return folder


def _folder(path: Path, out: Path | None) -> Path:
    return out or Path("runs") / path.absolute().stem


def _all_read(files: Sequence[Path], read: Callable[[Path], Study]) -> list[Study]:
    studies: list[Study] = []
    mistakes: list[Mistake] = []
    for file in files:
        try:
            studies.append(read(file))
        except StudyError as problem:
            mistakes += problem.mistakes
    if mistakes:
        raise StudyError(mistakes)
    return studies


def check_folders(found: Sequence[Job], existing: Existing, alone: bool = True) -> None:
    """Raises FolderError with every folder to which its study cannot be written.

    alone: also where another run is at work in it; parts of a run work side by side.
    """
    problems = []
    for job in found:
        try:
            run_folder(job.study, job.out).check(existing)
            if alone:
                check_free(job.out)
        except FolderError as problem:
            problems.append(str(problem))
    if problems:
        raise FolderError("\n".join(problems))


@dataclass(frozen=True)
class Planned:
    """Points of one law and one method.

    about: belt speeds are chosen as the run goes, so that points are not known better.
    shapeless: curves that lack points for a measure of their shape, which ``add_belt_speeds`` would give them.
    """

    law: str
    kind: str
    method: str
    curves: int
    points: int
    refused: dict[str, int]
    models: dict[str, int]
    about: bool
    shapeless: int
    add_belt_speeds: list[float]

    def record(self) -> dict[str, Any]:
        """As a record of plain values."""
        return asdict(self)


def plan(study: Study) -> list[Planned]:
    """One entry per law and method, in the order of the study. Raises BrokenPlugin."""
    groups: dict[tuple[str, str], list[StudyCurve]] = {}
    for curve in study.foreseen().curves():
        groups.setdefault(curve.labels, []).append(curve)
    return [_planned(group, study) for group in groups.values()]


def _planned(curves: Sequence[StudyCurve], study: Study) -> Planned:
    tolerance, about = study.tolerance, study.chosen_range is not None
    first, refusals, models = curves[0], Counter[str](), Counter[str]()
    for curve in curves:
        method, law, scenes = curve.method.method, curve.law, bound(curve.scenes)
        reasons = method.refusals(scenes, law)
        refusals.update(reason for reason in reasons if reason is not None)
        able = [place for place, reason in enumerate(reasons) if reason is None]
        if able:
            models[_model(method, scenes.taken(able), law, tolerance)] += len(able)
    given = (
        [] if about else [(curve.scenes, curve.law) for curve in curves]
    )  # chosen ones are not to be added to
    shapeless, add_belt_speeds = speeds_to_add(given)
    return Planned(
        law=first.law_label,
        kind=first.kind,
        method=first.method.label,
        curves=len(curves),
        points=sum(len(curve.rows) for curve in curves),
        refused=dict(refusals),
        models=dict(models),
        about=about,
        shapeless=shapeless,
        add_belt_speeds=add_belt_speeds,
    )


def _model(method: Method, scenes: Scenes, law: FrictionLaw, tolerance: float) -> str:
    """Return the model that will compute the numbers, and why; the name of a method that makes no choice."""
    auto: Any = registry.method_class("auto")
    return str(auto.foreseen(method, scenes, law, tolerance)) if isinstance(method, auto) else method.name


_SPEEDS = tuple(10.0 ** (0.5 * k) for k in range(-18, 19))
"""Slip speeds at which laws are compared, in units of their scene."""
_SHARES = tuple(sign * (1.0 - 0.5**k) for sign in (1.0, -1.0) for k in range(12))
"""Deflections at which they are compared, over the largest: closer and closer to it, where bristles yield."""


def laws_twice(study: Study) -> list[tuple[str, str]]:
    """Return the labels of laws that are one law, the one that is listed first first."""
    laws = {curve.law_label: curve.law for curve in reversed(list(study.foreseen().curves()))}
    pairs = combinations(reversed(laws.items()), 2)
    return [(label, other) for (label, law), (other, second) in pairs if are_one_law(law, second)]


def are_one_law(one: Any, other: Any) -> bool:
    """Check whether two laws agree in friction, and in the rate of a bristle, wherever tried.

    Laws with several memories are not compared.
    """
    if one.memory_kind != other.memory_kind or one.memory_kind not in ("none", "bristle"):
        return False
    pairs = zip(_numbers(one, one), _numbers(other, one), strict=True)
    return all(abs(a - b) <= 1e-12 * max(abs(a), abs(b)) for a, b in pairs)


def _numbers(law: Any, sizes: Any) -> list[float]:
    """Return numbers that two laws share if they are one; sizes: the law that says how large deflections are."""
    found = [law.sliding_friction(speed) for speed in _SPEEDS]
    if law.memory_kind == "none":
        return [law.static_friction(), *found]
    reach = sizes.largest_deflection()
    for speed, share in product(_SPEEDS, _SHARES):
        rate = law.rate(speed, share * reach)
        found += [rate, law.friction(speed, share * reach, rate)]
    return found
