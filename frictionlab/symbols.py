"""The words and symbols of inputs and columns, as a figure's axes and legends print them."""

from __future__ import annotations

import textwrap

_NAMES = {
    "mean_friction": (r"mean friction coefficient", r"\bar\mu"),
    "velocity_amplitude": ("velocity amplitude", r"\hat v_1"),
    "transverse_velocity_amplitude": ("transverse velocity amplitude", r"\hat v_2"),
    "energy_input": ("work of the loads", r"E_\mathrm{in}"),
    "energy_viscous": ("viscous loss", r"E_\mathrm{v}"),
    "energy_friction": ("friction's take", r"E_\mathrm{f}"),
    "energy_contact": ("heat in the contact", r"E_\mathrm{c}"),
    "scene.belt_speed": ("belt speed", "v_b"),
    "scene.damping_ratio": ("damping ratio", r"\beta_1"),
    "scene.normal_load": ("normal load", r"\gamma^2"),
    "scene.drive.frequency": ("drive frequency", r"\Omega"),
    "scene.drive.unbalance": ("unbalance", r"\alpha"),
    "scene.drive.amplitude": ("load amplitude", "P"),
    "scene.drive.phase": ("load phase [deg]", r"\varphi_1"),
    "scene.transverse.natural_frequency": ("transverse natural frequency", r"\omega_r"),
    "scene.transverse.damping_ratio": ("transverse damping ratio", r"\beta_2"),
    "scene.transverse.load.unbalance": ("transverse unbalance", r"\alpha_2"),
    "scene.transverse.load.amplitude": ("transverse load amplitude", "P_2"),
    "scene.transverse.load.phase": ("transverse load phase [deg]", r"\varphi_2"),
    "scene.slip.velocity_amplitude": ("slip velocity amplitude", "V_1"),
    "scene.slip.frequency": ("slip frequency", r"\Omega"),
    "scene.slip.phase": ("slip phase [deg]", r"\varphi_1"),
    "scene.transverse_slip.velocity_amplitude": ("transverse slip velocity amplitude", "V_2"),
    "scene.transverse_slip.frequency": ("transverse slip frequency", r"\Omega"),
    "scene.transverse_slip.phase": ("transverse slip phase [deg]", r"\varphi_2"),
    "law.mu": ("friction coefficient", r"\mu"),
    "law.mu_kinetic": ("kinetic friction coefficient", r"\mu_k"),
    "law.mu_static": ("static friction coefficient", r"\mu_s"),
}

_LAWS = {  # words, symbol, unit in SI
    "stiffness": ("bristle stiffness", r"\sigma_0", "1/m"),
    "presliding_length": ("presliding length", r"\delta", "m"),
    "contact_stiffness": ("contact stiffness", "K_t", "N/m"),
    "damping": ("bristle damping", r"\sigma_1", "s/m"),
    "contact_damping": ("contact damping", "C_t", "N s/m"),
    "viscosity": ("viscosity", r"\sigma_2", "s/m"),
    "stribeck_speed": ("Stribeck speed", "v_s", "m/s"),
}
_LAWS_IN_SI = "law.dimensional."

_IN_SI = {  # words, symbol, unit; inputs without the "scene.dimensional." before them
    "velocity_amplitude_m_per_s": ("velocity amplitude", r"\hat V_1", "m/s"),
    "transverse_velocity_amplitude_m_per_s": ("transverse velocity amplitude", r"\hat V_2", "m/s"),
    "energy_input_J": ("work of the loads", r"E_\mathrm{in}", "J"),
    "energy_viscous_J": ("viscous loss", r"E_\mathrm{v}", "J"),
    "energy_friction_J": ("friction's take", r"E_\mathrm{f}", "J"),
    "energy_contact_J": ("heat in the contact", r"E_\mathrm{c}", "J"),
    "mass_kg": ("mass", "M", "kg"),
    "stiffness_N_per_m": ("stiffness", "K_1", "N/m"),
    "damping_N_s_per_m": ("damping", "C_1", "N s/m"),
    "length_m": ("length scale", "L", "m"),
    "gravity_m_per_s2": ("gravity", "g", "m/s$^2$"),
    "normal_load_N": ("normal load", "N", "N"),
    "belt_speed_m_per_s": ("belt speed", "V_b", "m/s"),
    "drive.frequency_rad_per_s": ("drive frequency", r"\omega", "rad/s"),
    "drive.unbalance_kg_m": ("unbalance", "m r", "kg m"),
    "drive.amplitude_N": ("load amplitude", "F_1", "N"),
    "drive.phase": ("load phase", r"\varphi_1", "deg"),
    "transverse.stiffness_N_per_m": ("transverse stiffness", "K_2", "N/m"),
    "transverse.damping_N_s_per_m": ("transverse damping", "C_2", "N s/m"),
    "transverse.load.unbalance_kg_m": ("transverse unbalance", "m_2 r_2", "kg m"),
    "transverse.load.amplitude_N": ("transverse load amplitude", "F_2", "N"),
    "transverse.load.phase": ("transverse load phase", r"\varphi_2", "deg"),
}


def symbol(name: str) -> str:
    """The symbol of an input or column in mathtext; for one without a symbol the last part of its path."""
    return f"${_said(name)[1]}$" if _said(name) else name.rpartition(".")[2].replace("_", " ")


def word(name: str, longest: int = 80) -> str:
    """The words of an input or column with its symbol and unit, on lines of so many letters.

    For one without a symbol: the last part of its path.
    """
    if not (said := _said(name)):
        return symbol(name)
    unit = f" [{said[2]}]" if len(said) > 2 else ""
    return f"{textwrap.fill(said[0], longest)} {symbol(name)}{unit}"


def _said(name: str) -> tuple[str, ...]:
    if name.startswith(_LAWS_IN_SI):
        parameter = name.removeprefix(_LAWS_IN_SI)
        return _LAWS[parameter] if parameter in _LAWS else _said(f"law.{parameter}")
    plain = {f"law.{parameter}": said[:2] for parameter, said in _LAWS.items()}
    known: dict[str, tuple[str, ...]] = {**_IN_SI, **_NAMES, **plain}
    return known.get(name.removeprefix("scene.dimensional."), ())
