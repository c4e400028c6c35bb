"""The study file: what loads, what it becomes, and every mistake at its place."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from profiles import some
from study_mistakes import EDITS, GOOD, HINTS

from frictionlab.scene.dimensional import without_unit
from frictionlab.study import registry
from frictionlab.study.expectations import Expectation
from frictionlab.study.keys import STUDY_KEYS
from frictionlab.study.load import load_study, parse_study
from frictionlab.study.schema import schema
from frictionlab.study.study import Study
from frictionlab.values.columns import OF_SHAPE
from frictionlab.values.notes import StudyError

STUDIES = Path(__file__).parents[2] / "studies"


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Write text as study.yaml in the working directory and give its name."""
    monkeypatch.chdir(tmp_path)

    def write(text: str | bytes) -> str:
        content = text.encode() if isinstance(text, str) else text
        Path("study.yaml").write_bytes(content)
        return "study.yaml"

    return write


def heads(problem: StudyError) -> list[str]:
    """The first line of each mistake."""
    return [str(mistake).splitlines()[0] for mistake in problem.mistakes]


def mistakes(path: str, overrides: tuple[str, ...] = ()) -> list[str]:
    with pytest.raises(StudyError) as caught:
        load_study(path, overrides)
    return heads(caught.value)


def outcome(read: Callable[[], Study]) -> Study | str:
    """The study, or its mistakes as they are shown."""
    try:
        return read()
    except StudyError as problem:
        return str(problem)


def good() -> dict[str, Any]:
    """The good study as plain values."""
    return {
        "schema": 1,
        "scene": {
            "damping_ratio": 0.1,
            "normal_load": 10,
            "belt_speed": 5,
            "drive": {"unbalance": 10, "frequency": 1},
        },
        "laws": [{"kind": "coulomb", "mu": 0.4}],
    }


# What a study becomes


def test_a_study_becomes_its_frozen_record(written: Any) -> None:
    study = load_study(written(GOOD))

    assert study.title == "Two loads"
    assert study.source == "Fig. 9b"
    assert study.path == Path("study.yaml")
    assert [(law.label, law.kind, law.parameters) for law in study.laws] == [
        ("coulomb", "coulomb", {"mu": 0.4}),
        ("soft", "coulomb", {"mu": 0.3}),
    ]
    assert [(method.label, method.name) for method in study.methods] == [
        ("auto", "auto"),
        ("second", "shooting"),
    ]
    assert study.tolerance == 1e-6
    assert study.keep.orbit == 200
    assert list(study.sweep) == ["scene.belt_speed", "laws.soft.mu"]
    assert study.expect == (
        Expectation(
            where={"law": "coulomb", "scene.belt_speed": 5.0}, column="error", below=1.0, because="Fig. 9b"
        ),
    )


def test_a_shape_is_expected_by_area_unless_it_says_else_and_loads_back() -> None:
    sweep = {"sweep": {"scene.belt_speed": [1, 2]}}
    claims = [{"shape": "mixed"}, {"shape": "concave", "measure": "initial"}]
    found = parse_study(good() | sweep | {"expect": claims})

    assert [(claim.shape, claim.measure) for claim in found.expect] == [
        ("mixed", "area"),
        ("concave", "initial"),
    ]
    assert parse_study(found.resolved()) == found


def test_a_table_has_the_columns_of_the_figure_that_the_title_is_of() -> None:
    energies = {"energy_input", "energy_viscous", "energy_friction", "energy_contact"}

    assert energies <= parse_study(good() | {"figures": {"finding": "energies"}}).selected()
    assert not energies & parse_study(good() | {"expect": []}).selected()


def test_expectations_of_several_rows_and_against_others_load_back() -> None:
    sweep = {"sweep": {"scene.belt_speed": [1, 2, 3]}}
    where = {"law": ["coulomb"], "scene.belt_speed": {"from": 1, "to": 2}}
    claims = [
        {"where": where, "minus": {"scene.belt_speed": 3}, "column": "mean_friction", "below": 0},
        {"over": {"law": "coulomb"}, "column": "shape_area", "above": 1},
    ]
    found = parse_study(good() | sweep | {"expect": claims})

    assert found.expect[0].where == {"law": ["coulomb"], "scene.belt_speed": {"from": 1.0, "to": 2.0}}
    assert [(claim.minus, claim.over) for claim in found.expect] == [
        ({"scene.belt_speed": 3.0}, None),
        (None, {"law": "coulomb"}),
    ]
    assert "shape_area" not in found.selected()
    assert set(OF_SHAPE) <= found.selected()
    assert parse_study(found.resolved()) == found


