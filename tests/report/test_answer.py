# ruff: noqa: RUF001
# Pages have a minus, as here.
"""The first three paragraphs of a report, made from small tables of made-up numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import partial
from types import SimpleNamespace
from typing import Any, cast

import pandas as pd
import pytest
from fig_4b import over_speeds
from markupsafe import Markup
from profiles import some

import frictionlab as fl
from frictionlab.charts.figures import FigureData
from frictionlab.report import sentences as say
from frictionlab.report.answer import paragraphs
from frictionlab.report.facts import Facts
from frictionlab.report.question import scene_told
from frictionlab.runner.expectations import Verdict
from frictionlab.runner.table import status_counts
from frictionlab.study.load import parse_study
from frictionlab.study.study import Study

SPEED, FREQUENCY = "scene.belt_speed", "scene.drive.frequency"
NONE = math.nan
IN_WORDS = {
    "law": {"coulomb": "Coulomb"},
    "method": {"exact": "exact", "mdsm": "closed form", "march": "march"},
}
HIGHEST, OF_ONE = "Mean friction is highest for ", "Mean friction of Coulomb "
NOBODY, MODEL = "None is highest everywhere. ", "The closed form "


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


def laws(*means: Sequence[float], **others: Any) -> list[pd.DataFrame]:
    """The rows of Coulomb friction and other laws."""
    return [curve(law, own, **others) for law, own in zip(("coulomb", "dahl", "lugre"), means, strict=False)]


def told(
    *rows: pd.DataFrame, curves: Sequence[dict[str, Any]] = (), verdicts: Sequence[bool] = ()
) -> list[str]:
    """The three paragraphs of a run with these rows."""
    table = pd.concat(rows, ignore_index=True)
    methods = [SimpleNamespace(label=name, is_reduced=name == "mdsm") for name in IN_WORDS["method"]]
    study = cast("Study", SimpleNamespace(tolerance=1e-8, units={}, methods=methods, in_words=IN_WORDS))
    readers = {"table": lambda: table, "curves": lambda: pd.DataFrame(curves)}
    judged = tuple(Verdict(passed, "x") for passed in verdicts)
    saved = fl.Run(study, readers, status_counts(table), judged)
    drawn = cast("FigureData", SimpleNamespace(reference="Coulomb"))
    return [" ".join(str(each.striptags()).split()) for each in paragraphs(Facts(saved, drawn))]


def shape(law: str, verdict: str | None, reason: str | None = None, **others: Any) -> dict[str, Any]:
    """A row of curves.csv."""
    row = {"law": law, "kind": law, "method": "exact", "reversal_end": 50.0, "reversal_end_error": 0.02}
    row |= {"shape_area": 0.0577, "shape_area_error": 2e-4, "shape": verdict, "reason": reason}
    return row | others


ROUGH = laws([0.1, 0.32]) + laws([0.1, 0.3], error=0.05, method="mdsm")

slow, fast = (partial(laws, **{FREQUENCY: frequency}) for frequency in (1.0, 1.5))
WHO_IS_HIGHEST_WHERE: dict[str, list[pd.DataFrame]] = {
    # one point is told with its number and its error
    "The mean friction coefficient of Coulomb is 0.250 ± 0.002 at vb = 1.": laws([0.25], error=0.002),
    # a curve that rises is told by its ends
    f"{OF_ONE}rises from 0.1 at vb = 1 to 0.4 at vb = 4.": laws([0.1, 0.2, 0.2, 0.4]),
    # two points make a curve that falls
    f"{OF_ONE}falls from 0.4 at vb = 1 to 0.1 at vb = 2.": laws([0.4, 0.1]),
    # a curve that turns is told by its least and greatest
    f"{OF_ONE}lies between 0.1 at vb = 2 and 0.4 at vb = 3.": laws([0.3, 0.1, 0.4, 0.2]),
    # a curve that is flat within its errors is said to be
    f"{OF_ONE}is the same within its errors at all 3 points: 0.40 ± 0.01 at vb = 1.": laws(
        [0.4, 0.401, 0.4], error=0.01
    ),
    # a law without a number anywhere is named
    f"{OF_ONE}rises from 0.1 at vb = 1 to 0.2 at vb = 2. dahl has no number.": laws([0.1, 0.2], [NONE] * 2),
    # the law that is highest everywhere is named once
    f"{HIGHEST}dahl at all 2 belt speeds. dahl is above Coulomb by up to 0.100 ± 0.004 at vb = 2.": laws(
        [0.1, 0.2], [0.15, 0.3], error=2e-3
    ),
    # laws that are highest in turn have their stretches
    (
        f"{HIGHEST}dahl up to vb = 2, Coulomb from vb = 3 to vb = 4 and none beyond errors at vb = 5. "
        "Coulomb is above dahl by up to 0.1 at vb = 4."
    ): laws([0.1, 0.2, 0.3, 0.4, 0.4], [0.2, 0.3, 0.2, 0.3, 0.4]),
    # of laws that change places often the largest distance is told
    f"{NOBODY}dahl is above Coulomb by up to 0.1 at vb = 1.": laws([0.1, 0.2] * 3, [0.2, 0.1] * 3),
    # of several laws that change places the one furthest from the reference law is told
    f"{NOBODY}lugre is furthest from Coulomb, by 0.2 at vb = 1.": laws(
        [0.1, 0.2] * 3, [0.2, 0.1] * 3, [0.3, 0.1, 0.1, 0.05, 0.1, 0.1]
    ),
    # whoever is furthest is told at several settings
    (
        f"{NOBODY}dahl is furthest from Coulomb, by −0.3 at vb = 2, Ω = 1. "
        "dahl is furthest from Coulomb, by −0.6 at vb = 2, Ω = 1.5."
    ): (slow([0.1, 0.4] * 3, [0.3, 0.1] * 3, [0.2] * 6) + fast([0.2, 0.8] * 3, [0.6, 0.2] * 3, [0.4] * 6)),
    # laws that do not differ by more than their errors are the same
    "Of Coulomb and dahl the highest agree within errors at all 2 belt speeds.": laws(
        [0.1, 0.2], [0.11, 0.19], error=0.02
    ),
    # of several laws at one point the highest has its number
    f"{HIGHEST}dahl. Its mean is 0.3, above lugre, the next, by 0.1.": laws([0.1], [0.3], [0.2]),
    # a law without a number somewhere is not ranked there and that is said
    f"{HIGHEST}dahl up to vb = 2 and Coulomb at vb = 3. Where one has no number, the others are ranked. ...": laws(
        [0.1, 0.2, 0.3], [0.2, 0.3, NONE], [0.0] * 3
    ),
    # of one law the curves are ranked
    f"{HIGHEST}Coulomb with Ω = 1.5 at all 2 belt speeds. ...": slow([0.1, 0.2]) + fast([0.2, 0.4]),
    # points of several sweeps are told with all of them
    f"{HIGHEST}dahl at all 4 points. dahl is above Coulomb by up to 0.15 at vb = 1, Ω = 1.5.": (
        slow([0.1, 0.1], [0.2, 0.2]) + fast([0.15, 0.1], [0.3, 0.2])
    ),
    # friction swept for all laws together is compared value by value
    f"{HIGHEST}stribeck at all 4 points. ...": [
        curve("coulomb", [mu, mu], **{"law.mu": mu, "law.mu_kinetic": NONE}) for mu in (0.1, 0.2)
    ]
    + [curve("stribeck", [mu + 0.01] * 2, **{"law.mu": NONE, "law.mu_kinetic": mu}) for mu in (0.1, 0.2)],
    # laws that change places have the largest distance of each setting
    (
        f"{NOBODY}Coulomb is above dahl by up to 0.2 at vb = 2, Ω = 1. "
        "dahl is above Coulomb by up to 0.2 at vb = 1, Ω = 1.5."
    ): slow([0.1, 0.3], [0.2, 0.1]) + fast([0.1, 0.2], [0.3, 0.1]),
    # a mean that changes its sign does so between neighbours
    "...to 0.2 at vb = 3. It passes zero between −0.05 at vb = 2 and 0.2 at vb = 3.": laws(
        [-0.1, -0.05, 0.2]
    ),
    # methods of one law are held against each other
    "...at vb = 1. exact and march differ by up to 0.1 at vb = 1.": laws([0.2, 0.2])
    + laws([0.1, 0.2], error=1e-8, method="march"),
    "...at vb = 1. exact and march agree within errors: they differ by 0.10 ± 0.31 at vb = 1.": (
        laws([0.2, 0.2]) + laws([0.1, 0.2], error=0.3, method="march")
    ),
    # a reduced model is judged by the full answers beside it
    f"{MODEL}agrees with exact within errors.": laws([0.1, 0.3]) + laws([0.1, 0.3], method="mdsm"),
    f"{MODEL}is too low by up to 0.02 at vb = 2.": ROUGH,
    # a reduced model is judged at each setting
    f"{MODEL}is too high by up to 0.3 at vb = 2, Ω = 1.5. {MODEL}is too low by up to 0.2 at ...": [
        curve("coulomb", [0.1, 0.3 + off], error=error, **{FREQUENCY: frequency, "method": method})
        for frequency in (1.0, 1.5)
        for method, off, error in (("mdsm", frequency - 1.2, 0.5), ("exact", 0.0, 1e-9))
    ],
    # a reduced model alone is told with its own error
    f"...at vb = 1 to 0.30 ± 0.05 at vb = 2. {MODEL}is off by up to 0.05 at vb = 1.": ROUGH[1:],
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
        "Needs attention: refused at 2 of 2 points.",
    ]


# Shapes

FREQUENCIES = [float(place) for place in range(1, 6)]
STOPS = "Slip stops reversing at vb = 50.00 ± 0.02."
AREA = "The area between curve and chord is 0.0577 ± 0.0002 of that under the chord."
LAWS = "coulomb", "dahl", "lugre"
SHAPES: dict[str, list[dict[str, Any]]] = {
    # one curve is told with its end and its area
    f"Concave (above the chord): Coulomb. {AREA} {STOPS}": [shape("coulomb", "concave")],
    # a reduced model has its own shape beside the true one, and decides none that is open
    f"Concave (above the chord): Coulomb. By the closed form convex: Coulomb. {AREA} {STOPS}": [
        shape("coulomb", "convex", method="mdsm"),
        shape("coulomb", "concave"),
    ],
    f"Convex (below the chord): Coulomb. {AREA} {STOPS}": [
        shape("coulomb", "undecided", method="mdsm"),
        shape("coulomb", "convex"),
    ],
    # an end known to more than itself is not told
    "Mixed (on both sides of the chord): Coulomb. Where slip stops reversing is left open by errors.": [
        shape("coulomb", "mixed", reversal_end=12.0, reversal_end_error=27.0)
    ],
    # curves that are alike are told together
    f"Convex (below the chord): all 3 curves. {STOPS}": [shape(law, "convex") for law in LAWS],
    # a few curves that differ are named, and those without a shape are counted
    (
        "Concave (above the chord): Coulomb. Undecided (errors leave it open): dahl. "
        "Without a shape: 1 of 3 curves (no points). Slip stops reversing at vb from 40 to 50."
    ): [
        shape("coulomb", "concave", reversal_end=40.0),
        shape("dahl", "undecided"),
        shape("lugre", None, "no points"),
    ],
    # many curves are told by what all of them and no others have
    (
        "Concave (above the chord): all 5 curves for Coulomb. "
        f"Convex (below the chord): all 5 curves for dahl. {STOPS}"
    ): [
        shape(law, bend, **{FREQUENCY: each})
        for law, bend in (("coulomb", "concave"), ("dahl", "convex"))
        for each in FREQUENCIES
    ],
    # of others many are counted, and few are named
    f"Concave (above the chord): 7 of 8 curves. Convex (below the chord): Coulomb with Ω = 3. {STOPS}": [
        shape("coulomb", "convex" if each == 3 else "concave", **{FREQUENCY: each})
        for each in map(float, range(1, 9))
    ],
    # why no curve has a shape is told by the commonest reason
    "Without a shape: 4 of 4 curves (3 ... 5 points, and other reasons).": [
        shape("dahl", None, "sticks"),
        *(shape(law, None, f"{count} points") for count, law in enumerate(LAWS, 3)),
    ],
}


@pytest.mark.parametrize("wanted", SHAPES)
def test_the_second_sentence_says_which_curves_are_concave(wanted: str) -> None:
    found = SHAPES[wanted]
    swept = pd.DataFrame(found).reindex(columns=["law", FREQUENCY]).dropna(axis="columns")
    rows = [curve(each.pop("law"), [0.1, 0.2], **each) for each in swept.to_dict("records")]

    assert told(*rows, curves=found)[1] == wanted


def test_a_scene_in_si_units_has_its_end_of_reversal_in_them() -> None:
    rows = curve("coulomb", [0.1, 0.2]).assign(**{"scene.dimensional.belt_speed_m_per_s": [0.25, 0.5]})
    in_si = {"reversal_end_m_per_s": 12.5, "reversal_end_error_m_per_s": 0.005}
    first, second, _ = told(rows, curves=[shape("coulomb", "concave", **in_si)])

    assert first.endswith("rises from 0.1 at Vb = 0.25 m/s to 0.2 at Vb = 0.5 m/s.")
    assert "at Vb = 12.500 ± 0.005 m/s." in second


# What needs attention

WELL, NEEDS = "Nothing needs attention: ", "Needs attention: "
SEVERAL = curve("stribeck", [NONE, NONE]).assign(status="not_unique", mean_low=0.1, mean_high=0.25)
OPEN = curve("dahl", [0.1, NONE, 0.3]).assign(mean_low=[0.0731, NONE, NONE], mean_high=0.366)
OPEN.loc[0, ["status", "mean_friction"]] = ["not_unique", NONE]
KILLED = curve("coulomb", [NONE, NONE, 0.3]).assign(status=["killed", "refused", "ok"])
PLAIN = f"{WELL}2 points ok. Errors are at most 1.0e-09. What the study expects holds: 2 expectations."
BAD = (
    f"{NEEDS}errors up to 0.05 above the tolerance of 1e-08 at 2 points (dahl, by exact); "
    "1 of 2 expectations FAILED."
)
JUDGED = {PLAIN: [True, True], BAD: [True, False]}
ATTENTION: dict[str, list[pd.DataFrame]] = {
    # that nothing does is said with what was looked at; the own error of a reduced model needs none
    PLAIN: [curve("coulomb", [0.1, 0.2], reason="tested: 2 starts ended here")],
    f"{WELL}4 points ok. Errors are at most 1.0e-09, but for what models leave out.": ROUGH,
    f"{WELL}2 points ok.": ROUGH[1:],
    # errors above the tolerance and expectations that failed do
    BAD: [*ROUGH, curve("dahl", [0.1, 0.2], error=0.05)],
    f"{NEEDS}errors up to 0.002 above the tolerance of 1e-08 at 2 points.": [
        curve("coulomb", [0.1, 0.2], error=0.002, error_kind="statistical")
    ],
    # points without an answer are told with whose they are, and with between what means lie
    f"{NEEDS}not unique at 2 of 2 points, with means from 0.1 to 0.25.": [SEVERAL],
    (
        f"{NEEDS}not unique at 1 of 6 points (dahl), with means from 0.0731 to 0.366; "
        "refused at 1 of 6 points (dahl)."
    ): [curve("coulomb", [0.1, 0.2, 0.3]), OPEN],
    # points that an interruption left are told first
    f"{NEEDS}not reached at 1 of 3 points, as the run was interrupted; refused at 1 of 3 points.": [KILLED],
    # a remark on a point that is ok
    f"{NEEDS}a remark at 2 points.": [curve("coulomb", [0.1, 0.2], reason="still changes a little")],
}


@pytest.mark.parametrize("wanted", ATTENTION)
def test_the_third_paragraph_says_what_needs_attention(wanted: str) -> None:
    assert told(*ATTENTION[wanted], verdicts=JUDGED.get(wanted, []))[2] == wanted


# The scene

BODY: dict[str, Any] = {"damping_ratio": 0.1, "normal_load": 1, "belt_speed": 1}
DRIVE = {"amplitude": 1, "frequency": 2}
PUSHED = BODY | {"drive": DRIVE}
SUM = {"harmonics": [{"order": 1, "amplitude": 1}, {"order": 3, "amplitude": 0.5, "phase": 90}]}
ACROSS = {"natural_frequency": 1, "damping_ratio": 0.1}
LINE = "A body with one degree of freedom, on a moving belt."
PLANE = "A body with two degrees of freedom, in the plane, on a moving belt."
ALONG = "The load along the belt varies as a sine."
LOAD = "The normal load varies as a sine."
SLIP = "Prescribed slip: a body whose slip over the belt is given, not computed."
VARYING = {"amplitude": 0.3}
CONTACTS = {"waveform": ["sine", "square"], "frequency_ratio": [1, 2], "contact": ["per_load", "constant"]}
SCENES: dict[str, dict[str, Any]] = {
    f"{LINE} {ALONG}": PUSHED,
    f"{LINE} Nothing shakes it.": BODY,
    f"{LINE} No spring holds it along the belt. {ALONG} A constant force pushes the body along the belt.": (
        PUSHED | {"spring": False, "drive": DRIVE | {"offset": 0.5}}
    ),
    f"{SLIP} The slip velocity along the belt varies as a sine.": (
        {"belt_speed": 1, "slip": {"velocity_amplitude": 1, "frequency": 1}}
    ),
    f"{PLANE} The load at 30° to the motion of the belt varies as a square wave.": (
        PUSHED | {"drive": DRIVE | {"direction": 30, "waveform": "square"}, "transverse": ACROSS}
    ),
    f"{PLANE} {ALONG} The load across the belt varies as sin(theta) + 0.5 sin(3 theta + 90 deg).": (
        PUSHED | {"transverse": ACROSS | {"load": {"amplitude": 1, "waveform": SUM}}}
    ),
    (
        f"{PLANE} The load in several directions varies as a sine. "
        "The velocity of the vibrating belt along the belt varies as a sine at 3/2 times the frequency of the drive."
    ): PUSHED
    | {"transverse": ACROSS, "belt_vibration": {"velocity_amplitude": 1, "frequency_ratio": "3/2"}}
    | {"sweep": {"scene.drive.direction": [0, 30]}},
    f"{LINE} {ALONG} {LOAD} The stiffness of bristles follows it.": PUSHED
    | {"normal_load_variation": VARYING},
    f"{LINE} {ALONG} {LOAD} The stiffness of bristles stays that of its mean.": (
        PUSHED | {"normal_load_variation": VARYING | {"contact": "constant"}}
    ),
    (
        f"{LINE} {ALONG} The normal load varies in several waveforms at several frequencies. "
        "The stiffness of bristles follows it or stays that of its mean."
    ): PUSHED
    | {"normal_load_variation": VARYING}
    | {"sweep": {f"scene.normal_load_variation.{name}": values for name, values in CONTACTS.items()}},
}


def study_of(scene: dict[str, Any]) -> Study:
    sweep = scene.get("sweep", {})
    given = {name: value for name, value in scene.items() if name != "sweep"}
    return parse_study(over_speeds([1.0], scene=given, methods=["auto"], sweep=sweep))


@pytest.mark.parametrize("wanted", SCENES)
def test_a_scene_is_told_with_what_changes_in_time(wanted: str) -> None:
    assert scene_told(study_of(SCENES[wanted])) == wanted


# Templates

GROUPS = {name: group for name, group in vars(say).items() if name.isupper() and isinstance(group, dict)}
TEMPLATES = [(name, words) for name, group in GROUPS.items() for words in group]


LETTERS = "<i>v</i><i>T</i><i>w</i>", "<i>H</i><i>t</i>", "<i>ω</i><i>f</i>", "<i>ω</i><i>n</i>"


@pytest.fixture(scope="module")
def everything_told() -> list[str]:
    """The paragraphs of every table above, and of every scene."""
    tables = [*WHO_IS_HIGHEST_WHERE.values(), [curve("coulomb", [NONE, NONE])], [SEVERAL]]
    in_si = {"mass": "3 kg", "stiffness": "300 N/m", "belt_speed": "1 m/s", "normal_load": "1 N"}
    units = [say.tell(say.ON_UNITS, study_of(scene).scene) for scene in (BODY, {"dimensional": in_si})]
    letters = [say.tell(say.ON_LETTERS, text) for text in LETTERS]
    return [*(" ".join(told(*rows)) for rows in tables), *units, *letters, *SHAPES, *ATTENTION, *SCENES]


@pytest.mark.parametrize(("group", "words"), TEMPLATES)
def test_a_template_has_three_slots_is_told_of_one_table_and_not_of_another(
    group: str, words: str, everything_told: list[str]
) -> None:
    slots = re.findall(r"{\w+}", words)
    pattern = re.sub(r"\\{\w+\\}", ".+", re.escape(Markup(words).striptags()))
    found = [re.search(pattern, each, re.IGNORECASE) is not None for each in everything_told]

    assert len(slots) <= 3
    assert any(found)
    assert not all(found)


def test_places_have_four_digits_in_sentences() -> None:
    first, *_ = told(curve("coulomb", [0.1, 0.2]).assign(**{SPEED: [517.947, 719.686]}))

    assert "rises from 0.1 at vb = 517.9 to 0.2 at vb = 719.7." in first
