"""Columns of the result tables: names, order, meaning, symbols and units."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

INPUTS: dict[str, str] = {
    "law": "label of the law",
    "kind": "registered name of the law",
    "method": "label of the method",
}
"""First columns; ``scene.<path>`` for every scene value and ``law.<parameter>`` for every law follow."""


class Column(NamedTuple):
    """A result column. group: by which it is asked for. made: what it comes from: the method's answer, the orbit
    of the motion, or the inputs. words, symbol: of figures. scale: of the unit in a scene given in SI units."""

    name: str
    meaning: str
    group: str
    made: str = "answer"
    words: str = ""
    symbol: str = ""
    scale: str = ""
    in_si: str = ""  # its meaning there, where it is another
    symbol_in_si: str = ""
    is_text: bool = False


_UNITS = {
    "load": ("N", "N"),
    "velocity": ("m_per_s", "m/s"),
    "energy": ("J", "J"),
    "drive period": ("s", "s"),
    "length": ("m", "m"),
    "time": ("s", "s"),
    "force": ("N", "N"),
}
"""Scales of columns: the end of the name in SI units, and the unit."""

COLUMNS: tuple[Column, ...] = (
    Column("mean_friction", "steady-state mean of the friction coefficient along x1, positive for belt_speed > 0",
           "always", words="mean friction coefficient", symbol=r"\bar\mu", scale="load",
           in_si="mean friction force along x1"),
    Column("error", "bound on the absolute error of mean_friction against the scene as stated", "always",
           scale="load", in_si="bound on the absolute error of mean_friction_N"),
    Column("error_kind", "guaranteed (proved), estimated, or statistical (of a long time)", "answer", is_text=True),
    Column("status", "ok, refused, failed, not_unique or killed", "always", is_text=True),
    Column("reason", "why the status is not ok, or what to note about an ok point", "always", is_text=True),
    Column("unique", "proved, tested or no: whether every start ends in this state; empty where nothing was asked",
           "uniqueness", is_text=True),
    Column("mean_low", "smallest mean seen where the steady state is not unique", "uniqueness"),
    Column("mean_high", "largest mean seen where the steady state is not unique", "uniqueness"),
    Column("window", "periods averaged for mean_low and mean_high, or for a statistical mean", "uniqueness"),
    Column("mean_friction_transverse", "time mean of the friction coefficient along x2", "transverse", scale="load",
           in_si="mean friction force along x2"),
    Column("velocity_amplitude", "half the peak-to-peak value of x1'", "motion", "orbit", "velocity amplitude",
           r"\hat v_1", "velocity", symbol_in_si=r"\hat V_1"),
    Column("velocity_harmonic", "amplitude of the first harmonic of x1'", "motion", "orbit", scale="velocity"),
    Column("velocity_phase", "phase of that harmonic against the load along x1, in degrees, + = lead", "motion",
           "orbit"),
    Column("transverse_velocity_amplitude", "half the peak-to-peak value of x2'", "transverse", "orbit",
           "transverse velocity amplitude", r"\hat v_2", "velocity", symbol_in_si=r"\hat V_2"),
    Column("transverse_velocity_harmonic", "amplitude of the first harmonic of x2'", "transverse", "orbit",
           scale="velocity"),
    Column("transverse_velocity_phase", "phase of that harmonic against the load along x1, in degrees, + = lead",
           "transverse", "orbit"),
    Column("stick_fraction", "share of the period in stick", "motion", "orbit"),
    Column("reversals", "sign changes of the slip velocity along x1, per period", "motion", "orbit"),
    Column("force_reversals", "sign changes of the friction force along x1, per period", "motion", "orbit"),
    Column("energy_input", "work of the loads, per period of the response", "energies", "orbit", "work of the loads",
           r"E_\mathrm{in}", "energy"),
    Column("energy_viscous", "loss in the dashpots, per period", "energies", "orbit", "viscous loss",
           r"E_\mathrm{v}", "energy"),
    Column("energy_friction", "work absorbed by friction, per period", "energies", "orbit",
           "work absorbed by friction", r"E_\mathrm{f}", "energy"),
    Column("energy_contact", "heat in the contact, per period", "energies", "orbit", "heat in the contact",
           r"E_\mathrm{c}", "energy"),
    Column("energy_input_error", "bound on the absolute error of energy_input, estimated", "energies", "orbit",
           scale="energy", in_si="bound on the error of energy_input_J"),
    Column("energy_viscous_error", "bound on the absolute error of energy_viscous, estimated", "energies", "orbit",
           scale="energy", in_si="bound on the error of energy_viscous_J"),
    Column("energy_friction_error", "bound on the absolute error of energy_friction, estimated", "energies", "orbit",
           scale="energy", in_si="bound on the error of energy_friction_J"),
    Column("energy_contact_error", "bound on the absolute error of energy_contact, estimated", "energies", "orbit",
           scale="energy", in_si="bound on the error of energy_contact_J"),
    Column("period", "period of the response in drive periods, of an undriven one in units of 2 pi", "answer",
           scale="drive period", in_si="period of the response"),
    Column("floquet", "largest modulus of the Floquet multipliers, without the trivial one of an undriven orbit",
           "multipliers"),
    Column("floquet_error", "bound on the absolute error of floquet, estimated", "multipliers"),
    Column("normalized_friction", "mean_friction / steady sliding friction at the belt speed", "ratios", "inputs",
           "mean friction over steady sliding friction", r"\bar\mu/\mu"),
    Column("velocity_ratio", "belt_speed / V_lin, the largest friction-free velocity of x1 over the belt's vibration",
           "ratios", "inputs", "relative belt speed", r"v_b/V_\mathrm{lin}"),
    Column("friction_to_drive", "friction coefficient * normal_load / force amplitude", "ratios", "inputs"),
    Column("presliding_ratio", "presliding length * frequency / V_lin", "ratios", "inputs"),
    Column("drift_speed", "speed of a free body over a plate that only vibrates, positive along x1", "drift",
           scale="velocity", in_si="speed of a free body over a plate that only vibrates, positive along x1"),
    Column("drift_speed_error", "bound on the absolute error of drift_speed, estimated", "drift", scale="velocity",
           in_si="bound on the absolute error of drift_speed_m_per_s, estimated"),
    Column("model", "what computed the number, in the words listed below, and for auto why it was chosen", "answer",
           is_text=True),
    Column("seconds", "kernel time", "answer"),
)  # fmt: skip
"""Columns after the inputs, in the order of the table."""

RESULTS: dict[str, str] = {each.name: each.meaning for each in COLUMNS}
"""Meaning of each of them."""
FROM_ORBITS: tuple[str, ...] = tuple(each.name for each in COLUMNS if each.made == "orbit")
"""Result columns that are read from orbits."""
DERIVED: tuple[str, ...] = tuple(each.name for each in COLUMNS if each.made == "inputs")
"""Columns that follow from a point's inputs and its mean friction."""
TEXT: frozenset[str] = frozenset(each.name for each in COLUMNS if each.is_text)
"""Columns that hold text; every other one holds a number, empty where it does not apply."""
ALWAYS: tuple[str, ...] = tuple(each.name for each in COLUMNS if each.group == "always")
"""Columns of every table, whatever is asked for."""