def test_a_range_of_rows_and_their_difference_may_have_units() -> None:
    scene = {
        "normal_load": "2 N",
        "belt_speed": "1 mm/s",
        "slip": {"velocity_amplitude": "1 mm/s", "frequency": "1 Hz"},
    }
    where = {"scene.dimensional.belt_speed": {"from": "1 mm/s"}}
    claim = {"where": where, "minus": {"law": "coulomb"}, "column": "mean_friction_N", "below": "3 mN"}
    found = parse_study(good() | {"scene": {"dimensional": scene}, "expect": [claim]}).expect[0]

    assert found.where == {"scene.dimensional.belt_speed_m_per_s": {"from": 0.001}}
    assert found.below == 0.003


def test_what_refers_to_other_parts_is_told_once_these_have_no_mistakes() -> None:
    wrong = {"expect": [{"shape": "mixed"}], "figures": {"against": "dahl"}}
    for other, told in (
        ({"scene": good()["scene"] | {"normal_load": -1}}, ["must be > 0, got -1"]),
        (
            {},
            ["must be one of coulomb; got the text 'dahl'", "a shape needs a curve: sweep scene.belt_speed"],
        ),
    ):
        with pytest.raises(StudyError) as caught:
            parse_study(good() | wrong | other)

        assert [mistake.what for mistake in caught.value.mistakes] == told


@pytest.mark.parametrize("key", STUDY_KEYS)
def test_a_key_without_a_value_is_told(key: str) -> None:
    with pytest.raises(StudyError, match=rf"^study: {key}: must be"):
        parse_study(good() | {key: None})


def test_what_is_left_out_takes_its_default() -> None:
    study = parse_study(good())

    assert [method.name for method in study.methods] == ["auto"]
    assert study.tolerance == 1e-8
    assert study.sweep == {}
    assert study.keep.orbit is None
    assert len(study.cases()) == 1


def test_the_grid_is_full_and_a_law_is_swept_alone(written: Any) -> None:
    cases = load_study(written(GOOD)).cases()

    rows = {(c.law_label, c.law.numbers()["mu"], c.method_label, c.scene.belt_speed) for c in cases}
    assert len(rows) == len(cases) == (1 + 2) * 2 * 120
    assert {mu for label, mu, _, _ in rows if label == "coulomb"} == {0.4}
    assert {mu for label, mu, _, _ in rows if label == "soft"} == {0.1, 0.2}
    assert {speed for _, _, _, speed in rows} == {0.5 * i for i in range(1, 121)}


def test_a_linear_range_is_correctly_rounded() -> None:
    study = parse_study(good() | {"sweep": {"scene.belt_speed": {"start": 0.1, "stop": 1, "num": 10}}})

    assert study.sweep["scene.belt_speed"] == (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)


def test_a_logarithmic_range_has_exact_ends_and_equal_ratios() -> None:
    range_ = {"start": 1e-3, "stop": 70.0, "num": 9, "spacing": "log"}
    values = parse_study(good() | {"sweep": {"scene.belt_speed": range_}}).sweep["scene.belt_speed"]

    assert (values[0], values[-1]) == (1e-3, 70.0)
    np.testing.assert_allclose(np.diff(np.log(values)), np.log(70e3) / 8, rtol=1e-12)


def test_a_swept_value_need_not_be_given_a_second_time() -> None:
    tree = good() | {"sweep": {"scene.belt_speed": [3, 4], "laws.coulomb.mu": [0.1, 0.2]}}
    del tree["scene"]["belt_speed"], tree["laws"][0]["mu"]

    assert parse_study(tree).scene.belt_speed == 3
    cases = parse_study(tree).cases()
    assert [(c.scene.belt_speed, c.law.numbers()["mu"]) for c in cases] == [
        (3, 0.1),
        (4, 0.1),
        (3, 0.2),
        (4, 0.2),
    ]


