"""Fits to made-up measurements: true numbers found, errors that cover, what data cannot see, bad data."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from maxwell_slip import MaxwellSlip
from profiles import deep
from rate_and_state import RateAndState

import frictionlab as fl
from frictionlab import cli
from frictionlab.analysis.fit.errors import correlation_length, covariances
from frictionlab.analysis.fit.measured import WrongData, given_measurements
from frictionlab.analysis.fit.result import PARTS_OF_A_FIT, FittedLaw
from frictionlab.study.load import parse_study
from frictionlab.values.notes import StudyError

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
SPEEDS = np.linspace(2.0, 58.0, 30)
TIMES = np.linspace(0.0, 60.0, 3001)
SLIPS = np.sin(TIMES)


def curve_of(law: Any, noise: float = 0.0, seed: int = 0, scene: Any = SCENE) -> dict[str, Any]:
    mean = fl.curve(scene, law, SPEEDS, columns=["mean_friction"])["mean_friction"].to_numpy()
    return {
        "belt_speed": SPEEDS,
        "mean_friction": mean + np.random.default_rng(seed).normal(0.0, 1.0, 30) * noise,
    }


def path_of(stiffness: float, mu: float, noise: Any = 0.0) -> dict[str, Any]:
    """Of Jenkins friction, by its own closed form from one sample to the next."""
    friction, force = np.zeros(len(TIMES)), 0.0
    for i, step in enumerate(np.diff(SLIPS), 1):
        force = min(max(force + stiffness * step, -mu), mu)
        friction[i] = force
    return {"time": TIMES, "slip": SLIPS, "friction": friction + noise}


def correlated(size: float, rho: float, seed: int) -> Any:
    rng, noise = np.random.default_rng(seed), np.zeros(len(TIMES))
    for i in range(1, len(noise)):
        noise[i] = rho * noise[i - 1] + np.sqrt(1.0 - rho**2) * rng.normal()
    return size * noise


def test_a_curve_without_noise_gives_its_own_numbers_back() -> None:
    free = {"mu": (0.1, 1), "scene.damping_ratio": (0.02, 1)}
    found = fl.fit(curve_of(fl.Coulomb(mu=0.4)), fl.Coulomb(mu=0.9), SCENE, free, threads=2)
    assert found.values == pytest.approx({"mu": 0.4, "scene.damping_ratio": 0.1}, rel=1e-6)
    assert found.law == fl.Coulomb(mu=found.values["mu"])
    assert found.scene is not None
    assert found.scene.damping_ratio == found.values["scene.damping_ratio"]


@deep("seconds of fits")
def test_intervals_hold_the_true_numbers_of_independent_noise() -> None:
    """18 of 20 or more at 95 %: fewer has a chance of 1.6 % where the rate is nominal."""
    held = 0
    for seed in range(20):
        found = fl.fit(
            curve_of(fl.Coulomb(mu=0.4), 0.003, seed), fl.Coulomb(mu=0.3), SCENE, {"mu": (0.1, 1.0)}, starts=2
        )
        low, high = found.intervals["mu"]
        held += low <= 0.4 <= high
        assert 0.5 < found.block_errors["mu"] / found.naive_errors["mu"] < 2.0
    assert held >= 18


@deep("seconds of fits")
def test_blocks_cover_where_noise_is_correlated_and_naive_errors_do_not() -> None:
    by_blocks = naive = 0
    for seed in range(12):
        data = path_of(4.0, 0.4, correlated(0.02, 0.99, seed))
        found = fl.fit(
            data,
            fl.Jenkins(mu=0.3, stiffness=2.0),
            free={"mu": (0.1, 1.0), "stiffness": (1.0, 20.0)},
            starts=2,
        )
        off = abs(found.values["mu"] - 0.4)
        by_blocks += off <= 2.26 * found.block_errors["mu"]
        naive += off <= 1.96 * found.naive_errors["mu"]
    assert by_blocks >= 10
    assert naive <= 7


@pytest.mark.parametrize("deciding", [4, 30])
def test_intervals_cover_however_few_rows_decide_a_number(deciding: int) -> None:
    rng, slopes = np.random.default_rng(3), np.full((30, 1), 0.05)
    slopes[:deciding] = 1.0
    held = 0
    for noise in rng.standard_normal((2000, 30)):
        off = float(slopes[:, 0] @ noise / (slopes**2).sum())
        found = covariances(slopes, noise - slopes[:, 0] * off, np.arange(30), False)
        held += abs(off) <= found.quantile[0] * math.sqrt(found.by_blocks[0, 0])

    assert 0.93 < held / 2000 < 0.99


def test_stated_errors_weigh_rows() -> None:
    data = curve_of(fl.Coulomb(mu=0.4))
    data["mean_friction"][:3] += 0.1
    sigma = np.full(30, 1e-3)
    sigma[:3] = 1e3
    weighed = fl.fit(data | {"sigma": sigma}, fl.Coulomb(mu=0.3), SCENE, {"mu": (0.1, 1.0)}, starts=2)
    assert weighed.values["mu"] == pytest.approx(0.4, abs=1e-6)


def test_what_slow_data_cannot_see_is_flat() -> None:
    """The damping of bristles that hardly move."""
    law = fl.LuGre(mu_kinetic=0.4, stiffness=4.0, damping=1e-3)
    slow = {"time": 1e4 * TIMES, "slip": SLIPS, "friction": path_of(4.0, 0.4)["friction"]}
    free = {"damping": {"from": 1e-4, "to": 1e-1, "spacing": "log"}, "mu_kinetic": (0.3, 0.5)}
    found = fl.fit(slow, law, free=free, starts=2)
    assert found.shapes["damping"] == "flat"
    assert "the profile of damping is flat" in found.sentences


def test_a_number_on_an_end_of_its_range_is_named() -> None:
    found = fl.fit(curve_of(fl.Coulomb(mu=0.4)), fl.Coulomb(mu=0.5), SCENE, {"mu": (0.45, 1.0)}, starts=2)
    assert found.table["at_bound"].tolist() == [True]
    assert "mu is on an end of its range, 0.45" in found.sentences


@deep("seconds of fits")
def test_the_law_that_foretells_best_is_told_first_and_a_simpler_one_that_does_as_well_is_named() -> None:
    data = path_of(4.0, 0.4, 0.01 * np.random.default_rng(1).normal(size=len(TIMES)))
    laws = [
        fl.Dahl(mu=0.4, stiffness=4.0),
        fl.Jenkins(mu=0.4, stiffness=4.0),
        fl.ElastoPlastic(mu_kinetic=0.4, stiffness=4.0, breakaway_ratio=0.9),
    ]
    free = {
        "mu": (0.1, 1.0),
        "mu_kinetic": (0.1, 1.0),
        "stiffness": (1.0, 20.0),
        "breakaway_ratio": (0.5, 0.999),
    }
    found = fl.fit(data, laws, free=free, starts=3)
    assert found.laws.set_index("law")["left_out_rms"].idxmax() == "Dahl"
    assert any(line.startswith("Dahl fits worse") for line in found.sentences)
    assert found.laws["left_out_rms"].min() == pytest.approx(0.01, rel=0.05)
    assert set(found.residuals["law"]) == {"Dahl", "Jenkins", "ElastoPlastic"}


def test_a_misfit_in_a_few_rows_is_no_scatter() -> None:
    law = fl.Dahl(mu=0.4, presliding_length=3.0)
    free = {"mu": (0.1, 1.0), "presliding_length": (0.1, 100.0)}
    found = fl.fit(curve_of(law, 1e-3, 1), [fl.Coulomb(mu=0.4), law], SCENE, free, starts=2)

    assert found.best.model.words == "Dahl"
    assert any(sentence.startswith("Coulomb fits worse") for sentence in found.sentences)


def test_the_correlation_length_is_that_of_the_noise() -> None:
    assert correlation_length(np.random.default_rng(0).normal(size=4000)) < 1.5
    assert correlation_length(correlated(1.0, 0.9, 0)) == pytest.approx((1 + 0.9) / (1 - 0.9), rel=0.4)


GOOD = {"belt_speed": [1.0, 2.0, 3.0], "mean_friction": [0.1, 0.2, 0.3]}


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({"belt_speed": [1.0]}, "the column 'mean_friction' is missing, there are belt_speed"),
        ({"1": [2.0], "0.2": [0.3]}, "its first line has numbers; .* such as belt_speed,mean_friction"),
        (
            {"belt_speeds": [1.0], "mean_friction": [1.0]},
            "'belt_speed' is missing.*did you mean 'belt_speeds'",
        ),
        (
            GOOD | {"scene.drive.unbalanse": [1.0] * 3},
            "no number of a scene is .*did you mean scene.drive.unbalance",
        ),
        (
            GOOD | {"scene.dimensional.mass": [1.0] * 3},
            "tells no unit: its name is scene.dimensional.mass_kg",
        ),
        (GOOD | {"sigma": [1.0, 0.0, 1.0]}, "sigma must be > 0, got 0 in row 2"),
        (GOOD | {"block": ["a", "a", "a"]}, "all rows are of one block"),
        (GOOD | {"mean_friction": [0.1, np.nan, 0.3]}, "mean_friction is nan in row 2"),
        (GOOD | {"belt_speed": [1.0, "two", 3.0]}, "belt_speed must be numbers, got 'two' in row 2"),
        (
            {"time": [0.0, 1.0, 0.5], "slip": [0.0, 1.0, 2.0], "friction": [0.1] * 3},
            "time must rise, but goes from 1 to 0.5 in row 3",
        ),
        ({"time": [0.0], "slip": [0.0], "friction_N": [1.0]}, "friction_N needs the column normal_load_N"),
    ],
)
def test_bad_measurements_are_told_with_their_row(data: Any, said: str) -> None:
    with pytest.raises(WrongData, match=said):
        given_measurements(data)


def test_missing_samples_of_a_path_are_left_out_and_told() -> None:
    data = path_of(4.0, 0.4)
    data["friction"][100:110] = np.nan
    found = fl.fit(data, fl.Jenkins(mu=0.3, stiffness=4.0), free={"mu": (0.1, 1.0)}, starts=1)
    assert len(found.measured.pieces) == 2
    assert found.values["mu"] == pytest.approx(0.4, abs=1e-6)
    assert "10 samples are missing and were left out" in found.sentences


def test_numbers_of_a_list_are_found_one_by_one() -> None:
    data = path_of(4.0, 0.3)
    data["friction"] = data["friction"] + path_of(1.0, 0.2)["friction"]
    law = MaxwellSlip(mu=(0.2, 0.1), stiffness=(3.0, 0.5))
    true = {"mu[0]": 0.3, "mu[1]": 0.2, "stiffness[0]": 4.0, "stiffness[1]": 1.0}
    found = fl.fit(data, law, free={name: (0.5 * x, 1.8 * x) for name, x in true.items()}, starts=4)
    assert found.values == pytest.approx(true, rel=1e-5)
    assert isinstance(found.law, MaxwellSlip)
    assert found.law.mu == pytest.approx((0.3, 0.2), rel=1e-5)


@deep("more kernels to compile")
def test_a_step_of_speed_tells_the_numbers_of_rate_and_state() -> None:
    """After the step the age is D/v2 + (D/v1 - D/v2) exp(-slip/D): Dieterich's ageing law at constant speed."""
    times = np.linspace(-10.0, 10.0, 401)
    speeds, slips = np.where(times > 0.0, 10.0, 3.0), np.where(times > 0.0, 10.0, 3.0) * times
    age = 8.0 * (1.0 / speeds + np.where(times > 0.0, (1.0 / 3.0 - 0.1) * np.exp(-slips / 8.0), 0.0))
    friction = 0.6 + 0.008 * np.log(speeds / 3.0) + 0.011 * np.log(3.0 * age / 8.0)
    law = RateAndState(mu=0.5, a=0.01, b=0.01, slip_length=3.0, reference_speed=3.0)
    free = {"mu": (0.4, 0.8), "a": (0.001, 0.05), "b": (0.001, 0.05), "slip_length": (1.0, 40.0)}
    found = fl.fit({"time": times, "slip": slips, "friction": friction}, law, free=free, starts=2)
    assert found.values == pytest.approx({"mu": 0.6, "a": 0.008, "b": 0.011, "slip_length": 8.0}, rel=1e-4)


