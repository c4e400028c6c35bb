"""What one curve needs: the table of everything taken away, in sentences, and the smallest model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from frictionlab.columns import NEEDS
from frictionlab.least_model.lesser import LesserModel
from frictionlab.least_model.search import Without
from frictionlab.least_model.sentences import missing_means, model_in_words, sentence_of, smallest_in_words


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

    def plot(self) -> Any:
        """A matplotlib figure: bars of the change without each thing, against the tolerance.

        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> figure = fl.needs(scene, fl.Coulomb(mu=0.4)).plot()
        >>> figure.savefig("needs.svg")
        """
        from frictionlab.charts.needs import needs_figure  # with matplotlib, which takes a second

        return needs_figure(self.table)


def needs_from(
    full: LesserModel, answers: pd.DataFrame, rows: Sequence[Without], smallest: Without | None, within: float
) -> Needs:
    """The result for a full model with these answers. rows: what was taken away, the smallest model among them."""
    told = [*missing_means(answers), *map(sentence_of, rows)]
    if (answers["status"] == "ok").any():
        told.append(smallest_in_words(smallest, full, within))
    table = pd.DataFrame([_record(each, within, each is smallest) for each in rows], columns=[*NEEDS])
    least = full if smallest is None or smallest.model is None else smallest.model
    failed = bool(answers["status"].isin(["failed", "killed"]).any())
    return Needs(table, told, least, failed=failed)


def _record(each: Without, within: float, smallest: bool) -> dict[str, Any]:
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
        "model": "" if each.model is None else model_in_words(each.model),
        "reason": found.reason,
    }