class ColumnInSI(NamedTuple):
    """A result column in SI units: the nondimensional column, the scale that multiplies it, and its meaning."""

    column: str
    scale: str
    meaning: str


SI: dict[str, ColumnInSI] = {
    f"{each.name}_{_UNITS[each.scale][0]}": ColumnInSI(
        each.name,
        each.scale,
        f"{each.in_si or (each.name if each.scale == 'velocity' else each.meaning)} [{_UNITS[each.scale][1]}]",
    )
    for each in COLUMNS
    if each.scale
}
"""Columns at the end of the table of a scene given in SI units."""

_SCALES = {
    "velocity": (
        *("belt_speed", "belt_speed_error", "reversal_end", "reversal_end_error", "velocity"),
        *("not_unique_from", "not_unique_to"),
        *("velocity_amplitude", "transverse_velocity_amplitude", "v1", "v2", "slip", "slip_transverse"),
    ),
    "length": ("x", "x1", "x2"),
    "time": ("tau",),
    "force": ("load", "load_transverse", "normal_load"),
    "energy": ("work",),
}
ALSO_IN_SI: dict[str, tuple[str, str]] = {
    name: (f"{name}_{_UNITS[scale][0]}", scale) for scale, names in _SCALES.items() for name in names
}
"""Columns in SI units of numbers of orbits, curves, onsets, harmonics and attractors, and their scales."""