SHAKEN = {"velocity_amplitude": "20 mm/s", "frequency": "50 Hz"}
IN_SI = fl.Scene.si(slip=SHAKEN, normal_load="30 N", belt_speed="5 mm/s")


def test_measurements_and_ranges_may_have_units() -> None:
    law = fl.Dahl(mu=0.4, presliding_length="20 um")
    speeds = np.linspace(2, 18, 9)
    forces = fl.curve(IN_SI, law, speeds * 1e-3)["mean_friction_N"]
    data = {"belt_speed": speeds, "mean_friction": forces / 1e3, "sigma": 1e-6 + 0.0 * speeds}
    units = {"belt_speed": "mm/s", "mean_friction": "kN", "sigma": "kN"}
    free = {"mu": (0.1, "60 %"), "presliding_length": ("1 um", "0.1 mm")}
    found = fl.fit(data, fl.Dahl(mu=0.3, presliding_length=5e-6), IN_SI, free, starts=2, units=units)

    assert found.values == pytest.approx({"mu": 0.4, "presliding_length": 2e-5}, rel=1e-4)
    length = found.params["presliding_length"]
    assert (length.min, length.max, length.unit) == (1e-6, pytest.approx(1e-4), "m")
    assert set(length.correl) == {"mu"}
    assert abs(length.correl["mu"]) <= 1.0
    assert any(line.startswith("presliding_length = 20 µm (95 %: ") for line in found.sentences)


