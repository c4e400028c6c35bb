"""The equations of motion of a study, in the letters of its table of the scene, which has their numbers."""

from __future__ import annotations

import re
from typing import NamedTuple

from markupsafe import Markup

from frictionlab.report.tables import symbol_html
from frictionlab.scene.dimensional import without_unit
from frictionlab.scene.waveforms import SINE
from frictionlab.study.study import Study

_INERTIA = "{mass} {a}", "{a}"
_DASHPOT = (
    "{@damping} {rate}",
    "2 {@damping_ratio} √({@stiffness} {mass}) {rate}",
    "2 {@damping_ratio} {mass} {@natural_frequency} {rate}",
    "2 {@damping_ratio} {@natural_frequency} {rate}",
    "2 {@damping_ratio} {rate}",
)
_SPRING = (
    "{@stiffness} {stretch}",
    "{mass} {@natural_frequency}<sup>2</sup> {stretch}",
    "{@natural_frequency}<sup>2</sup> {stretch}",
    "{stretch}",
)
_BESIDE = (
    "{body.cubic_stiffness} {x}<sup>3</sup>",
    "{body.amplitude_damping} {x}<sup>2</sup> {v}",
    "{body.fractional.coefficient} <i>D</i><sup>{body.fractional.order}</sup> {x}",
)
_STRETCH = "(1 + {body.curvature} {x}) (1 + 2 {body.curvature} {x}) {x}", "{x}"
_RATE = "(1 + 2 {body.curvature} {x})<sup>2</sup> {v}", "{v}"
_NORMAL = "{normal_load}", "{mass} {gravity}"
_SHAKEN = (
    "{@unbalance} {frequency}<sup>2</sup> {wave}",
    "{@amplitude} {wave}",
    "{@velocity_amplitude} {wave}",
    "{@displacement_amplitude} {pace} {wave}",
    "{@acceleration_amplitude} / ({pace}) {wave}",
)
"""Forms of each term; @ stands for the part of the scene that has the letters."""


class Letters(NamedTuple):
    """Letters of the inputs of a study that are not zero, by their keys without units, and those of its motion."""

    known: dict[str, Markup]

    @classmethod
    def of(cls, study: Study) -> Letters:
        """Read the letters of a study."""
        kept = "scene." if study.scene.dimensional is None else "scene.dimensional."
        given = {f"scene.{path}": value for path, value in study.scene.given_values().items()}
        fixed = [name for name, value in given.items() if value and value != SINE.shape]
        names = [name for name in dict.fromkeys([*fixed, *study.sweep]) if name.startswith(kept)]
        known = {without_unit(name.removeprefix(kept)): symbol_html(name) for name in names}
        known |= {key: Markup("<i>w</i>") for key in known if key.endswith(".waveform")}
        shared = ("<i>τ</i>", "<i>Ω</i>") if kept == "scene." else ("<i>t</i>", "<i>ω</i>")
        return cls(known | dict(zip(("t", "frequency"), map(Markup, shared), strict=True)))

    def term(self, *forms: str, part: str = "", **others: Markup) -> Markup:
        """Write the first of these forms whose letters are all known; nothing where none is."""
        known = {**self.known, **others}
        for form in (each.replace("@", part) for each in forms):
            if all(known.get(key) for key in re.findall("{(.+?)}", form)):
                return Markup(re.sub("{(.+?)}", lambda key: known[key[1]], form))
        return Markup("")

    def shaken(self, part: str, axis: int = 1) -> Markup:
        """What a part of the scene adds along an axis: its size times its waveform, turned by its direction."""
        pace = self.term("{@frequency_ratio} {frequency}", "{frequency}", part=part)
        angle = self.term("{pace} {t} + {@phase}", "{pace} {t}", part=part, pace=pace)
        wave = self.term("{@waveform}({angle})", "sin({angle})", part=part, angle=angle)
        terms = [self.term(*_SHAKEN, part=part, wave=wave, pace=pace), self.term("{@offset}", part=part)]
        told = Markup(" + ").join(filter(None, terms))
        if f"{part}direction" not in self.known:
            return told if axis == 1 else Markup("")
        told = Markup("({})").format(told) if all(terms) else told
        return self.term(f"{{told}} {('cos', 'sin')[axis - 1]} {{@direction}}", part=part, told=told)