IN_SI_UNITS: dict[str, str] = {
    **{name: _UNITS[made.scale][1] for name, made in SI.items() if made.scale != "load"},
    **{name: _UNITS[scale][1] for name, scale in ALSO_IN_SI.values()},
}
"""Units of the columns of results in SI units, but for friction forces, which stay in N."""

OF_SHAPE = (
    *("normalized_friction", "velocity_ratio", "velocity_amplitude"),
    *("reversals", "stick_fraction"),
)
"""Result columns that the measures of a curve's shape are read from, besides the mean and its error."""
OF_REST = "status", "stick_fraction", "reversals"
"""Columns that change where stick and reversal begin and end."""

DEFAULT: tuple[str, ...] = (
    *("mean_friction", "error", "error_kind", "status", "reason", "unique", "stick_fraction", "reversals"),
    *(
        "velocity_amplitude",
        "velocity_ratio",
        "normalized_friction",
        "period",
        "window",
        "mean_low",
        "mean_high",
    ),
    "model",
)
"""Result columns where none are asked for, each only where some row has it."""

ALL, USUAL, SHAPE, ONSETS_GROUP = "all", "usual", "shape", "onsets"
GROUPS: dict[str, str] = {
    USUAL: "those found where no columns are asked for",
    "answer": "how the mean was found",
    "uniqueness": "whether every start ends in the same state, and between which means if not",
    "motion": "velocity along the belt, stick and reversals",
    "transverse": "mean friction and velocity across the belt",
    "energies": "work of loads, dashpots and friction, per period, with errors",
    "multipliers": "Floquet multipliers of the orbit",
    "ratios": "mean friction, belt speed, friction and presliding length in natural scales",
    "drift": "speed at which a body that no spring holds travels over a plate that vibrates",
    SHAPE: "curves.csv: where curves end and how they bend",
    ONSETS_GROUP: "onsets.csv: belt speeds at which the motion changes its kind",
    ALL: "every column but those of drift, and every table",
}
"""Names that ``columns`` takes for several columns each."""
_OF_TABLES = {
    USUAL: DEFAULT,
    SHAPE: OF_SHAPE,
    ONSETS_GROUP: OF_REST,
}


def columns_of(group: str) -> tuple[str, ...]:
    """Return the result columns of a group."""
    if group == ALL:
        return tuple(each.name for each in COLUMNS if each.group != "drift")
    return _OF_TABLES.get(group) or tuple(each.name for each in COLUMNS if each.group == group)


def asks_for(asked: Iterable[str] | None, group: str) -> bool:
    """Check whether the names of columns and groups ask for this group."""
    return asked is not None and bool({group, ALL} & {*asked})


BELT_SPEED = "scene.belt_speed"
_GIVEN_IN_SI = "scene.dimensional."
BELT_SPEEDS = (BELT_SPEED, f"{_GIVEN_IN_SI}belt_speed_m_per_s")
"""Abscissa of a curve: the belt speed, nondimensional or in m/s."""
SCALED = "law.nondimensional."
"""Prefix of the columns with the nondimensional parameters of a law that is given in SI units."""


SHOWN_IN = " in "
"""Between the name of a column in SI units and the unit in which its numbers are shown."""


def without_shown_unit(name: str) -> str:
    """Return the name of a column as tables of a run have it."""
    return name.partition(SHOWN_IN)[0]


def by_plain_names(names: Iterable[str]) -> dict[str, str]:
    """Columns as they are shown, by their names as tables of a run have them."""
    return {without_shown_unit(name): name for name in names}