def test_aliases_and_every_way_to_write_a_number_are_read(written: Any) -> None:
    text = GOOD.replace("drive: {unbalance: 10", "drive: {unbalance: &ten 0xA").replace(
        "load: {unbalance: 10}", "load: {unbalance: *ten, phase: -1e-3}"
    )
    scene = load_study(written(text)).scene

    assert scene.transverse is not None
    assert scene.transverse.load is not None
    assert (scene.transverse.load.unbalance, scene.transverse.load.phase) == (10.0, -1e-3)


def test_a_study_with_a_byte_order_mark_and_windows_lines_is_the_same_study(written: Any) -> None:
    plain = load_study(written(GOOD))

    assert load_study(written(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())) == plain


@pytest.mark.parametrize(
    "change",
    [
        {"title": "Other"},
        {"source": "Other"},
        {"expect": [{"status": "ok"}]},
        {"keep": {"orbit": 9}},
        {"tolerance": 1e-8},
    ],
)
def test_the_digest_overlooks_what_does_not_change_the_numbers(change: dict[str, Any]) -> None:
    assert parse_study(good() | change).digest() == parse_study(good()).digest()


@pytest.mark.parametrize(
    "override",
    [
        "scene.belt_speed=6",
        "scene.drive.phase=1",
        "laws.coulomb.mu=0.5",
        "laws[0].label=other",
        "methods=[exact]",
        "tolerance=1e-9",
        "sweep.scene.belt_speed=[5, 6]",
    ],
)
def test_the_digest_sees_what_changes_the_numbers(override: str) -> None:
    assert parse_study(good(), [override]).digest() != parse_study(good()).digest()


def test_a_value_that_is_swept_anyway_is_not_in_the_digest() -> None:
    sweep = {"sweep": {"scene.belt_speed": [1, 2], "laws.coulomb.mu": [0.1, 0.2]}}
    other = good() | sweep
    other["scene"] = other["scene"] | {"belt_speed": 7}
    other["laws"] = [{"kind": "coulomb", "mu": 0.7}]

    assert parse_study(other).digest() == parse_study(good() | sweep).digest()


# Overrides


@pytest.mark.parametrize(
    ("override", "found"),
    [
        ("scene.drive.frequency=1.5", lambda study: study.scene.frequency == 1.5),
        ("scene.transverse.load.phase=90", lambda study: study.scene.transverse.load.phase == 90),
        ("tolerance=1e-7", lambda study: study.tolerance == 1e-7),
        ("laws.coulomb.mu=0.35", lambda study: study.laws[0].parameters == {"mu": 0.35}),
        (
            "sweep.scene.belt_speed=[1,2,3]",
            lambda study: study.sweep["scene.belt_speed"] == (1.0, 2.0, 3.0),
        ),
        ("sweep.scene.belt_speed.num=2", lambda study: study.sweep["scene.belt_speed"] == (0.5, 60.0)),
        (
            "sweep.scene.drive.frequency=[1, 2]",
            lambda study: sum(len(rows) for _, rows in study.scenes_along) == 240,
        ),
        ("methods=[exact,shooting]", lambda study: [m.name for m in study.methods] == ["exact", "shooting"]),
        ("title=a = b", lambda study: study.title == "a = b"),
        ("keep.orbit=9", lambda study: study.keep.orbit == 9),
        ("expect=[]", lambda study: study.expect == ()),
    ],
)
def test_an_override_replaces_a_value(written: Any, override: str, found: Any) -> None:
    assert found(load_study(written(GOOD), [override]))


