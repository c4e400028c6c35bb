"""The first three sentences of a report, made from small tables of made-up numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any, cast

import pandas as pd
import pytest
from profiles import some

import frictionlab as fl
from frictionlab.charts.figures import FigureData
from frictionlab.report.answer import sentences
from frictionlab.report.facts import Facts
from frictionlab.runner.expectations import Verdict
from frictionlab.runner.table import status_counts
from frictionlab.study.study import Study

SPEED, FREQUENCY = "scene.belt_speed", "scene.drive.frequency"
NONE = math.nan
IN_WORDS = {"law": {"coulomb": "Coulomb"}, "method": {"exact": "exact", "mdsm": "closed form"}}
HIGHEST = "Mean friction is highest for "


def curve(law: str, means: Sequence[float], error: float = 1e-9, **others: Any) -> pd.DataFrame:
    """The rows of a law at belt speeds 1, 2, ...; NaN: refused."""
    return pd.DataFrame(
        [
            {"law": law, "kind": law, "method": "exact", SPEED: float(place), "mean_friction": mean}
            | {"error": math.nan if math.isnan(mean) else error, "error_kind": "estimated"}
            | {"status": "refused" if math.isnan(mean) else "ok", "reason": None}
            | others
            for place, mean in enumerate(means, start=1)
        ]
    )


def told(
    *rows: pd.DataFrame, curves: Sequence[dict[str, Any]] = (), verdicts: Sequence[bool] = ()
) -> list[str]:
    """The three sentences of a run with these rows."""
    table = pd.concat(rows, ignore_index=True)
    methods = [SimpleNamespace(label=name, is_reduced=name == "mdsm") for name in ("exact", "mdsm")]
    study = cast("Study", SimpleNamespace(tolerance=1e-8, units={}, methods=methods, in_words=IN_WORDS))
    readers = {"table": lambda: table, "curves": lambda: pd.DataFrame(curves)}
    judged = tuple(Verdict(passed, "x") for passed in verdicts)
    saved = fl.Run(study, readers, status_counts(table), judged)
    drawn = cast("FigureData", SimpleNamespace(reference="Coulomb"))
    return [" ".join(str(each.striptags()).split()) for each in sentences(Facts(saved, drawn))]


def shape(law: str, verdict: str | None, reason: str | None = None, **others: Any) -> dict[str, Any]:
    """A row of curves.csv."""
    row = {"law": law, "kind": law, "method": "exact", "reversal_end": 50.0, "reversal_end_error": 0.02}
    row |= {"shape_area": 0.0577, "shape_area_error": 2e-4, "shape": verdict, "reason": reason}
    return row | others


ROUGH = [curve("coulomb", [0.1, 0.32]), curve("coulomb", [0.1, 0.3], error=0.05).assign(method="mdsm")]

WHO_IS_HIGHEST_WHERE: dict[str, list[pd.DataFrame]] = {
    # one point is told with its number and its error
    "The mean friction coefficient of Coulomb is 0.250 ± 0.002 at vb = 1.": [
        curve("coulomb", [0.25], error=0.002)
    ],
    # a curve that rises is told by its ends
    "Mean friction of Coulomb rises from 0.1 at vb = 1 to 0.4 at vb = 4.": [
        curve("coulomb", [0.1, 0.2, 0.2, 0.4])
    ],
    # two points make a curve that falls
    "Mean friction of Coulomb falls from 0.4 at vb = 1 to 0.1 at vb = 2.": [curve("coulomb", [0.4, 0.1])],
    # a curve that turns is told by its least and greatest
    "Mean friction of Coulomb is smallest, 0.1, at vb = 2 and largest, 0.4, at vb = 3.": [
        curve("coulomb", [0.3, 0.1, 0.4, 0.2])
    ],
    # a curve that is flat within its errors is said to be
    "Mean friction of Coulomb is the same within its errors at all 3 points: 0.40 ± 0.01.": [
        curve("coulomb", [0.4, 0.401, 0.4], error=0.01)
    ],
    # a law without a number anywhere is named
    "Mean friction of Coulomb rises from 0.1 at vb = 1 to 0.2 at vb = 2; dahl has no number.": [
        curve("coulomb", [0.1, 0.2]),
        curve("dahl", [NONE] * 2),
    ],
    # the law that is highest everywhere is named once
    f"{HIGHEST}dahl at all 2 belt speeds; dahl is up to 0.100 ± 0.004 above Coulomb, at vb = 2.": [
        curve("coulomb", [0.1, 0.2], error=2e-3),
        curve("dahl", [0.15, 0.3], error=2e-3),
    ],
    # laws that are highest in turn have their stretches
    (
        f"{HIGHEST}dahl up to vb = 2 and Coulomb from vb = 3 to vb = 4; "
        "at vb = 5 the highest are the same within errors; ..."
    ): [curve("coulomb", [0.1, 0.2, 0.3, 0.4, 0.4]), curve("dahl", [0.2, 0.3, 0.2, 0.3, 0.4])],
    # of laws that change places often the largest distance is told
    "No law is highest everywhere: dahl is up to 0.1 above Coulomb, at vb = 1.": [
        curve("coulomb", [0.1, 0.2, 0.1, 0.2, 0.1, 0.2, 0.1]),
        curve("dahl", [0.2, 0.1, 0.2, 0.1, 0.2, 0.1, 0.2]),
    ],
    # of several laws that change places the one furthest from the reference law is told
    "No law is highest everywhere; furthest from Coulomb: lugre is up to 0.2 above Coulomb, at vb = 1.": [
        curve("coulomb", [0.1, 0.2, 0.1, 0.2, 0.1, 0.2]),
        curve("dahl", [0.2, 0.1, 0.2, 0.1, 0.2, 0.1]),
        curve("lugre", [0.3, 0.1, 0.1, 0.05, 0.1, 0.1]),
    ],
    # whoever is furthest at several settings is named once
    (
        "No law is highest everywhere; furthest from Coulomb: "
        "Coulomb is up to 0.3 above dahl, at vb = 2, Ω = 1; 0.6 at vb = 2, Ω = 2."
    ): [
        curve(law, [each * share for each in means], **{FREQUENCY: share})
        for share in (1.0, 2.0)
        for law, means in {"coulomb": [0.1, 0.4] * 3, "dahl": [0.3, 0.1] * 3, "b": [0.2] * 6}.items()
    ],
    # laws that do not differ by more than their errors are the same
    "Mean friction is the same within errors for Coulomb and dahl at all 2 belt speeds.": [
        curve("coulomb", [0.1, 0.2], error=0.02),
        curve("dahl", [0.11, 0.19], error=0.02),
    ],
    # of several laws at one point the highest has its number
    f"{HIGHEST}dahl: 0.3, which is 0.1 above lugre, the next.": [
        curve("coulomb", [0.1]),
        curve("dahl", [0.3]),
        curve("lugre", [0.2]),
    ],
    # a law without a number somewhere is not ranked there and that is said
    f"{HIGHEST}dahl up to vb = 2 and Coulomb at vb = 3 (of those with a number); ...": [
        curve("coulomb", [0.1, 0.2, 0.3]),
        curve("dahl", [0.2, 0.3, NONE]),
        curve("b", [0.0] * 3),
    ],
    # of one law the curves are ranked
    "Mean friction of Coulomb is highest for Ω = 1.5 at all 2 belt speeds; ...": [
        curve("coulomb", [0.1, 0.2], **{FREQUENCY: 1.0}),
        curve("coulomb", [0.2, 0.4], **{FREQUENCY: 1.5}),
    ],
    # points of several sweeps are told with all of them
    f"{HIGHEST}dahl at all 4 points; dahl is up to 0.15 above Coulomb, at vb = 1, Ω = 1.5.": [
        curve(law, [high * frequency, high], **{FREQUENCY: frequency})
        for law, high in (("coulomb", 0.1), ("dahl", 0.2))
        for frequency in (1.0, 1.5)
    ],
    # friction swept for all laws together is compared value by value
    f"{HIGHEST}stribeck at all 4 points; ...": [
        curve("coulomb", [mu, mu], **{"law.mu": mu, "law.mu_kinetic": NONE}) for mu in (0.1, 0.2)
    ]
    + [curve("stribeck", [mu + 0.01] * 2, **{"law.mu": NONE, "law.mu_kinetic": mu}) for mu in (0.1, 0.2)],
    # laws that change places have the largest distance of each setting
    (
        "No law is highest everywhere: Coulomb is up to 0.2 above dahl, at vb = 2, Ω = 1; "
        "dahl is up to 0.2 above Coulomb, at vb = 1, Ω = 1.5."
    ): [
        curve(law, means, **{FREQUENCY: frequency})
        for frequency, own in ((1.0, ([0.1, 0.3], [0.2, 0.1])), (1.5, ([0.1, 0.2], [0.3, 0.1])))
        for law, means in zip(("coulomb", "dahl"), own, strict=True)
    ],
    # a mean that changes its sign does so between neighbours
    "...rises from \N{MINUS SIGN}0.1 at vb = 1 to 0.2 at vb = 3, through zero between vb = 2 and vb = 3.": [
        curve("coulomb", [-0.1, -0.05, 0.2])
    ],
    # a reduced model is judged by the full answers beside it
    "The closed form is up to 0.02 too low, at vb = 2.": ROUGH,
    # a reduced model is judged at each setting
    "At Ω = 1 the closed form is up to 0.2 too low (vb = 2), at Ω = 1.5 up to 0.3 too high (vb = 2).": [
        curve("coulomb", [0.1, 0.3 + off], error=error, **{FREQUENCY: frequency, "method": method})
        for frequency in (1.0, 1.5)
        for method, off, error in (("mdsm", frequency - 1.2, 0.5), ("exact", 0.0, 1e-9))
    ],
    # a reduced model alone is told with its own error
    "...at vb = 1 to 0.30 ± 0.05 at vb = 2; the closed form is off by at most 0.05, at vb = 1.": ROUGH[1:],
}


@some(8, "answers of every kind")
@pytest.mark.parametrize("wanted", WHO_IS_HIGHEST_WHERE)
def test_the_first_sentence_says_who_is_highest_where(wanted: str) -> None:
    first = told(*WHO_IS_HIGHEST_WHERE[wanted])[0]

    assert re.fullmatch(re.sub(r"^\\\.\\\.\\\.|\\\.\\\.\\\.$", ".*", re.escape(wanted)), first)


def test_a_run_without_a_number_says_so_three_times() -> None:
    assert told(curve("coulomb", [NONE, NONE])) == [
        "No point has a number.",
        "No curve has two belt speeds, so none has a shape.",
        "Needs attention: 2 of 2 points are refused.",
    ]


def test_a_run_whose_every_point_is_not_unique_has_no_one_mean() -> None:
    rows = curve("stribeck", [NONE, NONE]).assign(status="not_unique", mean_low=0.1, mean_high=0.25)

    first, _, third = told(rows)

    assert first == "No point has one mean friction."
    assert third == "Needs attention: 2 of 2 points are not unique, with means from 0.1 to 0.25."


# Shapes

FREQUENCIES = [float(place) for place in range(1, 6)]
STOPS = "Slip stops reversing at vb = 50.00 ± 0.02."
SHAPES: dict[str, list[dict[str, Any]]] = {
    # one curve is told with its end and its area
    f"The curve of Coulomb is concave (above its chord, by 0.0577 ± 0.0002 of the area under it). {STOPS}": [
        shape("coulomb", "concave")
    ],
    # an end known to more than itself is not told
    (
        "The curve of Coulomb is concave (above its chord, by 0.0577 ± 0.0002 of the area under it). "
        "Where slip stops reversing is left open by errors."
    ): [shape("coulomb", "concave", reversal_end=12.0, reversal_end_error=27.0)],
    # curves that are alike are told together
    f"All 3 curves are convex (below their chords). {STOPS}": [
        shape(law, "convex") for law in ("coulomb", "dahl", "lugre")
    ],
    # curves that are not all are counted
    f"2 curves are concave (above their chords); 1 curve has no shape (no points). {STOPS}": [
        shape("coulomb", "concave"),
        shape("dahl", "concave"),
        shape("lugre", None, "no points"),
    ],
    # a few curves that differ are named
    (
        "The curve of Coulomb is concave (above its chord); that of dahl is convex (below its chord); "
        "1 curve has no shape (no points). Slip stops reversing at vb from 40 to 50."
    ): [
        shape("coulomb", "concave", reversal_end=40.0),
        shape("dahl", "convex"),
        shape("lugre", None, "no points"),
    ],
    # many curves are told by what parts their shapes
    f"Curves for Coulomb: all concave (above their chords); for dahl: all convex (below their chords). {STOPS}": [
        shape("coulomb", "concave", **{FREQUENCY: each}) for each in FREQUENCIES
    ]
    + [shape("dahl", "convex", **{FREQUENCY: each}) for each in FREQUENCIES],
    # many curves whose shapes nothing parts are counted
    f"Of 8 curves 7 are concave (above their chords) and 1 convex (below its chord: Ω = 3). {STOPS}": [
        shape("coulomb", "convex" if each == 3 else "concave", **{FREQUENCY: each})
        for each in map(float, range(1, 9))
    ],
    # why no curve has a shape is told by the commonest reason
    "No curve has a shape: 3 ... 4 points; 1 curve for other reasons.": [
        shape("coulomb", None, "3 points"),
        shape("dahl", None, "4 points"),
        shape("lugre", None, "sticks"),
    ],
}


@pytest.mark.parametrize("wanted", SHAPES)
def test_the_second_sentence_says_which_curves_are_concave(wanted: str) -> None:
    found = SHAPES[wanted]
    swept = pd.DataFrame(found).reindex(columns=["law", FREQUENCY]).dropna(axis="columns")
    rows = [curve(each.pop("law"), [0.1, 0.2], **each) for each in swept.to_dict("records")]

    assert told(*rows, curves=found)[1] == wanted


def test_a_verdict_that_another_method_cannot_decide_stands() -> None:
    found = [shape("coulomb", "undecided", method="mdsm"), shape("coulomb", "concave")]

    assert told(curve("coulomb", [0.1, 0.2]), curves=found)[1].startswith("The curve of Coulomb is concave (")


def test_a_reduced_model_has_its_own_shape_beside_the_true_one() -> None:
    found = [shape("coulomb", "convex", method="mdsm"), shape("coulomb", "concave")]

    second = told(*ROUGH, curves=found)[1]
    assert second.startswith("The curve of Coulomb is concave (")
    assert second.endswith(f"; by the closed form it is convex. {STOPS}")


def test_a_scene_in_si_units_has_its_end_of_reversal_in_them() -> None:
    rows = curve("coulomb", [0.1, 0.2]).assign(**{"scene.dimensional.belt_speed_m_per_s": [0.25, 0.5]})
    first, second, _ = told(rows, curves=[shape("coulomb", "concave")])

    assert first.endswith("rises from 0.1 at Vb = 0.25 m/s to 0.2 at Vb = 0.5 m/s.")
    assert "at Vb = 12.500 ± 0.005 m/s." in second


# What needs attention


def test_that_nothing_needs_attention_is_said_with_what_was_looked_at() -> None:
    assert told(curve("coulomb", [0.1, 0.2]), verdicts=[True, True])[2] == (
        "Nothing needs attention: all 2 points are ok, with errors of at most 1.0e-09, "
        "and both expectations hold."
    )


def test_errors_above_the_tolerance_and_expectations_that_failed_need_attention() -> None:
    rough = curve("dahl", [0.1, 0.2], error=0.05)
    assert told(*ROUGH, rough, verdicts=[True, False])[2] == (
        "Needs attention: the error exceeds the tolerance of 1e-08 at 2 points, up to 0.05 (dahl, by exact); "
        "1 of 2 expectations FAILED."
    )


def test_the_own_error_of_a_reduced_model_needs_no_attention() -> None:
    assert told(*ROUGH)[2] == (
        "Nothing needs attention: all 4 points are ok, with errors of at most 1.0e-09 "
        "but for what the models leave out."
    )


def test_points_without_an_answer_are_told_with_whose_they_are() -> None:
    rows = curve("dahl", [0.1, NONE, 0.3]).assign(mean_low=[0.0731, NONE, NONE], mean_high=0.366)
    rows.loc[0, ["status", "mean_friction"]] = ["not_unique", NONE]

    assert told(curve("coulomb", [0.1, 0.2, 0.3]), rows)[2] == (
        "Needs attention: 1 of 6 points is not unique (dahl), with means from 0.0731 to 0.366; "
        "1 of 6 points is refused (dahl)."
    )


def test_points_that_an_interruption_left_are_told_first() -> None:
    rows = curve("coulomb", [NONE, NONE, 0.3])
    rows.loc[0, "status"] = "killed"

    assert told(rows)[2] == (
        "Needs attention: 1 of 3 points was not reached, as the run was interrupted; 1 of 3 points is refused."
    )


def test_a_remark_on_a_point_that_is_ok_needs_attention() -> None:
    rows = curve("coulomb", [0.1, 0.2])
    rows["reason"] = ["tested: 2 starts ended here", "still changes a little"]

    assert told(rows)[2] == "Needs attention: 1 point carries a remark."


def test_places_have_four_digits_in_sentences() -> None:
    first, *_ = told(curve("coulomb", [0.1, 0.2]).assign(**{SPEED: [517.947, 719.686]}))

    assert "vb = 517.9" in first
    assert "vb = 719.7" in first