def shown_column(names: Iterable[str], name: str) -> str:
    """Column among these of a number of orbits, curves, harmonics or attractors: that in SI units, if there."""
    return by_plain_names(names).get(ALSO_IN_SI[name][0], name) if name in ALSO_IN_SI else name


def is_belt_speed(name: str) -> bool:
    """Check whether a column is the belt speed, in whatever unit."""
    return without_shown_unit(name) in BELT_SPEEDS


def belt_speed(names: Iterable[str]) -> str:
    """Return the column of the belt speed, in the units in which the scene was given."""
    return next((name for name in names if without_shown_unit(name) == BELT_SPEEDS[1]), BELT_SPEED)


SHOWN_IN_PART = "shown in part"
"""Mark (``DataFrame.attrs``) of a table of some curves of a long one: in it, inputs may change together by chance."""


def leading(names: Sequence[str], cells: Mapping[str, Sequence[Any]]) -> list[str]:
    """Return those inputs whose values do not follow from those of another, law by law, as linked ones do.

    Of two that follow from each other the first. cells: of each input and of ``law``, row by row.
    """
    found = list(names)
    for name in reversed(names):
        if any(_follows(name, other, cells) for other in found if other != name):
            found.remove(name)
    return found


def _follows(name: str, other: str, cells: Mapping[str, Sequence[Any]]) -> bool:
    """Check whether rows of one law with the same value of the other have the same value of this."""
    known: dict[tuple[Any, Any], Any] = {}
    for law, given, value in zip(cells["law"], cells[other], cells[name], strict=True):
        own = _comparable(value)
        if known.setdefault((law, _comparable(given)), own) != own:
            return False
    return True


def _comparable(cell: Any) -> Any:
    """None for an empty cell, which does not equal another."""
    return cell if cell == cell else None


def given(names: Iterable[str]) -> list[str]:
    """Return the columns of scene and law values in the units in which they were given."""
    columns = [name for name in names if name.startswith(("scene.", "law.")) and not name.startswith(SCALED)]
    in_si = [name for name in columns if name.startswith((_GIVEN_IN_SI, "law."))]
    return in_si if any(name.startswith(_GIVEN_IN_SI) for name in columns) else columns


def selected(asked: Iterable[str] | None, needed: Iterable[str] = ()) -> frozenset[str]:
    """Return the result columns of a table that is asked for these columns and groups, in both scales.

    None: the default ones. needed: besides. Each table has those of ``ALWAYS``.
    """
    names = DEFAULT if asked is None else [one for name in asked for one in (columns_of(name) or [name])]
    wanted = {*ALWAYS, *(SI[name].column if name in SI else name for name in (*names, *needed))}
    return frozenset([*wanted, *(name for name, made in SI.items() if made.column in wanted)])


def results(names: Sequence[str]) -> list[str]:
    """Return the result columns of a table with these inputs."""
    return [*RESULTS, *SI] if belt_speed(names) != BELT_SPEED else [*RESULTS]


CURVES: dict[str, str] = {
    "reversal_end": "belt speed above which slip neither reverses nor sticks",
    "reversal_end_error": "bound on its error",
    "shape_start": "mean friction in the limit of a vanishing belt speed, where the chord begins",
    "shape_start_error": "bound on its error",
    "shape_area": "signed area between the curve and its chord up to there, > 0 above the chord: concave",
    "shape_area_error": "bound on its error",
    "shape_half": "mean friction at half that belt speed over mean friction there",
    "shape_half_error": "bound on its error",
    "shape_initial": "curvature at rest, in shares of that belt speed and of mean friction there",
    "shape_initial_error": "bound on its error",
    "shape": "verdict by area: concave, convex, mixed or undecided",
    "shape_by_initial": "verdict by the curvature at rest: concave, convex or undecided",
    "reduction": "largest fall of mean friction below that of steady sliding",
    "reduction_error": "bound on its error",
    "model_distance": "of a reduced model, measured by its own curve: its largest distance to the full means",
    "not_unique_from": "lowest belt speed of a point that is not_unique",
    "not_unique_to": "highest belt speed of such a point; of those between, each row says whether it is one",
    "reason": "why a measure is empty",
}
"""Columns of the table of curves after the inputs."""
CURVE_MEASURES: tuple[str, ...] = tuple(name for name in CURVES if f"{name}_error" in CURVES)
"""Columns that measure a curve."""