def equations(study: Study) -> list[Markup]:
    """Write what is solved: motion along the belt and across it, slip, varying load; of a prescribed slip that."""
    letters, degrees = Letters.of(study), study.scene.degrees_of_freedom
    if not degrees:
        lines = [_slip(letters, axis) for axis in ((1, 2) if study.scene.planar else (1,))]
    else:
        moving = [_moving(study, axis) for axis in range(1, degrees + 1)]
        lines = [_motion(study, letters, *each) for each in enumerate(moving, 1)]
        lines += [
            Markup(", &ensp; ").join(_slip(letters, axis, each["v"]) for axis, each in enumerate(moving, 1))
        ]
    if study.scene.normal_load_variation:
        varying = letters.shaken("normal_load_variation.")
        lines.append(
            letters.term(
                *(f"<i>N</i>({{t}}) = {each} (1 + {{varying}})" for each in _NORMAL), varying=varying
            )
        )
    return lines


def _moving(study: Study, axis: int) -> dict[str, Markup]:
    """Letters of place, velocity and acceleration."""
    letters = "x\u1e8b\u1e8d" if study.scene.dimensional is None else "X\u1e8a\u1e8c"
    return {
        name: Markup(f"<i>{letter}</i><sub>{axis}</sub>") for name, letter in zip("xva", letters, strict=True)
    }


def _motion(study: Study, letters: Letters, axis: int, moving: dict[str, Markup]) -> Markup:
    """Inertia, dashpot, spring and friction against the load."""
    part, scene, bent = (
        "" if axis == 1 else "transverse.",
        study.scene,
        {"stretch": moving["x"], "rate": moving["v"]},
    )
    beside = []
    if axis == 1:
        bent = {"stretch": letters.term(*_STRETCH, **moving), "rate": letters.term(*_RATE, **moving)}
        beside = [letters.term(each, **moving) for each in _BESIDE]
    held = [] if axis == 1 and scene.is_free else _SPRING
    body = [letters.term(*each, part=part, **moving, **bent) for each in (_INERTIA, _DASHPOT, held)]
    if axis == 1 and "receptance" in scene.body_terms:
        body = [Markup("<i>H</i><sup>\N{MINUS SIGN}1</sup> {}").format(moving["x"])]
    normal = ["<i>N</i>({t})"] if scene.normal_load_variation else _NORMAL
    friction = letters.term(*(f"{each} <i>T</i><sub>{axis}</sub>" for each in normal))
    loads = [letters.shaken("drive.", axis), letters.shaken("transverse.load.") if axis == 2 else ""]
    left, right = (Markup(" + ").join(filter(None, terms)) for terms in ([*body, *beside, friction], loads))
    return Markup("{} = {}").format(left, right or "0")


def _slip(letters: Letters, axis: int, velocity: Markup | None = None) -> Markup:
    """Slip velocity: that of the mass, or that which is prescribed, less that of the belt."""
    across = letters.shaken("transverse_slip.") if axis == 2 else ""
    first = velocity or letters.shaken("slip.", axis) or across
    less = [letters.term("{belt_speed}") if axis == 1 else "", letters.shaken("belt_vibration.", axis)]
    told = Markup(" \N{MINUS SIGN} ").join([first, *filter(None, less)]).strip()
    return Markup("<i>v</i><sub>{}</sub> = {}").format(axis, told or "0")


def letters_sentence(study: Study) -> str:
    """Say what those letters of the equations are that no table of the page names."""
    told = ["T is the friction coefficient of the law, along the slip velocity v"]
    if study.scene.degrees_of_freedom:
        told.append("a mass that sticks has v = 0")
    if any("<i>w</i>" in line for line in equations(study)):
        told.append("w is the waveform")
    if "receptance" in study.scene.body_terms:
        told.append("H is the receptance of the table, harmonic by harmonic")
    if study.scene.dimensional is not None:
        told.append("forces are in N, lengths in m, t in s")
    return f"Numbers of letters are in the table below; {'; '.join(told)}."
