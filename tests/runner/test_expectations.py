"""What a study expects, judged against a table."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from frictionlab.runner.expectations import Verdict, judge
from frictionlab.study.expectations import Expectation

SPEED, LENGTH, MEAN = "scene.belt_speed", "law.presliding_length", "mean_friction"
TABLE = pd.DataFrame(
    {
        "law": ["coulomb"] * 4,
        "kind": ["coulomb"] * 4,
        "method": ["exact", "shooting"] * 2,
        SPEED: [0.3, 0.3, 2.0, 2.0],
        "scene.transverse.natural_frequency": [np.nan] * 4,
        "law.mu": [0.4] * 4,
        MEAN: [0.1, 0.1 + 1e-9, 0.2, np.nan],
        "status": ["ok", "ok", "ok", "refused"],
        "reason": ["", "", "", "needs damping"],
    }
)
NO_END = "slip still reverses at the highest belt speed that has a number, 2"
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
        "reason": [None, None, NO_END],
    }
)
LAWS = pd.DataFrame(
    {
        "law": ["coulomb"] * 2 + ["dahl"] * 4,
        "kind": ["coulomb"] * 2 + ["dahl"] * 4,
        "method": ["auto"] * 6,
        SPEED: [1.0, 2.0] * 3,
        "law.mu": [0.4] * 6,
        LENGTH: [np.nan, np.nan, 1.0, 1.0, 10.0, 10.0],
        MEAN: [0.1, 0.2, 0.12, 0.21, 0.3, 0.15],
        "status": ["ok"] * 6,
        "reason": [""] * 6,
    }
)
SLOW, FAST = {SPEED: 0.1 + 0.2}, {SPEED: 2.0}
EXACT, SHOOTING, MARCH = ({"method": name} for name in ("exact", "shooting", "march"))
COULOMB, DAHL = {"law": "coulomb"}, {"law": "dahl"}
STIFF, SOFT = (DAHL | {LENGTH: length} for length in (1.0, 10.0))
BOTH, TURNED = {"max_difference": ("exact", "shooting")}, {"max_difference": ("shooting", "exact")}
CONVEX, AREA, LESS = {"shape": "convex"}, {"column": "shape_area"}, {"minus": COULOMB}
FULL, BY_AREA, OF_TWO = {"method": ["exact", "shooting"]}, "convex by area where", " in the worst of 2 rows"
WORST = "-0.05 in the worst of 4 rows"
NONE = "no row of the table matches"
MISSING = (
    "|exact - shooting| of mean_friction below 1 everywhere: mean_friction is missing in 1 of 2 pairs of rows"
)
EQUALS = (
    "mean_friction equals 0.25 within 0.001 where scene.belt_speed 0.3 (Fig. 9b): "
    "0.1 in the worst of 2 rows, that of coulomb by exact at belt speed 0.3"
)
EMPTY = (
    "mean_friction above 0 where scene.belt_speed 2: "
    "mean_friction is empty in the row of coulomb by shooting at belt speed 2, refused: needs damping"
)
OF_DAHL = "that of dahl by auto at belt speed 2"


def verdict(where: dict[str, Any], claim: dict[str, Any], table: pd.DataFrame = TABLE) -> Verdict:
    """Return the verdict on a claim of a mean, where it is of nothing else."""
    of = {} if {"status", "shape", "max_difference", "column"} & {*claim} else {"column": MEAN}
    return judge(Expectation(where=where, **of, **claim), table, CURVES)


@pytest.mark.parametrize(
    ("where", "claim", "passed"),
    [
        (SLOW, {"equals": 0.1, "within": 1e-6}, True),
        (SLOW, {"equals": 0.1, "within": 1e-10}, False),
        (SLOW, {"equals": -0.1, "within": 1e-6}, False),
        (SLOW, {"below": 0.11}, True),
        (SLOW, {"below": 0.1}, False),
        (SLOW, {"below": 0.1, "within": 1e-6}, True),
        (SLOW, {"above": 0.09}, True),
        (SLOW, {"above": 0.1 + 5e-10}, False),
        (SLOW, {"above": 0.1 + 5e-10, "within": 1e-9}, True),
        (FAST, {"above": 0.0}, False),
        (SLOW, {"column": "period_s", "equals": 1.0, "within": 1e-3}, False),  # steady sliding has none
        (FAST | EXACT, {"above": 0.0}, True),
        (SLOW, {"status": "ok"}, True),
        (FAST, {"status": "ok"}, False),
        (FAST | SHOOTING, {"status": "refused"}, True),
        (SLOW, BOTH | {"below": 2e-9}, True),
        (SLOW, BOTH | {"below": 1e-10}, False),
        (SLOW, TURNED | {"below": 1e-10}, False),
        (FAST, BOTH | {"below": 1.0}, False),
        (SLOW | EXACT, BOTH | {"below": 1.0}, False),
    ],
)
def test_an_expectation_holds_or_fails_for_all_its_rows(
    where: dict[str, Any], claim: dict[str, Any], passed: bool
) -> None:
    assert verdict(where, claim).passed is passed


@pytest.mark.parametrize("claim", [{"below": 9.0}, {"status": "ok"}, BOTH | {"below": 9.0}, CONVEX])
@pytest.mark.parametrize(
    "column", ["law", SPEED, "scene.transverse.natural_frequency", "scene.slip.frequency"]
)
def test_an_expectation_of_rows_that_are_not_there_fails_and_says_so(
    claim: dict[str, Any], column: str
) -> None:
    found = verdict({column: "dahl" if column == "law" else 0.3 * (1 + 1e-8)}, claim)

    assert not found.passed
    assert NONE in found.sentence


@pytest.mark.parametrize(
    ("where", "claim", "rows", "said"),
    [
        (SLOW, {"equals": 0.25, "within": 1e-3, "because": "Fig. 9b", "below": None}, 4, EQUALS),
        ({}, {"below": 1.0}, 1, "mean_friction below 1 everywhere: 0.1"),
        (FAST, {"above": 0.0}, 4, EMPTY),
        *(({}, BOTH | {"below": 1.0}, rows, MISSING) for rows in (3, 4)),
    ],
)
def test_the_sentence_says_what_was_claimed_where_why_and_what_was_found(
    where: dict[str, Any], claim: dict[str, Any], rows: int, said: str
) -> None:
    found = verdict(where, claim, TABLE.iloc[:rows])

    assert found.sentence == said
    assert found.passed == (rows == 1)


@pytest.mark.parametrize(
    ("where", "claim", "passed", "found"),
    [
        (EXACT, CONVEX, True, f"{BY_AREA} method exact (Fig. 4): convex, -0.200 +- 0.001"),
        (SHOOTING, CONVEX, False, f"{BY_AREA} method shooting (Fig. 4): concave, 0.100 +- 0.002"),
        (EXACT, {"shape": "concave", "measure": "initial"}, True, "(Fig. 4): concave, -0.500 +- 0.001"),
        (MARCH, CONVEX, False, f": {NO_END}"),
        (
            {},
            CONVEX,
            False,
            ": concave, 0.100 +- 0.002 in the first of 2 of 3 curves, of coulomb by shooting",
        ),
        (EXACT, AREA | {"below": -0.1}, True, "shape_area below -0.1 where method exact (Fig. 4): -0.2"),
        (FULL, AREA | {"below": 0.0}, False, "0.1 in the worst of 2 rows, that of coulomb by shooting"),
        (MARCH, AREA | {"below": 0.0}, False, f"coulomb by march: {NO_END}"),
        (SHOOTING, AREA | {"minus": EXACT, "above": 0.29}, True, "where method shooting (Fig. 4): 0.3"),
        (DAHL, LESS | {"above": -0.06}, True, WORST),
        (DAHL, LESS | {"above": 0.0}, False, f"{WORST}, {OF_DAHL}, law.presliding_length 10"),
        (STIFF | {SPEED: 1.0}, {"over": COULOMB, "above": 1.19}, True, ": 1.2"),
        (STIFF | {SPEED: 1.0}, {"over": COULOMB, "above": 1.21}, False, ": 1.2"),
        (SOFT | {SPEED: {"from": 2.0}}, LESS | {"below": 0.0}, True, "-0.05"),
        (SOFT | {SPEED: {"to": 1.9}}, LESS | {"below": 0.0}, False, ": 0.2"),
        (SOFT | {SPEED: [1.0, 2.0]}, {"minus": STIFF, "above": 0.0}, False, f"-0.06{OF_TWO}, {OF_DAHL}"),
        # those that are subtracted are not compared with themselves
        ({}, LESS | {"above": -0.06}, True, WORST),
        (COULOMB, LESS | {"above": -1.0}, False, f"{NONE} law coulomb, or none beside it"),
        (STIFF, {"minus": {"law": "lugre"}, "above": -1.0}, False, f"{NONE} law lugre, or none beside it"),
        # those of another law do not tell what is missing beside Coulomb friction
        ({}, {"minus": {LENGTH: 1.0}, "above": -1.0}, False, "is missing in 2 of 4 pairs of rows"),
    ],
)
def test_curves_and_rows_beside_those_of_other_inputs_are_told_with_what_was_found(
    where: dict[str, Any], claim: dict[str, Any], passed: bool, found: str
) -> None:
    told = verdict(where, claim | {"because": "Fig. 4"}, TABLE if "method" in where else LAWS)

    assert told.passed is passed
    assert told.sentence.endswith(found)
    assert "measure" not in claim or told.sentence.startswith("concave by initial curvature ")


def test_curves_in_si_units_are_compared_at_inputs_as_given() -> None:
    frequency = "drive.frequency"
    inputs = {f"scene.{frequency}": [1.0, 2.0], f"scene.dimensional.{frequency}_rad_per_s": [10.0, 20.0]}
    curves = pd.DataFrame(
        {"law": ["coulomb"] * 2, "method": ["auto"] * 2, **inputs, "shape_area": [0.1, -0.2]}
    )
    slow = {f"scene.dimensional.{frequency}_rad_per_s": 10.0}

    assert judge(Expectation(where={}, minus=slow, column="shape_area", below=-0.29), TABLE, curves).passed