ONSETS: dict[str, str] = {
    "onset": "stick_begins, stick_ends or reversal_ends, read along increasing belt speed",
    "belt_speed": "where that is",
    "belt_speed_error": "bound on its error",
    "how": "what was solved for, how the multiplier leaves (+1, -1, complex), or why it was not located",
}
"""Columns of the table of onsets after the inputs."""

BOUNDARIES: dict[str, str] = {
    "measure": "of a curve, a column of curves.csv",
    "level": "its value on the line",
    "piece": "number of the line, where a level has several",
    "closed": "whether the line ends where it begins",
}
"""Columns of the table of boundaries after the inputs; after them each of the two numbers with its error."""

ATTRACTORS: dict[str, str] = {
    "belt_speed": "of the scene, nondimensional",
    "state": "its number at this belt speed, from 1",
    "period": "in drive periods, up to 255; 0 for a motion that does not repeat within so many",
    "mean_friction": "mean over the whole period, or over a long time where it does not repeat",
    "error": "bound on its error; two standard errors where it does not repeat",
    "error_kind": "estimated or statistical",
    "share": "of the starts, that ended in this state; 0 of one carried from a neighbour, or found by closing alone",
    "mean_low": "smallest mean over one drive period",
    "mean_high": "largest mean over one drive period",
    "point": "number of the drive period whose start this is, from 1; of the last ones where it does not repeat",
    "x": "position along x1 at the start of that drive period",
    "velocity": "x1' then",
    "found_from": "a start by its number, the search for a closed orbit, or the neighbour the state was carried from",
}
"""Columns of the table of attractors after the inputs, one row per Poincare point where a study keeps them."""
OF_STATES = tuple(name for name in ATTRACTORS if name not in ("point", "x", "velocity", "found_from"))
"""Columns of the states of points that have several."""

HARMONICS: dict[str, str] = {
    "belt_speed": "of the scene, nondimensional",
    "harmonic": "its order k, 0 for means",
    "velocity_amplitude": "of x1' = ... + amplitude sin(k theta + phase) + ..., theta the phase of the load along x1",
    "velocity_phase": "its phase [deg]; empty for k = 0, and where the amplitude is rounding",
    "friction_amplitude": "of the friction coefficient that acts against the mass; minus mean_friction for k = 0",
    "friction_phase": "its phase [deg]",
    "friction_in_phase": "part in phase with the velocity of that harmonic: it damps where positive",
    "friction_in_quadrature": "part that leads it by 90 degrees: inertia where positive, stiffness where negative",
}
"""Columns of the table of harmonics after the inputs; across the belt by these names after ``transverse_``."""

NEEDS: dict[str, str] = {
    "curve": "the law and the swept values that tell the curve from others of its study",
    "without": "what was taken away",
    "verdict": "needed, not needed, undecided (the error spans the tolerance) or refused (it cannot be taken away)",
    "change": "of the mean friction coefficient, without minus with, where it is largest along the curve",
    "change_error": "bound on its error: the errors of both means",
    "belt_speed": "where that is, in the units in which the scene is given",
    "within": "the tolerance on the change",
    "reduction_change": "of the largest fall of mean friction below that of steady sliding, as a share of that",
    "reduction_change_error": "bound on its error",
    "shape": "verdict on the shape of the full curve; empty where it is not read",
    "shape_without": "the same without",
    "smallest": "whether this is the smallest model within the tolerance",
    "model": "what the smaller model is",
    "reason": "why the verdict is not plain",
}
"""Columns of the table of needs, one row per set of things taken away from a curve."""

