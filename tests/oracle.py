"""The reference curves as a result table: the contract's columns, as if a run had made them."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

REFERENCE = Path(__file__).parent / "reference"
EMPTY = ["mean_low", "mean_high", "transverse_velocity_amplitude", "energy_input", "energy_contact"]


def table_of_one_degree_of_freedom() -> pd.DataFrame:
    """Fig. 4: gamma^2 = 10, Omega = 1 and 1.5."""
    files = {1.0: "sdof_fig4b_fig7a_Om1_g10.csv", 1.5: "sdof_fig4a_Om1.5_g10.csv"}
    return pd.concat(
        [_along_the_belt(frequency, file) for frequency, file in files.items()], ignore_index=True
    )


def table_in_the_plane() -> pd.DataFrame:
    """Fig. 8a: both loads, Omega = 4, six transverse natural frequencies."""
    return pd.concat([_in_the_plane(omega_r) for omega_r in (0.5, 1, 2, 3, 4, 10)], ignore_index=True)


def _along_the_belt(frequency: float, file: str) -> pd.DataFrame:
    read = pd.read_csv(REFERENCE / file).iloc[1:]
    found = {
        "mean_friction": read["mu_bar_exact"],
        "velocity_amplitude": 0.5 * (read["xdot_max"] - read["xdot_min"]),
        "energy_viscous": read["E_visc"],
        "energy_friction": read["E_fric_corrected_eq7"],
        "energy_input": read["E_input"],
        "energy_contact": read["heat_in_contact"],
        "normalized_friction": read["mu_bar_exact"] / 0.4,
        "velocity_ratio": read["v_b"] / read["V_closed_eq6"],
    }
    return _table({"scene.normal_load": 10.0, "scene.drive.frequency": frequency}, read, found)


def _in_the_plane(omega_r: float) -> pd.DataFrame:
    read = pd.read_csv(REFERENCE / f"planar_fig8a_Om4_g1_wr{omega_r:g}.csv").iloc[1:]
    found = {
        "mean_friction": read["mu_bar_dop853"],
        "velocity_amplitude": read["V1"],
        "transverse_velocity_amplitude": read["V2"],
        "energy_viscous": read["E_visc"],
        "energy_friction": read["E_fric_on_mass"],
        "energy_input": read["E_visc"] + read["E_fric_on_mass"],
        "energy_contact": read["heat"],
        "normalized_friction": read["mu_bar_dop853"] / 0.4,
        "velocity_ratio": read["v_b"] / 42.606114,
    }
    return _table({"scene.normal_load": 1.0, "scene.transverse.natural_frequency": omega_r}, read, found)


def _table(scene: dict[str, float], read: pd.DataFrame, found: dict[str, pd.Series]) -> pd.DataFrame:
    named = {
        "law": "coulomb",
        "kind": "coulomb",
        "method": "auto",
        "scene.belt_speed": read["v_b"],
        "law.mu": 0.4,
    }
    settled = {"error": 1e-11, "status": "ok"}
    return pd.DataFrame(named | scene | dict.fromkeys(EMPTY, float("nan")) | settled | found)