def test_an_override_can_mend_a_mistake_of_the_file(written: Any) -> None:
    path = written(GOOD.replace("tolerance: 1e-6", "tolerance: !foo 3"))

    assert load_study(path, ["tolerance=1e-6"]).tolerance == 1e-6


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("scene.drive.frequenzy=1", "scene.drive.frequenzy: unknown key; allowed: unbalance"),
        ("scene.damping_ratio=[1", "the value is not YAML: while parsing a flow sequence"),
        ("scene.damping_ratio", "write path=value, for example scene.belt_speed=5"),
        ("scene..x=3", "'scene..x' is no path such as scene.belt_speed or laws[0].mu"),
        ("laws.sofd.mu=3", "no law is labelled 'sofd'; there are coulomb, soft"),
        ("laws[5].mu=3", "laws[5]: there is no item [5]"),
        ("tolerance.x=3", "tolerance.x: there is no mapping to set it in"),
        ("scene.belt_speed=3", "scene.belt_speed: the study sweeps scene.belt_speed: set sweep."),
        ("laws.soft.mu=3", "laws[1].mu: the study sweeps laws.soft.mu: set sweep.laws.soft.mu instead"),
        ("sweep.scene.drive.frequency=[1, -1]", "sweep.scene.drive.frequency[1]: must be > 0, got -1"),
        ("scene.drive={unbalance: -1, frequency: 1}", "scene.drive.unbalance: must be >= 0, got -1"),
        ("methods=[]", "methods: the list is empty; give at least one, such as [auto]"),
    ],
)  # fmt: skip
def test_a_mistake_in_an_override_names_the_override(written: Any, override: str, said: str) -> None:
    found = mistakes(written(GOOD), (override,))

    assert len(found) == 1
    assert found[0].startswith(f"--set {override}: {said}")


@pytest.mark.parametrize(
    ("first", "second", "path"),
    [
        ("tolerance=1e-5", "tolerance=1e-6", "tolerance"),
        ("laws.coulomb.mu=1", "laws=[{kind: coulomb, mu: 2}, {kind: coulomb, mu: 2, label: soft}]", "laws"),
    ],
)
def test_a_value_set_twice_is_a_mistake(written: Any, first: str, second: str, path: str) -> None:
    assert mistakes(written(GOOD), (first, second)) == [f"--set {second}: {path}: set twice"]


def test_a_sweep_inside_a_list_is_a_mistake_of_the_list(written: Any) -> None:
    found = mistakes(written(GOOD.replace("drive: {unbalance: 10, frequency: 1}", "drive: [1]")
                             .replace("  scene.belt_speed: {", "  scene.drive.phase: {")))  # fmt: skip

    assert found == ["study.yaml:8:3: scene.drive: must be a mapping (key: value), got a list"]


# Mistakes


def test_a_mistake_shows_its_place_its_line_a_caret_and_a_likely_meaning(written: Any) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(written(GOOD.replace("  belt_speed", "  belt_sped")))

    assert str(caught.value).splitlines() == [
        "study.yaml:7:3: scene.belt_sped: unknown key; allowed: damping_ratio, spring, normal_load, belt_speed, "
        "drive, transverse, body, slip, transverse_slip, belt_vibration, normal_load_variation, initial, dimensional",
        "      belt_sped: 5",
        "      ^",
        "    did you mean 'belt_speed'?",
    ]


def test_the_caret_stands_under_the_column_of_a_long_line(written: Any) -> None:
    numbers = ", ".join(str(i) for i in range(1, 200))
    path = written(GOOD.replace("{start: 0.5, stop: 60, num: 120}", f"[{numbers}, .nan, {numbers[3:]}]"))
    with pytest.raises(StudyError) as caught:
        load_study(path)

    _, line, caret, *_ = str(caught.value.mistakes[0]).splitlines()
    assert line[caret.index("^") :].startswith(".nan")
    assert len(line) <= 104


def test_the_caret_stands_under_the_column_of_a_line_with_tabs(written: Any) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(written(GOOD.replace("10, frequency: 1}", "10,\t frequency: x}")))

    _, line, caret = str(caught.value).splitlines()
    assert line.expandtabs()[caret.expandtabs().index("^")] == "x"


def test_a_sweep_of_no_law_is_not_told_beside_a_law_of_unknown_kind_which_may_be_the_one() -> None:
    laws = [{"kind": "coulomb", "mu": 0.4}, {"kind": "dhal", "mu": 0.4, "stiffness": 1}]
    swept = {"laws.dahl.mu": [0.1, 0.2]}
    with pytest.raises(StudyError) as caught:
        parse_study({"schema": 1, "scene": good()["scene"], "laws": laws, "sweep": swept})

    assert [mistake.path for mistake in caught.value.mistakes] == ["laws[1].kind"]