SHAPES: dict[str, tuple[str, ...]] = {
    "area": ("concave", "convex", "mixed", "undecided"),
    "initial": ("concave", "convex", "undecided"),
}
"""Measures of shape and the verdicts each can give."""

STATUSES: tuple[str, ...] = ("ok", "refused", "failed", "not_unique", "killed")


_NAMES = {  # words, symbol, unit
    "scene.belt_speed": ("belt speed", "v_b"),
    "scene.damping_ratio": ("damping ratio", r"\beta_1"),
    "scene.normal_load": ("normal load", r"\gamma^2"),
    "scene.drive.frequency": ("drive frequency", r"\Omega"),
    "scene.drive.unbalance": ("unbalance", r"\alpha"),
    "scene.drive.amplitude": ("load amplitude", "P"),
    "scene.drive.phase": ("load phase", r"\varphi_1", "deg"),
    "scene.drive.waveform": ("drive waveform", ""),
    "scene.drive.offset": ("constant force", "P_0"),
    "scene.drive.direction": ("drive direction", r"\chi", "deg"),
    "scene.transverse.natural_frequency": ("transverse natural frequency", r"\omega_r"),
    "scene.transverse.damping_ratio": ("transverse damping ratio", r"\beta_2"),
    "scene.transverse.load.unbalance": ("transverse unbalance", r"\alpha_2"),
    "scene.transverse.load.amplitude": ("transverse load amplitude", "P_2"),
    "scene.transverse.load.phase": ("transverse load phase", r"\varphi_2", "deg"),
    "scene.transverse.load.waveform": ("transverse load waveform", ""),
    "scene.transverse.load.offset": ("constant transverse force", "P_{20}"),
    "scene.transverse.load.frequency_ratio": ("transverse load frequency ratio", "r_2"),
    "scene.body.cubic_stiffness": ("cubic stiffness", "k_3"),
    "scene.body.amplitude_damping": ("amplitude damping", "c_3"),
    "scene.body.curvature": ("curvature", r"\kappa"),
    "scene.body.relaxation.stiffness": ("relaxing stiffness", "k_m"),
    "scene.body.relaxation.time": ("relaxation time", r"\tau_m"),
    "scene.body.relaxation.order": ("order of relaxation", "q"),
    "scene.body.receptance.free_mass": ("free mass", r"m_\infty"),
    "scene.body.receptance.frequency_unit": ("unit of the table's frequencies", r"\omega_H"),
    "scene.body.receptance.receptance_unit": ("unit of the table's receptance", "h_H"),
    "scene.body.fractional.coefficient": ("fractional coefficient", "c_q"),
    "scene.body.fractional.order": ("fractional order", "q"),
    "scene.slip.velocity_amplitude": ("slip velocity amplitude", "V_1"),
    "scene.slip.frequency": ("slip frequency", r"\Omega"),
    "scene.slip.phase": ("slip phase", r"\varphi_1", "deg"),
    "scene.slip.waveform": ("slip waveform", ""),
    "scene.slip.direction": ("slip direction", r"\chi", "deg"),
    "scene.transverse_slip.velocity_amplitude": ("transverse slip velocity amplitude", "V_2"),
    "scene.transverse_slip.frequency": ("transverse slip frequency", r"\Omega"),
    "scene.transverse_slip.phase": ("transverse slip phase", r"\varphi_2", "deg"),
    "scene.transverse_slip.waveform": ("transverse slip waveform", ""),
    "scene.belt_vibration.velocity_amplitude": ("belt vibration amplitude", r"\hat v_b"),
    "scene.belt_vibration.phase": ("belt vibration phase", r"\varphi_b", "deg"),
    "scene.belt_vibration.waveform": ("belt vibration waveform", ""),
    "scene.belt_vibration.direction": ("belt vibration direction", r"\chi_b", "deg"),
    "scene.belt_vibration.frequency_ratio": ("belt vibration frequency ratio", "r_b"),
    "scene.belt_vibration.frequency": ("belt vibration frequency", r"\Omega"),
    "scene.normal_load_variation.amplitude": ("varying share of the normal load", "n"),
    "scene.normal_load_variation.phase": ("normal load phase", r"\varphi_n", "deg"),
    "scene.normal_load_variation.waveform": ("normal load waveform", ""),
    "scene.normal_load_variation.frequency_ratio": ("normal load frequency ratio", "r_n"),
    "scene.normal_load_variation.frequency": ("normal load frequency", r"\Omega"),
    "scene.normal_load_variation.contact": ("contact under a varying load", ""),
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
    "mass_kg": ("mass", "M", "kg"),
    "stiffness_N_per_m": ("stiffness", "K_1", "N/m"),
    "damping_N_s_per_m": ("damping", "C_1", "N s/m"),
    "natural_frequency_rad_per_s": ("natural frequency", r"\omega_1", "rad/s"),
    "length_m": ("length scale", "L", "m"),
    "gravity_m_per_s2": ("gravity", "g", "m/s$^2$"),
    "normal_load_N": ("normal load", "N", "N"),
    "belt_speed_m_per_s": ("belt speed", "V_b", "m/s"),
    "drive.frequency_rad_per_s": ("drive frequency", r"\omega", "rad/s"),
    "drive.unbalance_kg_m": ("unbalance", "m r", "kg m"),
    "drive.amplitude_N": ("load amplitude", "F_1", "N"),
    "drive.offset_N": ("constant force", "F_0", "N"),
    "drive.phase": ("load phase", r"\varphi_1", "deg"),
    "transverse.stiffness_N_per_m": ("transverse stiffness", "K_2", "N/m"),
    "transverse.damping_N_s_per_m": ("transverse damping", "C_2", "N s/m"),
    "transverse.natural_frequency_rad_per_s": ("transverse natural frequency", r"\omega_2", "rad/s"),
    "transverse.load.unbalance_kg_m": ("transverse unbalance", "m_2 r_2", "kg m"),
    "transverse.load.amplitude_N": ("transverse load amplitude", "F_2", "N"),
    "transverse.load.offset_N": ("constant transverse force", "F_{20}", "N"),
    "transverse.load.phase": ("transverse load phase", r"\varphi_2", "deg"),
    "body.cubic_stiffness_N_per_m3": ("cubic stiffness", "K_3", "N/m$^3$"),
    "body.amplitude_damping_N_s_per_m3": ("amplitude damping", "C_3", "N s/m$^3$"),
    "body.curvature_per_m": ("curvature", r"\kappa", "1/m"),
    "body.relaxation.stiffness_N_per_m": ("relaxing stiffness", "K_m", "N/m"),
    "body.relaxation.time_s": ("relaxation time", "T_m", "s"),
    "body.relaxation.order": ("order of relaxation", "q"),
    "body.fractional.coefficient_N_sq_per_m": ("fractional coefficient", "C_q", "N s$^q$/m"),
    "body.fractional.order": ("fractional order", "q"),
    "body.receptance.free_mass_kg": ("free mass", r"M_\infty", "kg"),
    "slip.phase": ("slip phase", r"\varphi_1", "deg"),
    "transverse_slip.phase": ("transverse slip phase", r"\varphi_2", "deg"),
    "slip.velocity_amplitude_m_per_s": ("slip velocity amplitude", r"\hat V_1", "m/s"),
    "slip.displacement_amplitude_m": ("slip displacement amplitude", r"\hat X_1", "m"),
    "slip.acceleration_amplitude_m_per_s2": ("slip acceleration amplitude", r"\hat A_1", "m/s$^2$"),
    "slip.frequency_rad_per_s": ("slip frequency", r"\omega", "rad/s"),
    "transverse_slip.velocity_amplitude_m_per_s": ("transverse slip velocity amplitude", r"\hat V_2", "m/s"),
    "transverse_slip.displacement_amplitude_m": ("transverse slip displacement amplitude", r"\hat X_2", "m"),
    "transverse_slip.acceleration_amplitude_m_per_s2": (
        "transverse slip acceleration amplitude",
        r"\hat A_2",
        "m/s$^2$",
    ),
    "transverse_slip.frequency_rad_per_s": ("transverse slip frequency", r"\omega", "rad/s"),
    "belt_vibration.velocity_amplitude_m_per_s": ("belt vibration amplitude", r"\hat V_b", "m/s"),
    "belt_vibration.displacement_amplitude_m": ("belt displacement amplitude", r"\hat X_b", "m"),
    "belt_vibration.acceleration_amplitude_m_per_s2": ("belt acceleration amplitude", r"\hat A_b", "m/s$^2$"),
    "belt_vibration.frequency_rad_per_s": ("belt vibration frequency", r"\omega", "rad/s"),
    "normal_load_variation.frequency_rad_per_s": ("normal load frequency", r"\omega", "rad/s"),
}


