"""Needs of a scene: ``fl.needs``, and the same of every curve of a study.

What one curve needs: the table of everything taken away, the same in sentences, and the smallest model.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from frictionlab.analysis.needs.answers import Curves, commonest_reason
from frictionlab.analysis.needs.motion import FRICTION_FREE, LesserModel, MotionWay, WithoutRest
from frictionlab.analysis.needs.search import LeastSearch, Without, each_reason_once
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.arguments import given_law, given_scene, given_speeds, given_tolerance
from frictionlab.runner.progress import ProgressAsked, progress_told
from frictionlab.runner.words import counted, in_words
from frictionlab.scene.dimensional import without_unit
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.units import Units
from frictionlab.study import registry
from frictionlab.study.axes import FRICTION
from frictionlab.study.grid import StudyCurve, law_in_scene
from frictionlab.study.parts import coefficient_of
from frictionlab.study.study import Study
from frictionlab.theory.rest import size_of_friction
from frictionlab.values.columns import BELT_SPEEDS, NEEDS
from frictionlab.values.notes import Mistake, StudyError
from frictionlab.values.printable import with_error
from frictionlab.values.quantities import Dimension, Written, dimensions
from frictionlab.values.units import ShownUnit, handy_unit, unit_of_dimension, units_written

WHERE_IT_MOVES = {
    0: "slip prescribed",
    1: "motion along the belt alone",
    2: "motion along and across the belt",
}


class GivenUnits(NamedTuple):
    """Scales of a scene in SI units, and the unit of its belt speeds."""

    scales: Units
    speed: ShownUnit


@dataclass(frozen=True, repr=False)
class Needs:
    """Parts of a scene that one curve needs, and the smallest model within a tolerance.

    ``fl.needs`` returns it.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each set of parts taken away, with the columns of ``columns.NEEDS``.
    sentences : list of str
        The same as sentences.
    smallest : LesserModel
        Smallest model within the tolerance (``scene``, ``law``, ``method``), nondimensional; the full model
        if nothing can be taken away.
    label : str
        Label that distinguishes this curve from others of its study.
    failed : bool
        Whether the full scene lacks an answer that it should have at some points.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> found = fl.needs(scene, fl.Coulomb(mu=0.4))
    >>> found.table[["without", "verdict"]].values.tolist()[-1]
    ["friction's effect on the motion", 'needed']
    >>> found.smallest.method
    HarmonicBalance()
    """

    table: pd.DataFrame
    sentences: list[str]
    smallest: LesserModel
    label: str = ""
    failed: bool = False

    def __repr__(self) -> str:
        """Its sentences, a line each."""
        return "\n".join(self.sentences)

    def plot(self, ax: Any = None) -> Any:
        """Draw the change of the mean without each part as bars, against the tolerance.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw into; a figure is made if left out.

        Returns
        -------
        matplotlib.figure.Figure
            Figure.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> figure = fl.needs(scene, fl.Coulomb(mu=0.4)).plot()
        >>> figure.savefig("needs.svg")
        """
        from frictionlab.charts.needs import needs_figure  # with matplotlib, which takes a second

        return needs_figure(self.table, into=ax)


def needs_from(
    full: LesserModel,
    answers: pd.DataFrame,
    rows: Sequence[Without],
    smallest: Without | None,
    within: float,
    units: GivenUnits | None = None,
) -> Needs:
    """Result for a full model with these answers. rows: what was taken away, the smallest model among them."""
    told = [*missing_means(answers), *(sentence_of(each, units) for each in rows)]
    if (answers["status"] == "ok").any():
        told.append(smallest_in_words(smallest, full, within, units))
    table = pd.DataFrame([_record(each, within, each is smallest, units) for each in rows], columns=[*NEEDS])
    least = full if smallest is None or smallest.model is None else smallest.model
    failed = bool(answers["status"].isin(["failed", "killed"]).any())
    return Needs(table, told, least, failed=failed)


def _record(each: Without, within: float, smallest: bool, units: GivenUnits | None) -> dict[str, Any]:
    found = each.change
    return {
        "curve": "",
        "without": " + ".join(each.names),
        "verdict": found.verdict,
        "change": found.mean.value,
        "change_error": found.mean.error,
        "belt_speed": found.belt_speed,
        "within": within,
        "reduction_change": found.reduction.value,
        "reduction_change_error": found.reduction.error,
        "shape": found.shapes[0],
        "shape_without": found.shapes[1],
        "smallest": smallest,
        "model": "" if each.model is None else model_in_words(each.model, units),
        "reason": found.reason,
    }


def model_in_words(model: LesserModel, units: GivenUnits | None = None) -> str:
    """Return what a model still has."""
    values = model.law.model_dump(exclude_none=True, mode="json", exclude_defaults=True)
    if units is not None:
        values |= {
            name: _in_si(values[name], each, units.scales)
            for name, each in dimensions(type(model.law)).items()
            if name in values
        }
    told = ", ".join(f"{name} {in_words(value)}" for name, value in values.items())
    way = "" if model.way is None else f", {_way_in_words(model.way)}"
    return (
        f"{WHERE_IT_MOVES[model.scene.degrees_of_freedom]}, {type(model.law).__name__} friction ({told}){way}"
    )


def _in_si(value: Any, dimension: Dimension, scales: Units) -> Any:
    """A number of a law in SI units, in words."""
    if isinstance(value, list):
        return [_in_si(each, dimension, scales) for each in value]
    number, unit = value * scales.of(dimension), unit_of_dimension(dimension)
    return (ShownUnit(unit) if unit[:1] == "1" else handy_unit(unit, abs(number))).text(number)


def _way_in_words(way: MotionWay) -> str:
    if way.name == FRICTION_FREE:
        return "friction averaged over the friction-free motion (mdsm)"
    if isinstance(way, WithoutRest):
        return "a motion of two reversals a period without rest"
    return f"{counted(getattr(way, 'harmonics', 1), 'harmonic')} balanced ({way.name})"


def sentence_of(each: Without, units: GivenUnits | None = None) -> str:
    """Check whether what is gone is needed, and what the mean changes by without it."""
    names = " and ".join(each.names)
    plural = len(each.names) > 1 or names.startswith("harmonics")
    verb, it = ("are", "them") if plural else ("is", "it")
    if each.change.verdict == "refused":
        return f"{names} cannot be taken away: {each.change.reason}"
    changes = f"without {it} {_changes(each, units)}"
    if each.change.turns:
        changes += ", its curve from {} to {}".format(*each.change.shapes)
    why = f" ({each.change.reason})" if each.change.reason else ""
    if each.change.verdict == "undecided":
        return f"whether {names} {verb} needed is undecided: {changes}{why}"
    return f"{names} {verb} {each.change.verdict}: {changes}{why}"


def smallest_in_words(
    smallest: Without | None, full: LesserModel, within: float, units: GivenUnits | None = None
) -> str:
    """Return the smallest model, what it is without, and what that changes."""
    if smallest is None or smallest.model is None:
        return f"the smallest model within {within:.3g} is the full one: {model_in_words(full, units)}"
    *names, last = smallest.names
    listed = f"{', '.join(names)} and {last}" if names else last
    less = f"the smallest model within {within:.3g} is without {listed}"
    return f"{less}: {model_in_words(smallest.model, units)}; {_changes(smallest, units)}"


def _changes(each: Without, units: GivenUnits | None) -> str:
    """Return the change by its magnitude, and its error where that is not small beside it."""
    speed = each.change.belt_speed
    mean, at = (
        each.change.mean,
        f"at belt speed {speed:.6g}" if units is None else f"at belt speed {units.speed.text(speed)}",
    )
    size = abs(mean.value)
    at_most = (
        f"at most {size + mean.error:.2g}" if size <= mean.error else with_error(size, mean.error, 3, " +- ")
    )
    return f"the mean changes by {at_most} {at}"


def missing_means(answers: pd.DataFrame) -> list[str]:
    """Return what is said of belt speeds at which the full scene has no one mean."""
    rest = answers[answers["status"] != "ok"]
    if rest.empty:
        return []
    why = commonest_reason(rest)
    if len(rest) == len(answers):
        return [f"the full scene has no one mean to compare with ({why})"]
    where = f"{counted(len(rest), 'belt speed')} of {len(answers)}"
    return [f"left out: {where} at which the full scene has no one mean ({why})"]


USUAL_SHARE = 0.01
"""Tolerance on the mean, of the friction of steady sliding at the quickest belt speed, where none is given."""
ANSWERS_FINER = 1e-3
"""Error of the means asked for, of that tolerance."""


@dataclass(frozen=True)
class _Asked:
    """Laws by name, the registered names of laws of files, the time a point may take [s], the unit of belt speeds."""

    laws: registry.Laws = registry.INSTALLED_LAWS
    kinds: Mapping[type, str] = field(default_factory=dict)
    seconds_per_point: float = math.inf
    speed: ShownUnit | None = None


def needs(
    scene: Scene,
    law: FrictionLaw,
    belt_speed: ArrayLike | None = None,
    within: float | None = None,
    progress: ProgressAsked = None,
) -> Needs:
    """Find the parts that a scene needs: take each away, solve the smaller model, compare the means.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    belt_speed : array_like of float, shape (n,), optional
        Belt speeds of the curve [omega_1 L; m/s for a scene in SI units]; that of the scene if left out.
    within : float, > 0, optional
        Tolerance on the mean friction coefficient [-]; 1 % of steady sliding friction at the quickest belt
        speed if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.

    Returns
    -------
    Needs
        Changes of the mean, sentences, and the smallest model.

    Raises
    ------
    ValueError
        If a value makes no sense.
    TypeError
        If a value is of another kind.
    BrokenPlugin
        If an installed law or a law from a file cannot be used.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> found = fl.needs(scene, fl.Coulomb(mu=0.4))
    >>> found.sentences[0]
    'harmonics above 9 are not needed: without them the mean changes by 1.63e-05 at belt speed 5'
    """
    scene, law = given_scene(scene), given_law(law)
    si = scene.dimensional
    own = scene.belt_speed if si is None else si.belt_speed_m_per_s
    scenes = Scenes(scene, np.unique(given_speeds(own if belt_speed is None else belt_speed, scene)))
    asked = _Asked(speed=units_written({"": own}).get(""))
    tolerance = None if within is None else given_tolerance(within, "within")
    with progress_told(progress, "taking parts away", ""):
        return _of_curve(scenes, law, tolerance, asked)


def needs_of_study(study: Study, within: float | None = None) -> Iterator[Needs]:
    """Yield the same of every curve of a study, whatever its methods and its tolerance. Raises BrokenPlugin."""
    kinds = {choice.law_class: choice.kind for choice in study.laws}
    laws = registry.Laws({choice.kind: choice.law_class for choice in study.laws})
    asked = _Asked(laws, kinds, study.limit.seconds_per_point, study.units.get(BELT_SPEEDS[1]))
    first = study.methods[0].label
    for curve in study.foreseen().curves():
        if curve.method.label != first:
            continue
        found, label = _of_curve(curve.scenes, curve.given_law, within, asked), _label(study, curve)
        yield replace(found, table=found.table.assign(curve=label), label=label)


def _label(study: Study, curve: StudyCurve) -> str:
    """Return the law and the swept values that tell a curve from the others of its study."""
    scene, law = curve.scenes.scene.values(), curve.given_law.model_dump(mode="json")
    told = [curve.law_label] if len(study.laws) > 1 else []
    for path in study.sweep:
        owner, _, name = path.rpartition(".")
        inside = path.removeprefix("scene.")
        if path.startswith("scene.") and not name.startswith("belt_speed"):
            value = scene.get(inside)
            brief = without_unit(inside) if isinstance(value, Written) else inside
            told.append(f"{brief.removeprefix('dimensional.')} {in_words(value)}")
        elif path == FRICTION:
            name = coefficient_of(type(curve.given_law))
            told.append(f"{name} {in_words(law[name])}")
        elif owner == f"laws.{curve.law_label}":
            told.append(f"{name} {in_words(law[name])}")
    return ", ".join(told)


def _of_curve(scenes: Scenes, law: FrictionLaw, within: float | None, asked: _Asked) -> Needs:
    scene, scenes = scenes.scene, Scenes(scenes.scene, np.unique(scenes.given))
    if scene.is_free:
        raise StudyError(
            [Mistake("needs", None, "scene", "takes no body without a spring: give it a soft one")]
        )
    si = scene.dimensional
    units = None if si is None else GivenUnits(si.scales, asked.speed or ShownUnit("m/s"))
    full = LesserModel(scene.model_copy(update={"dimensional": None}), law_in_scene(law, scene))
    quickest = float(np.abs(scenes.belt_speeds).max())
    usual = full.law.sliding_friction(quickest) or size_of_friction(full.scene, full.law)
    tolerance = USUAL_SHARE * usual if within is None else within
    curves = Curves(scenes, ANSWERS_FINER * tolerance, asked.kinds, asked.seconds_per_point)
    answers = curves.of(full)
    if not (answers["status"] == "ok").any():
        return needs_from(full, answers, [], None, tolerance, units)
    search = LeastSearch(full, curves, tolerance, asked.laws)
    singles = search.singles()
    pairs = search.pairs(singles)
    smallest = search.smallest(singles, pairs)
    rows = [*each_reason_once(singles), *pairs, *search.whole(singles)]
    if smallest is not None and smallest not in rows:
        rows.append(smallest)
    return needs_from(full, answers, rows, smallest, tolerance, units)