def test_a_parameter_that_is_a_word_is_not_swept_and_the_way_to_vary_it_is_told() -> None:
    laws, sweep = [{"kind": "dahl", "mu": 0.4, "stiffness": 1}], {"laws.dahl.planar": [1, 2]}
    with pytest.raises(
        StudyError, match=r"planar of the law 'dahl' is not one number: give a law of its own for each"
    ):
        parse_study({"schema": 1, "scene": good()["scene"], "laws": laws, "sweep": sweep})


def test_every_mistake_is_told_at_once_in_the_order_of_the_file(written: Any) -> None:
    text = (
        GOOD.replace("schema: 1", "schema: 2")
        .replace("damping_ratio: 0.1\n  normal", "damping_ratio: -0.1\n  normal")
        .replace("drive: {unbalance: 10, frequency: 1}", "drive: {amplitude: 1, unbalanse: 10}")
        .replace("mu: 0.4", "mu: true")
        .replace("tolerance: 1e-6", "tolerance: .inf")
        .replace("num: 120", "num: 1")
        .replace("keep: {orbit: 200}", "plugins: 5")
        .replace("column: error", "column: 5")
    )

    assert mistakes(written(text)) == [
        "study.yaml:1:9: schema: must be 1, got 2",
        "study.yaml:5:18: scene.damping_ratio: must be >= 0, got -0.1",
        "study.yaml:8:3: scene.drive.frequency: required key is missing",
        "study.yaml:8:25: scene.drive.unbalanse: unknown key; allowed: unbalance, amplitude, phase, "
        "waveform, offset, frequency, direction",
        "study.yaml:14:25: laws[0].mu: must be a number, got true",
        "study.yaml:17:12: tolerance: must be a finite number, got .inf",
        "study.yaml:19:49: sweep.scene.belt_speed.num: must be >= 2, got 1",
        "study.yaml:21:10: plugins: must be a list of Python files such as [my_law.py], got 5",
        "study.yaml:23:58: expect[0].column: must be text, got 5 (put it in quotes)",
    ]


@some(40, "mistakes of every kind")
@pytest.mark.parametrize(("old", "new", "said"), EDITS, ids=[said for _, _, said in EDITS])
def test_one_mistake_gives_one_message_at_its_place(written: Any, old: str, new: str, said: str) -> None:
    assert GOOD.count(old) >= 1

    found = mistakes(written(GOOD.replace(old, new, 1)))

    assert len(found) == 1
    assert found[0].startswith(f"study.yaml:{said}")


@pytest.mark.parametrize(("old", "new", "hint"), HINTS)
def test_a_slip_is_told_with_what_to_write_or_is_likely_meant(
    written: Any, old: str, new: str, hint: str
) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(written(GOOD.replace(old, new, 1)))

    assert len(caught.value.mistakes) == 1
    assert str(caught.value).splitlines()[-1].strip() == hint


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"", "study.yaml:1:1: the study is empty"),
        (b"# nothing\n", "study.yaml:1:1: the study is empty"),
        (b"- schema: 1\n", "study.yaml:1:1: must be a mapping (key: value), got a list"),
        (b"hello", "study.yaml:1:1: must be a mapping (key: value), got the text 'hello'"),
        (b"a: [1\n", "study.yaml:2:1: not YAML: while parsing a flow sequence"),
        (b"schema: 1\nlaws: ]\n", "study.yaml:2:7: not YAML: while parsing a block node expected"),
        (b"a: 1\n---\nb: 2\n", "study.yaml:2:1: not YAML: expected a single document in the stream"),
        (b"\x89PNG\r\n\x1a\n\x00\xff", "study.yaml: is not UTF-8 text (byte 1); save it as UTF-8"),
        (b"schema: \x00 1", "study.yaml:1:9: is not text: character '\\x00'"),
        (b"[" * 1000, "study.yaml: not a study: nested too deeply"),
        (b"a: *nowhere", "study.yaml:1:4: not YAML: found undefined alias 'nowhere'"),
    ],
)
def test_what_is_no_study_is_refused_in_one_message(written: Any, text: bytes, said: str) -> None:
    found = mistakes(written(text))

    assert len(found) >= 1
    assert found[0].startswith(said)


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    assert mistakes(str(tmp_path / "none.yaml")) == [f"{tmp_path}/none.yaml: no such file"]
    assert mistakes(str(tmp_path)) == [f"{tmp_path}: is a folder"]


