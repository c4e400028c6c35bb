"""Figures, tables of a page and sentences have the units in which a study in SI units was written."""

from __future__ import annotations

import matplotlib as mpl
import matplotlib.figure
import numpy as np
import pytest
from drawn_figures import names_of
from matplotlib.backends.backend_agg import FigureCanvasAgg

import frictionlab as fl
from frictionlab.charts.figures import FigureData, Kept, figures_of
from frictionlab.charts.sheet import STYLE, write_heading
from frictionlab.charts.sweeps import SweptValue
from frictionlab.runner.summary import summary
from frictionlab.runner.table import whole
from frictionlab.values.units import handy_unit, in_shown_units

DRIVE = "scene.dimensional.drive.frequency"
SPEED = "scene.dimensional.belt_speed"


@pytest.fixture(scope="module")
def run() -> fl.Run:
    body = {"mass": "0.5 kg", "stiffness": "5 kN/m", "damping": "5 N s/m", "belt_speed": "2 mm/s"}
    study = {
        "schema": 1,
        "scene": {"dimensional": body | {"drive": {"amplitude": "20 N"}}},
        "laws": [{"kind": "coulomb", "mu": 0.3}],
        "sweep": {
            SPEED: {"start": "10 mm/s", "stop": "600 mm/s", "num": 12},
            DRIVE: ["600 rpm", "1200 rpm"],
        },
        "columns": ["usual", "onsets"],
        "keep": {"orbit": 8, "harmonics": 1},
    }
    return fl.run(study)


def test_figures_have_the_units_that_were_written(run: fl.Run) -> None:
    table, found = whole(run.table), run.study.units
    kept = Kept(lambda rows: run.orbits, run.harmonics)
    data = FigureData(table, "T", run.onsets, run.curves, kept=kept, units=found)
    with mpl.rc_context(STYLE):
        drawn = {name: draw() for name, draw in figures_of(data).items()}
    mean, velocity, phase = (drawn[name].axes for name in ("mean_friction", "velocity", "phase"))

    assert mean[0].get_xlabel() == "belt speed $V_b$ [mm/s]"
    assert velocity[0].get_ylabel().endswith("[mm/s]")
    assert phase[0].get_ylabel().endswith("[mm/s]")
    assert phase[-1].get_xlabel().endswith("m]")
    assert drawn["velocity_harmonics"].axes[0].get_ylabel().endswith("[mm/s]")
    assert {*names_of(drawn["mean_friction"])} >= {"600 rpm", "1200 rpm"}
    ends = 1e3 * run.curves["reversal_end_m_per_s"]
    lines = {float(line.get_xdata()[0]) for line in mean[0].lines if len(set(line.get_xdata())) == 1}
    assert all(min(abs(np.array([*lines]) / end - 1.0)) < 1e-9 for end in ends if end < 600)


def test_a_run_in_words_has_them(run: fl.Run) -> None:
    assert "drive.frequency 600 rpm " in summary(run)


def test_shown_numbers_times_their_units_are_those_of_the_table(run: fl.Run) -> None:
    shown = in_shown_units(run.table, run.study.units)
    sizes = {"mm/s": 1e-3, "rpm": 2.0 * np.pi / 60.0, "kN/m": 1e3, "ms": 1e-3, "s": 1.0, "kg": 1.0, "N": 1.0}

    assert in_shown_units(shown, run.study.units) is not run.table
    for name in shown:
        plain, _, unit = name.partition(" in ")
        if unit in sizes:
            assert shown[name].to_numpy() * sizes[unit] == pytest.approx(
                run.table[plain].to_numpy(), nan_ok=True
            )
    assert f"{SPEED}_m_per_s in mm/s" in shown


@pytest.mark.parametrize(
    ("largest", "unit"), [(2e-6, "µm"), (0.9e-9, "nm"), (1e-3, "mm"), (0.0, "m"), (3e9, "Mm")]
)
def test_a_handy_unit_has_a_number_of_readable_size(largest: float, unit: str) -> None:
    assert handy_unit("m", largest).unit == unit


def test_numbers_without_a_unit_are_shown_in_that_of_the_scene() -> None:
    body = {"mass": "0.5 kg", "stiffness": "5 kN/m", "damping": "5 N s/m", "belt_speed": "2 mm/s"}
    scene = fl.Scene.si(**body, drive={"amplitude": "20 N", "frequency": "10 Hz"})
    found = fl.compare(scene, fl.Coulomb(mu=0.3), belt_speed=[0.01, 0.02])

    assert found.plot().axes[0].get_xlabel() == "belt speed $V_b$ [mm/s]"


def test_a_title_too_long_for_its_picture_takes_several_lines() -> None:
    figure = mpl.figure.Figure(figsize=(3.0, 2.0))
    figure.set_canvas(FigureCanvasAgg(figure))
    axes = figure.add_subplot()
    write_heading(axes, "load amplitude = 10 N, belt speed = 7.4 cm/s, law", 200.0)

    assert axes.get_title(loc="left") == "load amplitude = 10 N,\nbelt speed = 7.4 cm/s, law"


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("scene.dimensional.transverse.stiffness_N_per_m", 4.737e7, "47.37 MN/m"),
        ("scene.dimensional.transverse.stiffness_N_per_m", -3e5, "-300 kN/m"),
        ("scene.dimensional.transverse.stiffness_N_per_m", 5.0, "5 N/m"),
        ("scene.dimensional.transverse.stiffness_N_per_m", 0.0, "0 N/m"),
        ("scene.dimensional.slip.displacement_amplitude_m", 3e-6, "3 µm"),
        ("law.presliding_length in um", 3.0, "3 µm"),
        ("scene.drive.frequency", 1e7, "1e+07"),
    ],
)
def test_a_swept_number_in_si_units_has_a_prefix_where_it_needs_one(
    name: str, value: float, told: str
) -> None:
    assert SweptValue(name, value).text == told