_OF_RESULTS: dict[str, tuple[str, ...]] = {
    "tau": ("time", r"\tau"),
    "tau_s": ("time", "t", "s"),
    "x1": ("position", "x_1"),
    "x1_m": ("position", "X_1", "m"),
    "v1": ("velocity", r"\dot x_1"),
    "v1_m_per_s": ("velocity", r"\dot X_1", "m/s"),
    **{each.name: (each.words, each.symbol) for each in COLUMNS if each.words},
    **{
        f"{each.name}_{_UNITS[each.scale][0]}": (
            each.words,
            each.symbol_in_si or each.symbol,
            _UNITS[each.scale][1],
        )
        for each in COLUMNS
        if each.words and each.scale and each.scale != "load"
    },
}


def symbol(name: str) -> str:
    """Symbol of an input or column in mathtext; its words where it has none, else the last part of its path."""
    entry = _entry(name)
    if not entry:
        return without_shown_unit(name).rpartition(".")[2].replace("_", " ")
    cycles = next((letter for unit, letter in _CYCLES.items() if unit in name.partition(SHOWN_IN)[2]), None)
    letters = entry[1].replace(r"\omega", cycles) if cycles else entry[1]
    return f"${letters}$" if letters else entry[0]


_CYCLES = {"Hz": "f", "rpm": "n"}
"""Symbols of frequencies in units that count cycles, in place of omega."""


