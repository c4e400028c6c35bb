"""The belt speeds at which stick begins, stick ends and reversal ends, against dense scans of the same curves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.curves.onsets import DistanceAt, change_between

LINE = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 1, "drive": {"amplitude": 10, "frequency": 1}}
"""Fig. 4b of Sulollari, van Dalen & Cabboi."""
COULOMB = {"kind": "coulomb", "mu": 0.4}


def plane(across: float) -> dict[str, Any]:
    return LINE | {
        "transverse": {"natural_frequency": across, "damping_ratio": 0.1, "load": {"amplitude": 10}}
    }


def study(scene: dict[str, Any], speeds: Any, law: dict[str, Any] = COULOMB, **more: Any) -> dict[str, Any]:
    sweep = {"scene.belt_speed": [float(speed) for speed in speeds]}
    return {"schema": 1, "scene": scene, "laws": [law], "sweep": sweep} | more


def found(
    scene: dict[str, Any], speeds: Any, law: dict[str, Any] = COULOMB, **more: Any
) -> dict[str, pd.Series]:
    """The onsets of one curve by their names."""
    onsets = fl.run(study(scene, speeds, law, **more)).onsets
    assert onsets["onset"].is_unique
    return {row["onset"]: row for _, row in onsets.iterrows()}


def largest_velocity(scene: dict[str, Any], law: dict[str, Any], speed: float) -> float:
    """Of x1, over a period."""
    kinds = {"coulomb": fl.Coulomb, "stribeck": fl.Stribeck}
    keys = {name: value for name, value in law.items() if name != "kind"}
    state = fl.steady_state(fl.Scene(**scene | {"belt_speed": speed}), kinds[law["kind"]](**keys))
    return float(np.max(state.orbit(20_000).v1))


def check_both_sides(scene: dict[str, Any], onset: pd.Series, law: dict[str, Any] = COULOMB) -> None:
    """The motions just outside the error are of the kinds that the onset says."""
    place, error = onset["belt_speed"], 1.01 * onset["belt_speed_error"]
    sides = [place - error, place + error]
    if onset["onset"] == "reversal_ends":
        # the column counts signs at nodes: too coarse for the last reversal
        largest = [largest_velocity(scene, law, speed) - speed for speed in sides]
        assert largest[0] > -1e-9 > largest[1]
        return
    sticks = fl.run(study(scene, sides, law)).table["stick_fraction"] > 0.0
    begins = onset["onset"] == "stick_begins"
    assert begins or onset["onset"] == "stick_ends"
    assert sticks.tolist() == [not begins, begins]


def test_fig_4b_sticks_from_43_9_to_v_lin() -> None:
    onsets = found(LINE, np.linspace(0.5, 60.0, 120))

    assert list(onsets) == ["stick_begins", "reversal_ends", "stick_ends"]
    assert onsets["stick_begins"]["belt_speed"] == pytest.approx(43.901751, abs=1e-6)
    assert onsets["stick_begins"]["belt_speed_error"] < 1e-6
    for name in ("reversal_ends", "stick_ends"):
        assert onsets[name]["belt_speed"] == pytest.approx(50.0, abs=1e-10)
        assert onsets[name]["how"] == "closed form: V_lin"
    check_both_sides(LINE, onsets["stick_begins"])
    check_both_sides(LINE, onsets["stick_ends"])


def test_a_window_of_stick_between_two_rows_is_found() -> None:
    onsets = found(LINE, [5.0, 20.0, 43.0, 51.0, 60.0])

    assert onsets["stick_begins"]["belt_speed"] == pytest.approx(43.901751, abs=1e-6)
    assert onsets["stick_ends"]["belt_speed"] == pytest.approx(50.0)


def test_the_end_of_reversal_in_the_plane_has_motions_of_both_kinds_beside_it() -> None:
    onsets = found(plane(1.0), np.linspace(2.0, 60.0, 30))

    assert list(onsets) == ["reversal_ends"]
    assert onsets["reversal_ends"]["belt_speed"] == pytest.approx(41.7984, abs=1e-4)
    check_both_sides(plane(1.0), onsets["reversal_ends"])


@deep("seconds of maps")
@pytest.mark.parametrize("across", [2.0, pytest.param(10.0, marks=deep("seconds of motions near rest"))])
def test_stick_in_the_plane_between_rows_that_slip_is_found(across: float) -> None:
    onsets = found(plane(across), [20.0, 30.0, 40.0, 43.0, 51.0, 60.0])

    assert list(onsets) == ["stick_begins", "reversal_ends", "stick_ends"]
    for onset in onsets.values():
        assert onset["belt_speed_error"] < 1e-3
        check_both_sides(plane(across), onset)


@deep("seconds of maps")
def test_onsets_of_falling_friction_are_between_motions_of_both_kinds() -> None:
    law = {"kind": "stribeck", "mu_kinetic": 0.3, "mu_static": 0.4, "stribeck_speed": 8.0}
    onsets = found(LINE, np.linspace(40.0, 56.0, 17), law)

    assert sorted(onsets) == ["reversal_ends", "stick_begins", "stick_ends"]
    for onset in onsets.values():
        check_both_sides(LINE, onset, law)


def test_a_method_that_solves_for_no_instants_leaves_onsets_between_rows() -> None:
    march = {"kind": "march", "stepper": "moreau", "steps": 400}
    begins = found(LINE, [40.0, 44.5, 48.0], methods=[march])["stick_begins"]

    assert begins["belt_speed"] == 42.25
    assert begins["belt_speed_error"] == 2.25
    assert "between two points of the curve; not located: the method does not" in begins["how"]


def test_a_table_without_their_columns_has_no_onsets() -> None:
    done = fl.run(study(LINE, [40.0, 45.0, 51.0], columns=["velocity_amplitude"]))

    assert done.onsets.empty
    assert list(done.onsets.columns)[-4:] == ["onset", "belt_speed", "belt_speed_error", "how"]


def test_the_command_writes_onsets_and_takes_them_over(tmp_path: Path, monkeypatch: Any) -> None:
    from frictionlab.runner import study_run
    from frictionlab.study.written import yaml_text

    monkeypatch.setattr("frictionlab.cli.run._draw", lambda *_: None)
    file, out = tmp_path / "study.yaml", tmp_path / "out"
    file.write_text(yaml_text(study(LINE, np.linspace(30.0, 55.0, 6), columns=["onsets"])))
    assert cli.main(["run", str(file), "-o", str(out)]) == 0
    text = (out / "onsets.csv").read_bytes()
    names = pd.read_csv(out / "onsets.csv")["onset"].tolist()
    assert names == ["stick_begins", "reversal_ends", "stick_ends"]

    page = (out / "report.html").read_text()
    assert "Onsets along rising belt speed" in page
    assert page.count(">stick begins</td>") == page.count(">stick ends</td>") == 1

    with monkeypatch.context() as patch:
        patch.setattr(study_run, "onset_table", lambda *_: pytest.fail("onsets were found again"))
        assert cli.main(["run", str(file), "-o", str(out)]) == 0
    (out / "onsets.csv").write_bytes(text[:-3])  # damaged
    assert cli.main(["run", str(file), "-o", str(out)]) == 0
    assert (out / "onsets.csv").read_bytes() == text


@pytest.mark.parametrize("jump", [False, True], ids=["kink", "jump"])
def test_a_search_takes_few_calls_where_each_side_is_smooth(jump: bool) -> None:
    asked = []

    def distance(x: float) -> float:
        asked.append(x)
        right = x - 0.7 + 0.1 * (x - 0.7) ** 2
        return (right if x > 0.7 else 20.0 * (x - 0.7)) + (0.3 if jump and x > 0.7 else 0.0)

    place = change_between(distance, DistanceAt(0.0, distance(0.0)), DistanceAt(1.0, distance(1.0)), 1e-8, 60)

    assert abs(place.value - 0.7) <= place.error <= 1e-8
    assert len(asked) < (60 if jump else 16)


def test_a_search_goes_round_places_without_an_answer() -> None:
    def distance(x: float) -> float | None:
        return None if 0.6 < x < 0.65 else x - 0.7

    place = change_between(distance, DistanceAt(0.0, -0.7), DistanceAt(1.0, 0.3), 1e-6, 60)
    assert abs(place.value - 0.7) <= place.error <= 1e-6

    stopped = change_between(lambda x: None, DistanceAt(0.0, -0.7), DistanceAt(1.0, 0.3), 1e-6, 60)
    assert stopped.stopped is not None
    assert abs(stopped.value - 0.7) <= stopped.error


FILM = """
from frictionlab.laws.base import Positive, SlidingLaw


class Film(SlidingLaw):
    mu: Positive

    def sliding_friction(self, speed):
        return self.mu * speed / (1.0 + speed)

    def vanishes_at_rest(self):
        return True
"""


def test_friction_that_vanishes_at_rest_never_sticks_and_its_reversals_end(tmp_path: Path) -> None:
    (tmp_path / "film.py").write_text(FILM)
    of_film = study(LINE, [1.0, 5.0, 9.0, 20.0, 60.0], {"kind": "film", "mu": 0.4})
    of_film |= {"plugins": [str(tmp_path / "film.py")]}
    onsets = fl.run(of_film | {"columns": ["onsets"]}).onsets

    assert onsets["onset"].tolist() == ["reversal_ends"]
    table = fl.run(of_film | {"columns": "all"}).table
    place, speeds = onsets["belt_speed"][0], table["scene.belt_speed"]
    assert table["reversals"][speeds < place].all()
    assert not table["reversals"][speeds > place].any()
