"""Names that papers use lead to those here."""

from __future__ import annotations

from typing import Any

import pytest

import frictionlab as fl
from frictionlab.scene.dimensional import Dimensional
from frictionlab.study.load import parse_study
from frictionlab.values.notes import StudyError, WrongValues


@pytest.mark.parametrize(
    ("record", "given", "meant"),
    [
        (fl.LuGre, "sigma0", "stiffness"),
        (fl.LuGre, "sigma_0", "stiffness"),
        (fl.LuGre, "sigma_1", "damping"),
        (fl.LuGre, "sigma2", "viscosity"),
        (fl.LuGre, "mus", "mu_static"),
        (fl.LuGre, "mu_s", "mu_static"),
        (fl.LuGre, "muk", "mu_kinetic"),
        (fl.LuGre, "Fc", "mu_kinetic"),
        (fl.Coulomb, "mu_k", "mu"),
        (fl.Coulomb, "F_s", "mu_static"),
        (fl.Stribeck, "vs", "stribeck_speed"),
        (fl.Jenkins, "k_t", "contact_stiffness"),
        ("drive", "frequency_Hz", "frequency"),
        ("drive", "Hz", "frequency"),
        (Dimensional, "m", "mass"),
        (Dimensional, "zeta", "damping_ratio"),
        (Dimensional, "f_n", "natural_frequency"),
        (Dimensional, "belt_velocity", "belt_speed"),
        (Dimensional, "normal_force", "normal_load"),
        ("belt_vibration", "amplitude", "displacement_amplitude"),
        (fl.Scene, "si", "dimensional"),
        (fl.Scene, "zeta", "damping_ratio"),
        (fl.Scene, "v_b", "belt_speed"),
    ],
)
def test_a_name_of_a_paper_leads_to_ours(record: Any, given: str, meant: str) -> None:
    inside = {record: {given: 1}} if isinstance(record, str) else {given: 1}
    made = Dimensional if isinstance(record, str) else record
    with pytest.raises(WrongValues, match=f"did you mean '{meant}'") as caught:
        made(**inside)

    assert not any(f": {meant}: required" in str(each) for each in caught.value.mistakes)


@pytest.mark.parametrize(("given", "meant"), [("step", "num"), ("from", "start"), ("to", "stop")])
def test_other_names_for_the_ends_of_a_range_and_its_steps_lead_to_ours(given: str, meant: str) -> None:
    scene = {"damping_ratio": 0.1, "normal_load": 1, "belt_speed": 1}
    tree = {"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.3}]}
    whole = {"start": 1.0, "stop": 2.0, "num": 5} | {given: 0.5}
    del whole[meant]
    with pytest.raises(StudyError, match=f"did you mean '{meant}'"):
        parse_study(tree | {"sweep": {"scene.belt_speed": whole}})
