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
}


def symbol(name: str) -> str:
    """The symbol of an input or column in mathtext; for one without a symbol the last part of its path."""
    return f"${_NAMES[name][1]}$" if name in _NAMES else name.rpartition(".")[2].replace("_", " ")


def word(name: str, longest: int = 80) -> str:
    """The words of an input or column with its symbol, on lines of so many letters.

    For one without a symbol: the last part of its path.
    """
    return f"{textwrap.fill(_NAMES[name][0], longest)} {symbol(name)}" if name in _NAMES else symbol(name)
