"""Scenes in SI units: the same physics after one conversion, whatever the units and the length scale."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
import pytest
from drawn_figures import drawn
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field
from strategies import scenes_in_the_plane, scenes_on_the_line, sizes

import frictionlab as fl
from frictionlab.charts.curves import family_of
from frictionlab.charts.figures import FigureData
from frictionlab.laws.base import Dimension, Positive, Record
from frictionlab.scene.dimensional import Dimensional
from frictionlab.scene.scene import Scene
from frictionlab.scene.units import Units, scaled_law
from frictionlab.study.load import parse_study
from frictionlab.theory import friction_free_velocity
from frictionlab.values.columns import SI
from frictionlab.values.notes import StudyError
from frictionlab.values.quantities import dimensions

MU = 0.4
LAW = fl.Coulomb(mu=MU)

BODY: dict[str, Any] = {
    "mass_kg": 2.0,
    "stiffness_N_per_m": 800.0,
    "damping_N_s_per_m": 8.0,
    "length_m": 1e-3,
    "belt_speed_m_per_s": 0.02,
    "drive": {"unbalance_kg_m": 0.03, "frequency_rad_per_s": 25.0},
}
ACROSS: dict[str, Any] = {
    "stiffness_N_per_m": 500.0,
    "damping_N_s_per_m": 5.0,
    "load": {"amplitude_N": 9.0, "phase": 60.0},
}
PLANAR = BODY | {"transverse": ACROSS}


def in_si(scene: Scene, mass: float, stiffness: float, length: float) -> dict[str, Any]:
    """The body of this mass, stiffness and length scale that a nondimensional scene speaks of (Eq. 2)."""
    omega, force, told = math.sqrt(stiffness / mass), stiffness * length, dict[str, Any](scene.values())
    body: dict[str, Any] = {
        "mass_kg": mass,
        "stiffness_N_per_m": stiffness,
        "damping_N_s_per_m": 2.0 * told["damping_ratio"] * mass * omega,
        "length_m": length,
        "gravity_m_per_s2": told["normal_load"] * force / mass,
        "belt_speed_m_per_s": told["belt_speed"] * omega * length,
        "drive": {
            "amplitude_N": told["drive.amplitude"] * force,
            "frequency_rad_per_s": told["drive.frequency"] * omega,
            "phase": told["drive.phase"],
        },
    }
    if scene.transverse is not None:
        omega_2 = told["transverse.natural_frequency"] * omega
        # an unbalance whose force has this amplitude: m r omega^2
        unbalance = told["transverse.load.amplitude"] * force / (told["drive.frequency"] * omega) ** 2
        body["transverse"] = {
            "stiffness_N_per_m": mass * omega_2**2,
            "damping_N_s_per_m": 2.0 * told["transverse.damping_ratio"] * mass * omega_2,
            "load": {"unbalance_kg_m": unbalance, "phase": told["transverse.load.phase"]},
        }
    return body


def si_scene(**body: Any) -> Scene:
    return Scene.si(**body)


# One physics


bodies = st.tuples(sizes(1e-3, 1e4), sizes(1e-1, 1e9), sizes(1e-9, 1.0))


@given(scenes_on_the_line() | scenes_in_the_plane(), bodies)
def test_the_conversion_is_that_of_equation_2_to_rounding(scene: Scene, body: Any) -> None:
    found, wanted = si_scene(**in_si(scene, *body)).mass(), scene.mass()

    np.testing.assert_allclose(np.array(found[:8]), np.array(wanted[:8]), rtol=1e-13)


def test_the_numbers_of_one_body_are_those_worked_out_by_hand() -> None:
    scene = si_scene(**PLANAR | {"initial": {"x_m": 2e-3, "velocity2_m_per_s": 0.04}})

    # omega_1 = 20 rad/s, omega_1 L = 0.02 m/s, K_1 L = 0.8 N
    assert scene.values() == pytest.approx(
        scene.given_values()
        | {
            "damping_ratio": 0.1,
            "normal_load": 2 * 9.81 / 0.8,
            "belt_speed": 1.0,
            "drive.unbalance": 15.0,
            "drive.phase": 0.0,
            "drive.frequency": 1.25,
            "transverse.natural_frequency": math.sqrt(500 / 800),
            "transverse.damping_ratio": 5 / (2 * math.sqrt(500 * 2)),
            "transverse.load.amplitude": 11.25,
            "transverse.load.phase": 60.0,
            "initial.x": 2.0,
            "initial.velocity": 0.0,
            "initial.x2": 0.0,
            "initial.velocity2": 2.0,
        }
    )
    assert scene.initial is not None
    assert scene.initial.model_fields_set == {"x", "velocity2"}


def test_a_normal_load_in_newton_stands_for_the_weight() -> None:
    weight = si_scene(**BODY)
    pressed = si_scene(**BODY | {"normal_load_N": 2 * 9.81})

    assert pressed.normal_load == weight.normal_load
    assert Scene(**pressed.given()) == pressed
    assert si_scene(**BODY | {"gravity_m_per_s2": 1.62}).normal_load == pytest.approx(2 * 1.62 / 0.8)


# Units

# powers of kilogram, metre and second of what a name ends in
UNITS = {
    "kg": (1, 0, 0),
    "N_per_m": (1, 0, -2),
    "N_s_per_m": (1, 0, -1),
    "m": (0, 1, 0),
    "m_per_s2": (0, 1, -2),
    "m_per_s": (0, 1, -1),
    "kg_m": (1, 1, 0),
    "N": (1, 1, -2),
    "rad_per_s": (0, 0, -1),
    "J": (1, 2, -2),
    "s": (0, 0, 1),
}


def unit_of(name: str) -> tuple[int, int, int]:
    """Of the longest unit a name ends in; none for a phase."""
    ends = [unit for unit in UNITS if name.endswith(f"_{unit}")]
    return UNITS[max(ends, key=len)] if ends else (0, 0, 0)


def in_units(tree: dict[str, Any], units: tuple[float, float, float]) -> dict[str, Any]:
    """The same body with its numbers in other units of mass, length and time."""
    return {
        key: in_units(value, units)
        if isinstance(value, dict)
        else value / math.prod(u**p for u, p in zip(units, unit_of(key), strict=True))
        for key, value in tree.items()
    }


@pytest.mark.parametrize("body", [BODY, PLANAR], ids=["line", "plane"])
def test_every_column_in_si_units_has_the_unit_its_name_ends_in(body: dict[str, Any]) -> None:
    body = body | {"gravity_m_per_s2": 9.81}
    units = (0.45359237, 0.3048, 60.0)  # pound, foot, minute
    both = (fl.steady_state(si_scene(**tree), LAW, tolerance=1e-12) for tree in (body, in_units(body, units)))
    si, other = (state.si for state in both)

    assert set(si) == set(SI)
    for name in (name for name in SI if "error" not in name):
        size = math.prod(unit**power for unit, power in zip(units, unit_of(name), strict=True))
        assert size != 1.0
        assert other[name] * size == pytest.approx(si[name], rel=1e-9, nan_ok=True), name
    assert unit_of("error_N") == UNITS["N"]


@pytest.mark.parametrize("body", [BODY, PLANAR], ids=["line", "plane"])
def test_forces_and_energies_in_si_units_balance(body: dict[str, Any]) -> None:
    scene = si_scene(**body)
    state = fl.steady_state(scene, LAW, tolerance=1e-10)
    assert scene.dimensional is not None
    orbit, scales, told = state.orbit(20000), scene.dimensional.scales, state.si
    speed, dashpot = orbit.v1 * scales.velocity, BODY["damping_N_s_per_m"]
    transverse = (
        ACROSS["damping_N_s_per_m"] * (orbit.v2 * scales.velocity) ** 2 if "transverse" in body else 0.0
    )

    # the spring holds what friction drags, on the mean [N]
    assert BODY["stiffness_N_per_m"] * orbit.x1.mean() * scales.length == pytest.approx(
        told["mean_friction_N"], rel=1e-4
    )
    assert told["mean_friction_N"] == pytest.approx(state.mean_friction * 2 * 9.81)
    assert told["error_N"] == pytest.approx(state.error * 2 * 9.81)
    assert told["period_s"] == pytest.approx(2 * math.pi / 25.0)
    assert told["velocity_amplitude_m_per_s"] == pytest.approx(np.ptp(speed) / 2, rel=1e-6)
    # what the loads put in is lost in the dashpots and taken by friction; the belt's drive pays the rest [J]
    assert told["energy_input_J"] == pytest.approx(told["energy_viscous_J"] + told["energy_friction_J"])
    lost = np.mean(dashpot * speed**2 + transverse) * told["period_s"]
    assert told["energy_viscous_J"] == pytest.approx(lost, rel=1e-6)
    paid = told["mean_friction_N"] * BODY["belt_speed_m_per_s"] * told["period_s"]
    assert told["energy_contact_J"] == pytest.approx(told["energy_friction_J"] + paid)


# Laws


def test_a_law_without_a_parameter_of_speed_or_length_stays_the_very_same() -> None:
    assert scaled_law(LAW, Units(1e-3, 0.05, 0.8)) is LAW
    assert dimensions(fl.Coulomb) == {}


def test_bounds_of_a_parameter_are_those_of_the_number_given_and_a_number_without_size_is_told() -> None:
    class Short(Record):
        reach: Annotated[Positive, Dimension(length=1), Field(le=0.01)]

    assert scaled_law(Short(reach=0.005), Units(1e-3, 1.0, 1.0)).reach == pytest.approx(5.0)
    with pytest.raises(OverflowError, match=r"reach: 0\.005 in SI units is inf in those of the scene"):
        scaled_law(Short(reach=0.005), Units(1e-320, 1.0, 1.0))
    laws = [{"kind": "dahl", "mu": MU, "presliding_length": 1.7e308}]
    with pytest.raises(StudyError, match=r"presliding_length: .* in SI units is inf"):
        parse_study({"schema": 1, "scene": {"dimensional": BODY | {"length_m": 1e-6}}, "laws": laws})


STRIBECK: dict[str, Any] = {"kind": "stribeck", "mu_static": 0.5, "mu_kinetic": 0.3, "viscosity": 0.02}


def study(**changes: Any) -> dict[str, Any]:
    return {"schema": 1, "scene": {"dimensional": BODY}, "laws": [{"kind": "coulomb", "mu": MU}], **changes}


def test_a_law_given_in_si_units_is_converted_for_the_method_and_kept_in_the_table() -> None:
    law = STRIBECK | {"stribeck_speed": 0.05}
    told = fl.run(study(laws=[law], tolerance=1e-9)).table.iloc[0]
    scene = si_scene(**BODY)
    plain = Scene(
        **{key: value for key, value in scene.model_dump(exclude_none=True).items() if key != "dimensional"}
    )
    there = fl.Stribeck(mu_static=0.5, mu_kinetic=0.3, stribeck_speed=0.05 / 0.02, viscosity=0.02 * 0.02)
    wanted = fl.steady_state(plain, there, tolerance=1e-9)

    assert told["status"] == wanted.status == "ok"
    assert abs(told["mean_friction"] - wanted.mean_friction) <= told["error"] + wanted.error
    assert (told["law.stribeck_speed"], told["law.nondimensional.stribeck_speed"]) == (
        0.05,
        pytest.approx(2.5),
    )
    assert (told["law.viscosity"], told["law.nondimensional.viscosity"]) == (0.02, pytest.approx(4e-4))
    python = fl.steady_state(scene, fl.Stribeck(**{key: x for key, x in law.items() if key != "kind"}))
    assert python.mean_friction == pytest.approx(wanted.mean_friction, abs=1e-8)


# The table


def test_the_table_keeps_both_sets_of_columns_and_only_where_there_are_two() -> None:
    both = fl.run(study(columns="all")).table
    scene = si_scene(**BODY)
    plain = fl.curve(
        Scene(damping_ratio=0.1, normal_load=1, belt_speed=1, drive={"unbalance": 1, "frequency": 1}),
        LAW,
        1.0,
    )

    for path, value in scene.values().items():
        assert both[f"scene.{path}"].tolist() == [value]
    in_si = [name for name in SI if "drift" not in name]
    assert list(both.columns[-len(in_si) :]) == in_si
    assert not [name for name in plain.columns if name in SI or "dimensional" in name]
    for name in in_si:
        made = SI[name]
        assert both[name].notna().tolist() == both[made.column].notna().tolist()


def test_belt_speeds_in_python_are_in_the_units_of_the_scene() -> None:
    table = fl.curve(si_scene(**BODY), LAW, [0.3, 0.1])
    one = fl.steady_state(si_scene(**BODY | {"belt_speed_m_per_s": 0.3}), LAW)

    assert table["scene.dimensional.belt_speed_m_per_s"].tolist() == [0.3, 0.1]
    assert table["scene.belt_speed"].tolist() == pytest.approx([15.0, 5.0])
    assert table["mean_friction_N"][0] == pytest.approx(one.si["mean_friction_N"])
    assert (
        fl.steady_state(
            Scene(**si_scene(**BODY).model_dump(exclude={"dimensional"}, exclude_none=True)), LAW
        ).si
        == {}
    )


# Studies


def test_sweeps_over_si_values_move_the_nondimensional_ones_with_them() -> None:
    table = fl.run(
        study(
            sweep={
                "scene.dimensional.mass_kg": [2, 8],
                "scene.dimensional.drive.frequency_rad_per_s": [20, 40],
            },
            expect=[
                {
                    "where": {"scene.dimensional.mass_kg": 8, "scene.drive.frequency": 2},
                    "column": "period_s",
                    "equals": 2 * math.pi / 20,
                    "within": 1e-12,
                }
            ],
        )
    )

    assert [verdict.passed for verdict in table.verdicts] == [True]
    assert table.table["scene.drive.frequency"].tolist() == pytest.approx([1, 2, 2, 4])
    assert table.table["scene.damping_ratio"].tolist() == pytest.approx([0.1, 0.1, 0.05, 0.05])


def test_a_resolved_study_in_si_units_is_the_same_study_and_stays_in_them() -> None:
    tree = study(sweep={"scene.dimensional.belt_speed_m_per_s": [0.1, 0.2]})
    tree["scene"] = {"dimensional": BODY | {"initial": {"x_m": 1e-3}}}
    once = parse_study(tree)

    again = parse_study(once.resolved())
    assert (again, again.digest()) == (once, once.digest())
    assert set(once.resolved()["scene"]) == {"dimensional"}
    assert once.resolved()["scene"]["dimensional"]["gravity_m_per_s2"] == 9.81
    assert parse_study(tree, ["scene.dimensional.mass_kg=3"]).digest() != once.digest()


def test_a_curve_in_si_units_is_solved_as_one_curve() -> None:
    tree = study(
        sweep={"scene.dimensional.belt_speed_m_per_s": [0.1, 0.2, 0.3], "scene.dimensional.mass_kg": [1, 2]}
    )

    assert [len(curve.rows) for curve in parse_study(tree).curves()] == [3, 3]


# Mistakes


def mistakes(body: dict[str, Any], **changes: Any) -> list[str]:
    with pytest.raises(StudyError) as caught:
        parse_study(study(scene={"dimensional": body}) | changes)
    return [str(mistake).removeprefix("study: ") for mistake in caught.value.mistakes]


def without(body: dict[str, Any], *keys: str) -> dict[str, Any]:
    return {key: value for key, value in body.items() if key not in keys}


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (BODY | {"mass_kg": -1}, "scene.dimensional.mass_kg: must be > 0, got -1"),
        (
            BODY | {"drive": {"amplitude_N": 1, "unbalance_kg_m": 1, "frequency_rad_per_s": 1}},
            "scene.dimensional.drive: give exactly one of unbalance_kg_m and amplitude_N",
        ),
        (
            BODY | {"normal_load_N": 3, "gravity_m_per_s2": 9.81},
            "scene.dimensional.gravity_m_per_s2: leave it out where normal_load_N is given",
        ),
        (
            BODY | {"length_m": 1e-320, "stiffness_N_per_m": 1e-9},
            "scene.dimensional.length_m: these values have no nondimensional numbers: check their units",
        ),
        (5, "scene.dimensional: must be a mapping (key: value), got 5"),
    ],
)  # fmt: skip
def test_a_mistake_in_an_si_value_is_told_at_its_path(body: Any, said: str) -> None:
    assert mistakes(body) == [said]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("mass_kg", "mass_g"),
        ("length_m", "length_mm"),
    ],
)
def test_a_key_with_a_wrong_unit_or_none_is_asked_about(right: str, wrong: str) -> None:
    found = mistakes(without(BODY, right) | {wrong: BODY[right]})

    unknown = [message for message in found if message.startswith(f"scene.dimensional.{wrong}: unknown key")]
    assert len(unknown) == 1
    assert unknown[0].endswith(f"did you mean '{right}'?")


def test_a_scene_given_twice_over_is_a_mistake_of_every_second_value() -> None:
    tree = study()
    tree["scene"] = {"dimensional": BODY, "belt_speed": 1, "slip": {"velocity_amplitude": 1, "frequency": 1}}
    with pytest.raises(StudyError) as caught:
        parse_study(tree)

    assert [str(mistake) for mistake in caught.value.mistakes] == [
        "study: scene.belt_speed: leave it out, dimensional gives the scene",
        "study: scene.slip: leave it out, dimensional gives the scene",
    ]


def test_a_sweep_over_a_value_that_si_units_decide_is_sent_to_them() -> None:
    (found,) = mistakes(BODY, sweep={"scene.belt_speed": [1, 2]})

    assert "the scene is given in SI units: sweep its values under scene.dimensional" in found
    assert "did you mean 'scene.dimensional.belt_speed_m_per_s'?" in found


def test_a_column_in_si_units_needs_a_scene_in_si_units() -> None:
    plain = {
        "damping_ratio": 0.1,
        "normal_load": 1,
        "belt_speed": 1,
        "drive": {"unbalance": 1, "frequency": 1},
    }
    with pytest.raises(StudyError, match=r"this one needs a scene given in SI units: scene\.dimensional"):
        parse_study(study(scene=plain, expect=[{"column": "energy_input_J", "below": 1}]))


# Figures


def test_figures_are_in_si_units_where_the_scene_is() -> None:
    speeds, masses = (f"scene.dimensional.{key}" for key in ("belt_speed_m_per_s", "mass_kg"))
    over = {speeds: [0.05 * i for i in range(1, 41)], masses: [2, 3]}
    table = fl.run(study(sweep=over), columns="all").table
    family = family_of(table)
    assert family is not None

    assert (family.abscissa, family.member) == (speeds, masses)
    velocity, energies = (drawn(table, name) for name in ("velocity", "energies"))
    assert velocity.axes[0].get_ylabel() == r"velocity amplitude $\hat V_1$ [m/s]"
    assert energies.axes[0].get_ylabel() == r"work of the loads $E_\mathrm{in}$ [J]"
    assert {axes.get_xlabel() for axes in (*velocity.axes, *energies.axes)} == {"belt speed $V_b$ [m/s]"}
    assert FigureData(table).columns["mean_friction"] == ["mean_friction"]
    limits = [friction_free_velocity(si_scene(**BODY | {"mass_kg": mass})) for mass in (2, 3)]
    wanted = [limit * math.sqrt(800 / mass) * 1e-3 for limit, mass in zip(limits, (2, 3), strict=True)]
    assert [list(curve.kinks) for curve in family.curves] == [[pytest.approx(speed)] for speed in wanted]


def test_every_si_value_has_its_word_its_symbol_and_its_unit() -> None:
    from frictionlab.values.columns import word
    from frictionlab.values.validation import number_paths

    frequency = "scene.dimensional.natural_frequency_rad_per_s"
    assert [word(f"{frequency}{unit}") for unit in ("", " in kHz", " in rpm")] == [
        f"natural frequency ${letter}_1$ [{unit}]"
        for letter, unit in ((r"\omega", "rad/s"), ("f", "kHz"), ("n", "rpm"))
    ]
    starts, without_unit = "initial.", ("frequency_ratio", "variation.amplitude", "damping_ratio", ".order")
    for path in number_paths(Dimensional):
        if path.endswith(without_unit):
            assert word(f"scene.dimensional.{path}").endswith("$"), path
        elif not path.startswith(starts):
            assert word(f"scene.dimensional.{path}").endswith("]"), path