def unit_shown(name: str) -> str:
    """Return the unit of an input or column in mathtext; '' where it has none."""
    shown = name.partition(SHOWN_IN)[2]
    if not shown:
        return next(iter(_entry(name)[2:]), "") or IN_SI_UNITS.get(name, "")
    return typeset(shown)


def typeset(unit: str) -> str:
    """A unit as a person types it, in mathtext."""
    return re.sub(r"(?:\^|\*\*)(-?\d)", r"$^{\1}$", re.sub(r"\bu(?=[A-Za-z])", "µ", unit))


def plain_word(name: str) -> str:
    """Return the name of an input or column alone; for one without, the last part of its path."""
    entry = _entry(name)
    return entry[0] if entry else symbol(name)


def quantity(name: str, longest: int = 80) -> str:
    """Name and symbol of an input or column, wrapped to lines of at most ``longest`` letters.

    For one without a symbol its words, or the last part of its path.
    """
    entry = _entry(name)
    if not entry or not entry[1]:
        return symbol(name)
    return f"{textwrap.fill(entry[0], longest)} {symbol(name)}"


def word(name: str, longest: int = 80) -> str:
    """Name, symbol and unit of an input or column."""
    return f"{quantity(name, longest)} [{unit_shown(name)}]" if unit_shown(name) else quantity(name, longest)


def _entry(shown: str) -> tuple[str, ...]:
    name = without_shown_unit(shown)
    if name.startswith(_LAWS_IN_SI):
        parameter = name.removeprefix(_LAWS_IN_SI)
        return _LAWS[parameter] if parameter in _LAWS else _entry(f"law.{parameter}")
    plain = {f"law.{parameter}": entry[:2] for parameter, entry in _LAWS.items()}
    known: dict[str, tuple[str, ...]] = {**_IN_SI, **_NAMES, **plain, **_OF_RESULTS}
    inside = name.removeprefix(_GIVEN_IN_SI)
    return known.get(inside) or (known.get(f"scene.{inside}", ()) if inside != name else ())
