"""What one curve needs: the table of everything taken away, the same in sentences, and the smallest model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import pandas as pd

from frictionlab.columns import NEEDS
from frictionlab.least_model.answers import commonest_reason
from frictionlab.least_model.lesser import LesserModel, MotionWay
from frictionlab.least_model.motion import FRICTION_FREE, WithoutRest
from frictionlab.least_model.search import Without
from frictionlab.printable import with_error
from frictionlab.quantities import Dimension, dimensions
from frictionlab.results.words import counted, in_words
from frictionlab.scene.units import Units
from frictionlab.units.shown import ShownUnit, handy_unit
from frictionlab.units.text import unit_of_dimension

WHERE_IT_MOVES = {
    0: "slip prescribed",
    1: "motion along the belt alone",
    2: "motion along and across the belt",
}


class GivenUnits(NamedTuple):
    """The scales of a scene in SI units, and the unit of its belt speeds."""

    scales: Units
    speed: ShownUnit


@dataclass(frozen=True, repr=False)
class Needs:
    """What one curve needs.

    table: a row per set of things taken away, with the columns of ``columns.NEEDS``. sentences: the same for reading.
    smallest: the smallest model within the tolerance (scene, law, method), nondimensional; the full one where nothing
    may go. label: what tells this curve from others of its study. failed: whether the full scene lacks an answer that
    it should have at some points.

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
        """A matplotlib figure: bars of the change without each thing, against the tolerance. ax: axes to draw into.

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
    """The result for a full model with these answers. rows: what was taken away, the smallest model among them."""
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
    """What a model still has."""
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
    """Whether what is gone is needed, and what the mean changes by without it."""
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
    """The smallest model, what it is without, and what that changes."""
    if smallest is None or smallest.model is None:
        return f"the smallest model within {within:.3g} is the full one: {model_in_words(full, units)}"
    *names, last = smallest.names
    listed = f"{', '.join(names)} and {last}" if names else last
    less = f"the smallest model within {within:.3g} is without {listed}"
    return f"{less}: {model_in_words(smallest.model, units)}; {_changes(smallest, units)}"


def _changes(each: Without, units: GivenUnits | None) -> str:
    """The change by its magnitude, and its error where that is not small beside it."""
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
    """What is said of belt speeds at which the full scene has no one mean."""
    rest = answers[answers["status"] != "ok"]
    if rest.empty:
        return []
    why = commonest_reason(rest)
    if len(rest) == len(answers):
        return [f"the full scene has no one mean to compare with ({why})"]
    where = f"{counted(len(rest), 'belt speed')} of {len(answers)}"
    return [f"left out: {where} at which the full scene has no one mean ({why})"]
