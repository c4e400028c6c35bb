"""The first three sentences of a report, made from small tables of made-up numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pandas as pd

from frictionlab.report.answer import sentences
from frictionlab.report.facts import Facts
from frictionlab.results.expectations import Verdict
from frictionlab.runner.saved import Saved
from frictionlab.study import Study

SPEED = "scene.belt_speed"


def curve(law: str, means: Sequence[float], error: float = 1e-9, **others: Any) -> pd.DataFrame:
    """The rows of a law at belt speeds 1, 2, ...; NaN: refused."""
    return pd.DataFrame(
        [
            {"law": law, "kind": law, "method": "exact", SPEED: float(place), "mean_friction": mean}
            | {"error": math.nan if math.isnan(mean) else error, "error_kind": "estimated"}
            | {"status": "refused" if math.isnan(mean) else "ok", "reason": None}
            | {name.replace("__", "."): value for name, value in others.items()}
            for place, mean in enumerate(means, start=1)
        ]
    )


def told(
    *rows: pd.DataFrame,
    curves: Sequence[dict[str, Any]] = (),
    verdicts: Sequence[bool] = (),
    tolerance: float = 1e-8,
) -> list[str]:
    """The three sentences of a run with these rows."""
    table = pd.concat(rows, ignore_index=True)
    account = {"expect": [{"passed": passed, "sentence": "x"} for passed in verdicts]}
    study = cast("Study", SimpleNamespace(tolerance=tolerance))
    saved = Saved(Path(), study, table, pd.DataFrame(curves) if curves else None, account)
    assert saved.verdicts == [Verdict(passed, "x") for passed in verdicts]
    return [" ".join(str(each.striptags()).split()) for each in sentences(Facts(saved))]


def shape(law: str, verdict: str | None, reason: str | None = None, **others: Any) -> dict[str, Any]:
    """A row of curves.csv."""
    row = {"law": law, "kind": law, "method": "exact", "reversal_end": 50.0, "reversal_end_error": 0.02}
    row |= {"shape_area": 0.0577, "shape_area_error": 2e-4, "shape": verdict, "reason": reason}
    return row | {name.replace("__", "."): value for name, value in others.items()}


# Who is highest where


def test_one_point_is_told_with_its_number_and_its_error() -> None:
    assert told(curve("coulomb", [0.25], error=0.002))[0] == (
        "The mean friction coefficient of coulomb is 0.250 ± 0.002 at vb = 1."
    )


def test_a_curve_that_rises_is_told_by_its_ends() -> None:
    assert told(curve("coulomb", [0.1, 0.2, 0.2, 0.4]))[0] == (
        "Mean friction of coulomb rises from 0.1 at vb = 1 to 0.4 at vb = 4."
    )


def test_two_points_make_a_curve_that_falls() -> None:
    assert told(curve("coulomb", [0.4, 0.1]))[0] == (
        "Mean friction of coulomb falls from 0.4 at vb = 1 to 0.1 at vb = 2."
    )


def test_a_curve_that_turns_is_told_by_its_least_and_greatest() -> None:
    assert told(curve("coulomb", [0.3, 0.1, 0.4, 0.2]))[0] == (
        "Mean friction of coulomb is smallest, 0.1, at vb = 2 and largest, 0.4, at vb = 3."
    )


def test_a_curve_that_is_flat_within_its_errors_is_said_to_be() -> None:
    assert told(curve("coulomb", [0.4, 0.401, 0.4], error=0.01))[0] == (
        "Mean friction of coulomb is the same within its errors at all 3 points: 0.40 ± 0.01."
    )


def test_the_law_that_is_highest_everywhere_is_named_once() -> None:
    assert told(curve("coulomb", [0.1, 0.2], error=2e-3), curve("dahl", [0.15, 0.3], error=2e-3))[0] == (
        "Mean friction is highest for dahl at all 2 belt speeds; the largest distance to the next is 0.100 ± 0.004, "
        "of dahl above coulomb at vb = 2."
    )


def test_laws_that_are_highest_in_turn_have_their_stretches() -> None:
    first = told(curve("coulomb", [0.1, 0.2, 0.3, 0.4, 0.4]), curve("dahl", [0.2, 0.3, 0.2, 0.3, 0.4]))[0]

    assert first.startswith(
        "Mean friction is highest for dahl up to vb = 2 and coulomb from vb = 3 to vb = 4; "
        "at vb = 5 the highest are the same within errors; "
    )


def test_laws_that_change_places_often_are_counted() -> None:
    first = told(
        curve("coulomb", [0.1, 0.2, 0.1, 0.2, 0.1, 0.2, 0.1]),
        curve("dahl", [0.2, 0.1, 0.2, 0.1, 0.2, 0.1, 0.2]),
    )[0]

    assert first.startswith("Mean friction is highest for dahl at 4 of 7 belt speeds and coulomb at 3; ")


def test_laws_that_do_not_differ_by_more_than_their_errors_are_the_same() -> None:
    assert told(curve("coulomb", [0.1, 0.2], error=0.02), curve("dahl", [0.11, 0.19], error=0.02))[0] == (
        "Mean friction is the same within errors for coulomb and dahl at all 2 belt speeds."
    )


def test_of_several_laws_at_one_point_the_highest_has_its_number() -> None:
    assert told(curve("coulomb", [0.1]), curve("dahl", [0.3]), curve("lugre", [0.2]))[0] == (
        "Mean friction is highest for dahl: 0.3, which is 0.1 above lugre, the next."
    )


def test_a_law_without_a_number_somewhere_is_not_ranked_there_and_that_is_said() -> None:
    first = told(
        curve("coulomb", [0.1, 0.2, 0.3]), curve("dahl", [0.2, 0.3, math.nan]), curve("b", [0.0] * 3)
    )[0]

    assert first.startswith(
        "Mean friction is highest for dahl up to vb = 2 and coulomb at vb = 3 (of those with a number); "
    )


def test_of_one_law_the_curves_are_ranked() -> None:
    low, high = (
        curve("coulomb", means, scene__drive__frequency=frequency)
        for means, frequency in (([0.1, 0.2], 1.0), ([0.2, 0.4], 1.5))
    )

    assert told(low, high)[0].startswith(
        "Mean friction of coulomb is highest for Ω = 1.5 at all 2 belt speeds; "
    )


def test_points_of_several_sweeps_are_told_with_all_of_them() -> None:
    both = [
        curve(law, [high * frequency, high], scene__drive__frequency=frequency)
        for law, high in (("coulomb", 0.1), ("dahl", 0.2))
        for frequency in (1.0, 1.5)
    ]

    assert told(*both)[0] == (
        "Mean friction is highest for dahl at all 4 points; the largest distance to the next is 0.15, of dahl above "
        "coulomb at vb = 1, Ω = 1.5."
    )


def test_friction_swept_for_all_laws_together_is_compared_value_by_value() -> None:
    rows = [
        curve("coulomb", [mu, mu], **{"law__mu": mu, "law__mu_kinetic": math.nan}) for mu in (0.1, 0.2)
    ] + [
        curve("stribeck", [mu + 0.01] * 2, **{"law__mu": math.nan, "law__mu_kinetic": mu})
        for mu in (0.1, 0.2)
    ]

    assert told(*rows)[0].startswith("Mean friction is highest for stribeck at all 4 points; ")


def test_methods_of_one_law_that_agree_are_told_with_how_far_their_errors_reach() -> None:
    rough = curve("coulomb", [0.1, 0.3], error=0.05).assign(method="mdsm")

    assert told(curve("coulomb", [0.1, 0.32]), rough)[0].endswith(
        "; exact and mdsm differ most, by 0.020 ± 0.051 at vb = 2, the same within errors."
    )


def test_a_run_without_a_number_says_so_three_times() -> None:
    assert told(curve("coulomb", [math.nan, math.nan])) == [
        "No point has a number.",
        "No curve has two belt speeds, so no shape is read.",
        "Needs attention: 2 of 2 points are refused.",
    ]


def test_a_run_whose_every_point_is_not_unique_has_no_one_mean() -> None:
    rows = curve("stribeck", [math.nan, math.nan]).assign(status="not_unique", mean_low=0.1, mean_high=0.25)

    first, _, third = told(rows)

    assert first == "No point has one mean friction."
    assert third == "Needs attention: 2 of 2 points are not unique, with means from 0.1 to 0.25."


# Shapes


def test_one_curve_is_told_with_its_end_and_its_area() -> None:
    assert told(curve("coulomb", [0.1, 0.2]), curves=[shape("coulomb", "concave")])[1] == (
        "The curve of coulomb is concave (above its chord, the straight line from rest to the end of reversal at "
        "vb = 50.00 ± 0.02; area 0.0577 ± 0.0002)."
    )


def test_curves_that_are_alike_are_told_together() -> None:
    found = [shape(law, "convex") for law in ("coulomb", "dahl", "lugre")]

    assert told(*(curve(law, [0.1, 0.2]) for law in ("coulomb", "dahl", "lugre")), curves=found)[1] == (
        "All 3 curves are convex (below their chords)."
    )


def test_a_few_curves_that_differ_are_named() -> None:
    found = [shape("coulomb", "concave"), shape("dahl", "convex"), shape("lugre", None, "no points")]

    assert told(*(curve(law, [0.1, 0.2]) for law in ("coulomb", "dahl", "lugre")), curves=found)[1] == (
        "The curve of coulomb is concave (above its chord); that of dahl is convex (below its chord); "
        "of 1 curve none is read (no points)."
    )


def test_many_curves_are_counted_and_a_law_that_stands_alone_is_named() -> None:
    frequencies = [float(place) for place in range(1, 6)]
    rows = [
        curve(law, [0.1, 0.2], scene__drive__frequency=each)
        for law in ("coulomb", "dahl")
        for each in frequencies
    ]
    found = [
        shape(law, verdict, **{"scene.drive.frequency": each})
        for law, verdict in (("coulomb", "concave"), ("dahl", "convex"))
        for each in frequencies
    ]

    assert told(*rows, curves=found)[1] == (
        "Of 10 curves 5 are concave (above their chords: coulomb) and 5 convex (below their chords: dahl)."
    )


def test_a_verdict_that_another_method_cannot_decide_stands() -> None:
    found = [shape("coulomb", "undecided") | {"method": "mdsm"}, shape("coulomb", "concave")]

    assert told(curve("coulomb", [0.1, 0.2]), curves=found)[1].startswith("The curve of coulomb is concave (")


def test_why_no_shape_is_read_is_told_by_the_commonest_reason() -> None:
    found = [
        shape(law, None, reason) for law, reason in (("a", "3 points"), ("b", "4 points"), ("c", "sticks"))
    ]

    assert told(*(curve(law, [0.1, 0.2]) for law in "abc"), curves=found)[1] == (
        "No shape is read: 3 points (and 1 more that differ in the numbers); 1 curve for other reasons."
    )


def test_a_scene_in_si_units_has_its_end_of_reversal_in_them() -> None:
    rows = curve("coulomb", [0.1, 0.2]).assign(**{"scene.dimensional.belt_speed_m_per_s": [0.25, 0.5]})
    first, second, _ = told(rows, curves=[shape("coulomb", "concave")])

    assert first.endswith("rises from 0.1 at Vb = 0.25 m/s to 0.2 at Vb = 0.5 m/s.")
    assert "at Vb = 12.500 ± 0.005 m/s;" in second


# What needs attention


def test_that_nothing_needs_attention_is_said_with_what_was_looked_at() -> None:
    assert told(curve("coulomb", [0.1, 0.2]), verdicts=[True, True])[2] == (
        "Nothing needs attention: all 2 points are ok, with no error above the tolerance of 1e-08, "
        "and both expectations hold."
    )


def test_points_without_an_answer_are_told_with_whose_they_are() -> None:
    rows = curve("dahl", [0.1, math.nan, 0.3]).assign(mean_low=[0.0731, math.nan, math.nan], mean_high=0.366)
    rows.loc[0, ["status", "mean_friction"]] = ["not_unique", math.nan]

    assert told(curve("coulomb", [0.1, 0.2, 0.3]), rows)[2] == (
        "Needs attention: 1 of 6 points is not unique (dahl), with means from 0.0731 to 0.366; "
        "1 of 6 points is refused (dahl)."
    )


def test_a_law_without_a_number_anywhere_is_named() -> None:
    assert told(curve("coulomb", [0.1, 0.2]), curve("dahl", [math.nan] * 2))[0] == (
        "Mean friction of coulomb rises from 0.1 at vb = 1 to 0.2 at vb = 2; dahl has no number."
    )


def test_errors_above_the_tolerance_and_expectations_that_failed_need_attention() -> None:
    rough = curve("coulomb", [0.1, 0.3], error=0.05).assign(method="mdsm")

    assert told(curve("coulomb", [0.1, 0.3]), rough, verdicts=[True, False])[2] == (
        "Needs attention: the error exceeds the tolerance of 1e-08 at 2 points, up to 0.05 (by mdsm); "
        "1 of 2 expectations FAILED."
    )


def test_points_that_an_interruption_left_are_told_first() -> None:
    rows = curve("coulomb", [math.nan, math.nan, 0.3])
    rows.loc[0, "status"] = "killed"

    assert told(rows)[2] == (
        "Needs attention: 1 of 3 points was not reached, as the run was interrupted; 1 of 3 points is refused."
    )


def test_a_remark_on_a_point_that_is_ok_needs_attention() -> None:
    rows = curve("coulomb", [0.1, 0.2])
    rows["reason"] = ["tested: 2 starts ended here", "still changes a little"]

    assert told(rows)[2] == "Needs attention: 1 point carries a remark."