def test_rows_beyond_the_end_of_reversal_are_said_to_tell_nothing_of_the_motion() -> None:
    speeds = np.linspace(60, 90, 6)
    data = {"belt_speed": speeds, "mean_friction": 0.4 + 1e-3 * np.sin(speeds)}
    (said,) = [
        line
        for line in fl.fit(data, fl.Coulomb(mu=0.3), SCENE, {"mu": (0.1, 1)}, starts=2).sentences
        if "V_lin" in line
    ]
    assert said.startswith("all rows lie beyond V_lin = ")


@pytest.mark.parametrize(
    ("told", "said"),
    [
        (
            {"data": {"units": {"belt_speed": "mm"}}},
            r"data\.units\.belt_speed: .*is a length \[m\]; give a speed",
        ),
        ({"data": {"units": {"block": "mm"}}}, r"data\.units\.block: has no unit; belt_speed, mean_friction"),
        (
            {"free": {"presliding_length": ["1 mm/s", "2 mm/s"]}},
            r"free\.presliding_length: .*give a length \[m\]",
        ),
        ({"free": {"mu": ["60 %", "10 %"]}}, r"free\.mu: must rise, got 0\.6 to 0\.1"),
        (
            {"scene": {"belt_speed": 1, "slip": {"velocity_amplitude": 1, "frequency": 1}}},
            "data.units: go with a scene",
        ),
    ],
)
def test_wrong_units_are_told(told: dict[str, Any], said: str, tmp_path: Path) -> None:
    (tmp_path / "measured.csv").write_text("belt_speed,mean_friction\n1,2\n3,4\n")
    data = {"file": str(tmp_path / "measured.csv"), "units": {"belt_speed": "mm/s"}}
    laws = [{"kind": "dahl", "mu": 0.3, "presliding_length": 1e-6}]
    scene = {"dimensional": {"slip": SHAKEN, "belt_speed": "1 mm/s"}}
    tree = {"schema": 1, "scene": scene, "laws": laws, "free": {"mu": [0.1, 1]}} | told
    with pytest.raises(StudyError, match=said):
        parse_study(tree | {"data": data | told.get("data", {})})