def test_a_file_that_may_not_be_read_is_refused(written: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(GOOD)

    def refuse(_: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", refuse)

    assert mistakes(path) == ["study.yaml: cannot be read: Permission denied"]


def test_a_value_that_contains_itself_is_a_mistake(written: Any) -> None:
    found = mistakes(written(GOOD.replace("title: Two loads", "title: &t [*t]")))

    assert found == ["study.yaml:1:1: not a study: nested too deeply"]


def test_a_mapping_has_no_lines_but_the_same_messages() -> None:
    with pytest.raises(StudyError) as caught:
        parse_study(good() | {"tolerance": -1, "laws": [{"kind": "coulomb", "mu": object()}]})

    assert heads(caught.value) == [
        "study: laws[0].mu: must be a number, got a object",
        "study: tolerance: must be > 0, got -1",
    ]


def test_minus_zero_is_the_same_study_when_it_was_resolved_and_read_again() -> None:
    study = parse_study(good() | {"scene": good()["scene"] | {"belt_speed": -0.0}})

    again = parse_study(study.resolved())
    assert (again, again.digest()) == (study, study.digest())


# Schema and columns


def _keys_of(made: dict[str, Any], at: dict[str, Any]) -> set[str]:
    """Every dotted key that a schema allows under one of its parts."""
    at = made["$defs"][at["$ref"].rpartition("/")[2]] if "$ref" in at else at
    found = {key for each in at.get("oneOf", ()) for key in each.get("propertyNames", {}).get("enum", ())}
    for key, inner in at.get("properties", {}).items():
        found |= {key} | {f"{key}.{below}" for below in _keys_of(made, inner)}
    return found


def _allowed(tree: dict[str, Any], path: str) -> list[str]:
    """The keys that a refusal of a nonsense key says are allowed."""
    with pytest.raises(StudyError) as caught:
        parse_study(tree)
    said = next(m.what for m in caught.value.mistakes if m.path == path)
    return said.removeprefix("unknown key; allowed: ").partition("; ")[0].split(", ")


def test_the_schema_and_the_reader_allow_the_same_keys_at_the_top_and_in_a_scene() -> None:
    made, nonsense = schema(), {"zzz": 1}
    shared = "drive", "belt_vibration", "normal_load_variation", "initial"
    parts = nonsense | dict.fromkeys(shared, nonsense) | {"transverse": nonsense | {"load": nonsense}}
    parts |= {"body": nonsense | dict.fromkeys(("relaxation", "fractional"), nonsense)}
    receptance = good() | {"scene": good()["scene"] | {"body": {"receptance": nonsense | {"file": "h.csv"}}}}
    slips = dict.fromkeys(("slip", "transverse_slip"), nonsense)
    probe = good() | nonsense | {"scene": good()["scene"] | parts | slips}
    si = good() | {"scene": {"dimensional": parts | slips}}

    assert set(_allowed(probe, "zzz")) == set(made["properties"])
    scene = {key for key in _keys_of(made, made["properties"]["scene"]) if "waveform." not in key}
    both = ["", "drive.", "transverse.", "transverse.load.", "initial."]
    both += ["belt_vibration.", "normal_load_variation.", "body.", "body.relaxation.", "body.fractional."]
    found = {
        part + key
        for part in [*both, "slip.", "transverse_slip."]
        for key in _allowed(probe, f"scene.{part}zzz")
    }
    found |= {f"body.receptance.{key}" for key in _allowed(receptance, "scene.body.receptance.zzz")}
    found |= {"body.receptance"}
    in_si = {"dimensional": {"body": {"receptance": nonsense | {"file": "h.csv"}}}}
    told = _allowed(good() | {"scene": in_si}, "scene.dimensional.body.receptance.zzz")
    ours = [f"dimensional.{part}" for part in (*both, "slip.", "transverse_slip.")]
    shorter = {part + key for part in ours for key in _allowed(si, f"scene.{part}zzz")}
    shorter |= {"dimensional.body.receptance", *(f"dimensional.body.receptance.{key}" for key in told)}
    assert {without_unit(key) if key.startswith("dimensional.") else key for key in scene} == found | shorter


def _dotted_keys(tree: dict[str, Any]) -> set[str]:
    """Every dotted key of a scene, of a waveform its kind alone: the schema leaves it to the reader."""
    parts = {key: value for key, value in tree.items() if isinstance(value, dict)}
    below = {key: set(part) if key == "waveform" else _dotted_keys(part) for key, part in parts.items()}
    return {*tree, *(f"{key}.{each}" for key, keys in below.items() for each in keys)}


@some(6, "studies of every kind")
@pytest.mark.parametrize(
    "file",
    sorted(STUDIES.rglob("*.yaml")),  # some bring a plugin's law, which is installed here, too
    ids=lambda file: file.stem,
)
def test_the_studies_use_keys_of_the_schema(file: Path) -> None:
    made, tree = schema(), load_study(file).resolved()

    assert set(tree) <= set(made["properties"])
    assert _dotted_keys(tree["scene"]) <= _keys_of(made, made["properties"]["scene"])


def test_the_schema_and_the_reader_allow_the_same_keys_in_every_law_and_method() -> None:
    made = schema()["properties"]
    laws = {law["title"]: law["properties"] for law in made["laws"]["items"]["oneOf"]}
    methods = {method["title"]: method for method in made["methods"]["items"]["oneOf"] if "title" in method}

    assert list(laws) == registry.law_names()
    assert list(methods) == registry.method_names()
    for name, keys in laws.items():
        allowed = _allowed(good() | {"laws": [{"kind": name, "zzz": 1}]}, "laws[0].zzz")
        assert set(keys) == {"kind", "label", *allowed} - {"none"}
    for name, method in methods.items():
        allowed = _allowed(good() | {"methods": [{"kind": name, "zzz": 1}]}, "methods[0].zzz")
        assert set(method["properties"]) == {"kind", "label", *allowed} - {"none"}


def test_the_schema_and_the_reader_allow_the_same_keys_in_expectations_and_ranges() -> None:
    made = schema()["properties"]
    probe = good() | {"expect": [{"zzz": 1}], "sweep": {"scene.belt_speed": {"zzz": 1}}, "keep": {"zzz": 1}}

    kept = made["keep"]["$ref"], made["expect"]["items"]["$ref"]
    keep, expect = (schema()["$defs"][each.rpartition("/")[2]]["properties"] for each in kept)
    assert set(_allowed(probe, "expect[0].zzz")) == set(expect)
    for one, own in zip(
        made["sweep"]["properties"]["scene.belt_speed"]["oneOf"][1:], ({}, {"within": 1}), strict=True
    ):
        probe["sweep"] = {"scene.belt_speed": {"zzz": 1, **own}}
        assert set(_allowed(probe, "sweep.scene.belt_speed.zzz")) == set(one["properties"])
    assert set(_allowed(probe, "keep.zzz")) == set(keep)


def _properties(made: Any, path: str = "") -> dict[str, Any]:
    """Every property of a schema at any depth, by its path in the schema."""
    if isinstance(made, list):
        return {
            key: each
            for i, item in enumerate(made)
            for key, each in _properties(item, f"{path}[{i}]").items()
        }
    if not isinstance(made, dict):
        return {}
    own = made["properties"] if made.get("type") == "object" and "properties" in made else {}
    found = {f"{path}/{key}": value for key, value in own.items()}
    for key, value in made.items():
        found |= _properties(value, f"{path}/{key}")
    return found


def test_every_property_of_the_schema_says_what_it_means() -> None:
    made = _properties(schema())

    assert len(made) > 300
    assert [path for path, each in made.items() if not each.get("description")] == []
    assert made["/$defs/Drive/unbalance"]["description"].endswith("amplitude unbalance*frequency^2")
    phases = [made[f"/$defs/{part}/phase"] for part in ("DriveInSI", "Drive")]
    assert phases[0]["description"] == phases[1]["description"]


def test_the_schema_gives_bounds_and_no_null_and_lets_a_sweep_give_any_value() -> None:
    made = schema()
    scene = made["properties"]["scene"]["properties"]

    assert scene["damping_ratio"]["minimum"] == 0
    assert scene["normal_load"]["exclusiveMinimum"] == 0
    assert "null" not in str(made)
    assert made["required"] == ["schema", "scene", "laws"]
    assert "required" not in made["properties"]["scene"]
    assert made["properties"]["laws"]["items"]["oneOf"][0]["required"] == ["kind"]
