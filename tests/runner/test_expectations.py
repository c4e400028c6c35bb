"""What a study expects, judged against a table."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from frictionlab.runner.expectations import judge
from frictionlab.study.parts import Expectation

TABLE = pd.DataFrame(
    {
        "law": ["coulomb"] * 4,
        "kind": ["coulomb"] * 4,
        "method": ["exact", "shooting"] * 2,
        "scene.belt_speed": [0.3, 0.3, 2.0, 2.0],
        "scene.transverse.natural_frequency": [np.nan] * 4,
        "law.mu": [0.4] * 4,
        "mean_friction": [0.1, 0.1 + 1e-9, 0.2, np.nan],
        "status": ["ok", "ok", "ok", "refused"],
        "reason": ["", "", "", "needs damping"],
    }
)
SLOW = {"scene.belt_speed": 0.1 + 0.2}
FAST = {"scene.belt_speed": 2.0}


@pytest.mark.parametrize(
    ("where", "claim", "passed"),
    [
        (SLOW, {"column": "mean_friction", "equals": 0.1, "within": 1e-6}, True),
        (SLOW, {"column": "mean_friction", "equals": 0.1, "within": 1e-10}, False),
        (SLOW, {"column": "mean_friction", "equals": -0.1, "within": 1e-6}, False),
        (SLOW, {"column": "mean_friction", "below": 0.11}, True),
        (SLOW, {"column": "mean_friction", "below": 0.1}, False),
        (SLOW, {"column": "mean_friction", "below": 0.1, "within": 1e-6}, True),
        (SLOW, {"column": "mean_friction", "above": 0.09}, True),
        (SLOW, {"column": "mean_friction", "above": 0.1 + 5e-10}, False),
        (SLOW, {"column": "mean_friction", "above": 0.1 + 5e-10, "within": 1e-9}, True),
        (FAST, {"column": "mean_friction", "above": 0.0}, False),
        (SLOW, {"column": "period_s", "equals": 1.0, "within": 1e-3}, False),  # steady sliding has none
        (FAST | {"method": "exact"}, {"column": "mean_friction", "above": 0.0}, True),
        (SLOW, {"status": "ok"}, True),
        (FAST, {"status": "ok"}, False),
        (FAST | {"method": "shooting"}, {"status": "refused"}, True),
        (SLOW, {"max_difference": ("exact", "shooting"), "below": 2e-9}, True),
        (SLOW, {"max_difference": ("exact", "shooting"), "below": 1e-10}, False),
        (SLOW, {"max_difference": ("shooting", "exact"), "below": 1e-10}, False),
        (FAST, {"max_difference": ("exact", "shooting"), "below": 1.0}, False),
        ({}, {"max_difference": ("exact", "shooting"), "below": 1.0}, False),
        (SLOW | {"method": "exact"}, {"max_difference": ("exact", "shooting"), "below": 1.0}, False),
    ],
)
def test_an_expectation_holds_or_fails_for_all_its_rows(
    where: dict[str, Any], claim: dict[str, Any], passed: bool
) -> None:
    assert judge(Expectation(where=where, **claim), TABLE, CURVES).passed is passed


@pytest.mark.parametrize(
    "claim",
    [
        {"column": "mean_friction", "below": 9.0},
        {"status": "ok"},
        {"max_difference": ("exact", "shooting"), "below": 9.0},
    ],
)
@pytest.mark.parametrize(
    "where",
    [
        {"law": "dahl"},
        {"scene.belt_speed": 0.3 * (1 + 1e-8)},
        {"scene.transverse.natural_frequency": 1.0},
        {"scene.slip.frequency": 1.0},
    ],
)
def test_an_expectation_of_rows_that_are_not_there_fails_and_says_so(
    claim: dict[str, Any], where: dict[str, Any]
) -> None:
    verdict = judge(Expectation(where=where, **claim), TABLE, CURVES)

    assert not verdict.passed
    assert "no row of the table matches" in verdict.sentence


def test_the_sentence_says_what_was_claimed_where_why_and_what_was_found() -> None:
    claim = Expectation(
        where=SLOW, column="mean_friction", equals=0.25, within=1e-3, because="Fig. 9b", below=None
    )

    assert judge(claim, TABLE, CURVES).sentence == (
        "mean_friction equals 0.25 within 0.001 where scene.belt_speed 0.3 (Fig. 9b): "
        "0.1 in the worst of 2 rows, that of coulomb by exact at belt speed 0.3"
    )


def test_the_verdict_on_one_row_gives_its_number_alone() -> None:
    found = judge(Expectation(where={}, column="mean_friction", below=1.0), TABLE.iloc[:1], CURVES).sentence

    assert found == "mean_friction below 1 everywhere: 0.1"


def test_an_empty_cell_is_told_with_the_reason_of_its_row() -> None:
    verdict = judge(Expectation(where=FAST, column="mean_friction", above=0.0), TABLE, CURVES)

    assert verdict.sentence.endswith(
        "mean_friction is empty in the row of coulomb by shooting at belt speed 2, refused: needs damping"
    )


CURVES = pd.DataFrame(
    {
        "law": ["coulomb"] * 3,
        "method": ["exact", "shooting", "march"],
        "shape": ["convex", "concave", None],
        "shape_area": [-0.2, 0.1, np.nan],
        "shape_area_error": [1e-3, 2e-3, np.nan],
        "shape_by_initial": ["concave", "concave", None],
        "shape_initial": [-0.5, -2.0, np.nan],
        "shape_initial_error": [1e-3, 0.25, np.nan],
        "reason": [None, None, "slip still reverses at the highest belt speed that has a number, 2"],
    }
)


@pytest.mark.parametrize(
    ("where", "claim", "passed", "found"),
    [
        ({"method": "exact"}, {"shape": "convex"}, True, "convex, -0.200 +- 0.001"),
        ({"method": "shooting"}, {"shape": "convex"}, False, "concave, 0.100 +- 0.002"),
        ({"method": "exact"}, {"shape": "concave", "measure": "initial"}, True, "concave, -0.500 +- 0.001"),
        (
            {"method": "march"},
            {"shape": "convex"},
            False,
            "slip still reverses at the highest belt speed that has a number, 2",
        ),
        (
            {},
            {"shape": "convex"},
            False,
            "concave, 0.100 +- 0.002 in the first of 2 of 3 curves, of coulomb by shooting",
        ),
        ({"law": "dahl"}, {"shape": "convex"}, False, "no row of the table matches"),
    ],
)
def test_a_shape_holds_or_fails_for_all_its_curves_and_says_by_how_much(
    where: dict[str, Any], claim: dict[str, Any], passed: bool, found: str
) -> None:
    verdict = judge(Expectation(where=where, because="Fig. 4", **claim), TABLE, CURVES)

    by = "initial curvature" if "measure" in claim else "area"
    assert verdict.passed is passed
    assert verdict.sentence.startswith(f"{claim['shape']} by {by} ")
    assert verdict.sentence.endswith(f"(Fig. 4): {found}")


@pytest.mark.parametrize("table", [TABLE, TABLE.iloc[:3]])
def test_a_missing_partner_fails_and_is_told(table: pd.DataFrame) -> None:
    verdict = judge(Expectation(where={}, max_difference=("exact", "shooting"), below=1.0), table, CURVES)

    assert not verdict.passed
    assert "mean_friction is missing in 1 of 2 pairs" in verdict.sentence


LAWS = pd.DataFrame(
    {
        "law": ["coulomb", "coulomb", "dahl", "dahl", "dahl", "dahl"],
        "kind": ["coulomb", "coulomb", "dahl", "dahl", "dahl", "dahl"],
        "method": ["auto"] * 6,
        "scene.belt_speed": [1.0, 2.0] * 3,
        "law.mu": [0.4] * 6,
        "law.presliding_length": [np.nan, np.nan, 1.0, 1.0, 10.0, 10.0],
        "mean_friction": [0.1, 0.2, 0.12, 0.21, 0.3, 0.15],
        "status": ["ok"] * 6,
        "reason": [""] * 6,
    }
)
WORST = "-0.05 in the worst of 4 rows, that of dahl by auto at belt speed 2, law.presliding_length 10"
COULOMB = {"law": "coulomb"}
STIFF = {"law": "dahl", "law.presliding_length": 1.0}
SOFT = {"law": "dahl", "law.presliding_length": 10.0}


@pytest.mark.parametrize(
    ("where", "claim", "passed", "found"),
    [
        ({"law": "dahl"}, {"minus": COULOMB, "above": -0.06}, True, "-0.05 in the worst of 4 rows"),
        ({"law": "dahl"}, {"minus": COULOMB, "above": 0.0}, False, WORST),
        (STIFF | {"scene.belt_speed": 1.0}, {"over": COULOMB, "above": 1.19}, True, "1.2"),
        (STIFF | {"scene.belt_speed": 1.0}, {"over": COULOMB, "above": 1.21}, False, "1.2"),
        (SOFT | {"scene.belt_speed": {"from": 2.0}}, {"minus": COULOMB, "below": 0.0}, True, "-0.05"),
        (SOFT | {"scene.belt_speed": {"to": 1.9}}, {"minus": COULOMB, "below": 0.0}, False, "0.2"),
        (
            SOFT | {"scene.belt_speed": [1.0, 2.0]},
            {"minus": STIFF, "above": 0.0},
            False,
            "-0.06 in the worst of 2 rows, that of dahl by auto at belt speed 2",
        ),
        # those that are subtracted are not compared with themselves
        ({}, {"minus": COULOMB, "above": -0.06}, True, "-0.05 in the worst of 4 rows"),
        (
            COULOMB,
            {"minus": COULOMB, "above": -1.0},
            False,
            "no row of the table matches law coulomb, or none beside it",
        ),
        (
            STIFF,
            {"minus": {"law": "lugre"}, "above": -1.0},
            False,
            "no row of the table matches law lugre, or none beside it",
        ),
        # those of another law do not tell what is missing beside Coulomb friction
        (
            {},
            {"minus": {"law.presliding_length": 1.0}, "above": -1.0},
            False,
            "is missing in 2 of 4 pairs of rows",
        ),
    ],
)
def test_rows_are_compared_with_those_of_other_inputs(
    where: dict[str, Any], claim: dict[str, Any], passed: bool, found: str
) -> None:
    verdict = judge(Expectation(where=where, column="mean_friction", **claim), LAWS, CURVES)

    assert verdict.passed is passed
    assert verdict.sentence.endswith(found)


@pytest.mark.parametrize(
    ("where", "claim", "passed", "found"),
    [
        ({"method": "exact"}, {"below": -0.1}, True, "shape_area below -0.1 where method exact: -0.2"),
        ({"method": ["exact", "shooting"]}, {"below": 0.0}, False, "0.1 in the worst of 2 rows"),
        ({"method": "march"}, {"below": 0.0}, False, "coulomb by march: slip still reverses"),
        (
            {"method": "shooting"},
            {"minus": {"method": "exact"}, "above": 0.29},
            True,
            "method exact above 0.29",
        ),
    ],
)
def test_a_measure_of_curves_is_compared_as_a_column_is(
    where: dict[str, Any], claim: dict[str, Any], passed: bool, found: str
) -> None:
    verdict = judge(Expectation(where=where, column="shape_area", **claim), TABLE, CURVES)

    assert verdict.passed is passed
    assert found in verdict.sentence


def test_curves_in_si_units_are_compared_at_inputs_as_given() -> None:
    curves = pd.DataFrame(
        {
            "law": ["coulomb"] * 2,
            "method": ["auto"] * 2,
            "scene.drive.frequency": [1.0, 2.0],
            "scene.dimensional.drive.frequency_rad_per_s": [10.0, 20.0],
            "shape_area": [0.1, -0.2],
        }
    )
    slow = {"scene.dimensional.drive.frequency_rad_per_s": 10.0}

    assert judge(Expectation(where={}, minus=slow, column="shape_area", below=-0.29), TABLE, curves).passed