@pytest.mark.parametrize(
    ("free", "said"),
    [
        ({}, "free must be a mapping such as"),
        ({"muu": (0.1, 1.0)}, "no number 'muu'.*did you mean 'mu'"),
        ({"mu": (1.0, 0.1)}, "free.mu: must rise, got 1 to 0.1"),
        ({"mu": 0.4}, "free.mu: must be a range such as"),
        ({"mu": {"from": 0.0, "to": 1.0, "spacing": "log"}}, "a log range must begin above 0"),
    ],
)
def test_bad_ranges_are_told(free: Any, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        fl.fit(GOOD, fl.Coulomb(mu=0.4), SCENE, free)


STUDY = """schema: 1
title: Made up
scene: {damping_ratio: 0.1, normal_load: 10, belt_speed: 5, drive: {unbalance: 10, frequency: 1}}
laws: [{kind: coulomb, mu: 0.3}]
data: {file: measured.csv, columns: {belt_speed: v, mean_friction: mu_bar}}
free: {mu: [0.1, 1.0]}
"""


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    table = pd.DataFrame(curve_of(fl.Coulomb(mu=0.4), 0.001)).rename(
        columns={"belt_speed": "v", "mean_friction": "mu_bar"}
    )
    table.to_csv("measured.csv", index=False)
    Path("study.yaml").write_text(STUDY)
    return tmp_path / "study.yaml"


def test_the_command_writes_tables_a_figure_and_a_page(
    study: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["fit", str(study), "-j", "1"]) == 0
    told, folder = capsys.readouterr().out, study.parent / "fits" / "study"
    assert told.startswith("Coulomb fits with an rms of ")
    fitted = pd.read_csv(folder / "fit.csv")
    assert fitted["value"].to_list() == pytest.approx([0.4], abs=0.002)
    names = "law parameter value unit block_error naive_error low high shape at_bound"
    assert list(fitted) == names.split()
    assert {"fit.svg", "fit.png"} == {path.name for path in (folder / "figures").iterdir()}
    assert "coulomb" in (folder / "report.html").read_text()
    assert len(pd.read_csv(folder / "residuals.csv")) == 30
    study.write_text(STUDY.replace("[0.1, 1.0]", "[0.2, 1.0]"))
    assert cli.main(["fit", str(study)]) == 2
    assert "has a fit of another study: --force replaces it" in capsys.readouterr().err
    assert cli.main(["fit", str(study), "--force"]) == 0


@deep("seconds of fits")
def test_an_interrupt_keeps_the_laws_that_are_done(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    other = STUDY.replace("mu: 0.3}]", "mu: 0.3, label: one}, {kind: coulomb, mu: 0.3, label: other}]")
    study.write_text(other)

    def stopped(law: FittedLaw) -> Any:
        if law.model.label == "other":
            raise KeyboardInterrupt
        return law.left_out

    monkeypatch.setitem(PARTS_OF_A_FIT, "blocks left out", stopped)
    assert cli.main(["fit", str(study)]) == 130
    assert "other has no fit: interrupted" in capsys.readouterr().out
    assert pd.read_csv(study.parent / "fits" / "study" / "fit.csv")["law"].to_list() == ["one"]


def test_blocks_given_beside_are_checked_as_a_column_is() -> None:
    with pytest.raises(WrongData, match="all rows are of one block"):
        fl.fit(GOOD, fl.Coulomb(mu=0.4), SCENE, {"mu": (0.1, 1.0)}, blocks=[1, 1, 1])
    with pytest.raises(WrongData, match="one label a row is needed, 3, got 2"):
        fl.fit(GOOD, fl.Coulomb(mu=0.4), SCENE, {"mu": (0.1, 1.0)}, blocks=[1, 2])


@deep("seconds of fits")
def test_run_solves_the_study_where_it_was_measured(study: Path) -> None:
    assert cli.main(["run", str(study), "-o", "out"]) == 0
    table = pd.read_csv(study.parent / "out" / "results.csv")
    assert table["scene.belt_speed"].to_list() == pytest.approx(SPEEDS.tolist())


@pytest.mark.parametrize(
    ("was", "becomes", "said"),
    [
        ("free: {mu: [0.1, 1.0]}\n", "", "a study to fit has data and free"),
        (
            "file: measured.csv",
            "file: measurd.csv",
            r"study.yaml:5:14: data.file: there is no file .*\n.*\n.*\n.*measured.csv",
        ),
        ("v, mean", "w, mean", "there is no column 'w', there are v, mu_bar"),
        ("[0.1, 1.0]", "[1.0, 0.1]", "free.mu: must rise, got 1 to 0.1"),
        (
            "[0.1, 1.0]",
            "{from: 0, to: 1, spacing: log}",
            r"study.yaml:\d+:\d+: free.mu: a log range must begin",
        ),
        ("data: {", "datas: {", "did you mean 'data'"),
    ],
)
def test_bad_studies_are_told(
    study: Path, was: str, becomes: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    study.write_text(STUDY.replace(was, becomes))
    assert cli.main(["fit", str(study)]) == 2
    assert re.search(said, capsys.readouterr().err)


def test_a_law_that_knows_no_rate_needs_no_times() -> None:
    slip = np.sin(np.linspace(0.0, 12.0, 200))
    friction = 0.5 * np.sign(np.diff(slip))
    data = {"slip": slip[1:], "friction": friction}

    assert fl.fit(data, fl.Coulomb(mu=0.3), free={"mu": (0.1, 1.0)}).values["mu"] == pytest.approx(0.5)
    with pytest.raises(ValueError, match="LuGre depends on how quick slip is: the column 'time' is missing"):
        fl.fit(data, fl.LuGre(mu_kinetic=0.3, stiffness=9, damping=1), free={"mu_kinetic": (0.1, 1.0)})
