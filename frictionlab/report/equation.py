"""Equations of motion of a study, in the letters of its table of the scene, which has their numbers."""

from __future__ import annotations

import re
from typing import NamedTuple

from markupsafe import Markup

from frictionlab.report.tables import symbol_html
from frictionlab.scene.dimensional import without_unit
from frictionlab.scene.waveforms import SINE
from frictionlab.study.study import Study

_INERTIA = ("{mass?} {a}",)
_DASHPOT = (
    "{@damping} {rate}",
    "2 {@damping_ratio} √({@stiffness} {mass}) {rate}",
    "2 {@damping_ratio} {mass?} {@natural_frequency?} {rate}",
)
_SPRING = "{@stiffness} {stretch}", "{mass?} {@natural_frequency}<sup>2</sup> {stretch}", "{stretch}"
_STRETCH = "(1 + {body.curvature} {x}) (1 + 2 {body.curvature} {x}) {x}", "{x}"
_RATE = "(1 + 2 {body.curvature} {x})<sup>2</sup> {v}", "{v}"
_BESIDE = (
    "{body.cubic_stiffness} {x}<sup>3</sup>",
    "{body.amplitude_damping} {x}<sup>2</sup> {v}",
    "{body.fractional.coefficient} <i>D</i><sup>{body.fractional.order}</sup> {x}",
)
_NORMAL = "{normal_load}", "{mass} {gravity}"
_SHAKEN = (
    "{@unbalance} {frequency}<sup>2</sup> {wave}",
    "{@amplitude} {wave}",
    "{@velocity_amplitude} {wave}",
    "{@displacement_amplitude} {pace} {wave}",
    "{@acceleration_amplitude} / ({pace}) {wave}",
)
"""Forms of each term; @: the part of the scene that has the letters; ?: a factor that may be left out."""


class Letters(NamedTuple):
    """Letters along one axis: of the motion, and of those inputs that are not zero, by their keys without units."""

    known: dict[str, Markup]
    axis: int

    @classmethod
    def of(cls, study: Study, axis: int) -> Letters:
        """Read the letters of a study."""
        kept, moving = (
            ("scene.", "xẋẍτΩ") if study.scene.dimensional is None else ("scene.dimensional.", "XẊẌtω")
        )
        given = {f"scene.{path}": value for path, value in study.scene.given_values().items()}
        fixed = [name for name, value in given.items() if value and value != SINE.shape]
        names = [name for name in dict.fromkeys([*fixed, *study.sweep]) if name.startswith(kept)]
        known = {without_unit(name.removeprefix(kept)): symbol_html(name) for name in names}
        known |= {key: Markup("<i>w</i>") for key in known if key.endswith(".waveform")}
        x, v, a, t, frequency = (Markup("<i>{}</i>").format(letter) for letter in moving)
        of_axis = {
            name: letter + Markup(f"<sub>{axis}</sub>") for name, letter in zip("xva", (x, v, a), strict=True)
        }
        return cls(known | of_axis | {"t": t, "frequency": frequency}, axis)

    def term(self, *forms: str, part: str = "", **others: Markup) -> Markup:
        """Write the first of these forms whose letters are all known; nothing where none is."""
        known = {**self.known, **others}
        for form in (each.replace("@", part) for each in forms):
            form = re.sub(r"{([^}]+)\?} ", lambda key: f"{{{key[1]}}} " if known.get(key[1]) else "", form)
            if all(known.get(key) for key in re.findall("{(.+?)}", form)):
                return Markup(re.sub("{(.+?)}", lambda key: known[key[1]], form))
        return Markup("")

    def shaken(self, part: str) -> Markup:
        """Tell what a part of the scene adds along the axis: its size times its waveform, turned by its direction."""
        pace = self.term("{@frequency_ratio?} {frequency}", part=part)
        angle = self.term("{pace} {t} + {@phase}", "{pace} {t}", part=part, pace=pace)
        wave = self.term("{@waveform}({angle})", "sin({angle})", part=part, angle=angle)
        terms = [self.term(*_SHAKEN, part=part, wave=wave, pace=pace), self.term("{@offset}", part=part)]
        told = Markup(" + ").join(filter(None, terms))
        if f"{part}direction" not in self.known:
            return told if self.axis == 1 or part.startswith("transverse") else Markup("")
        told = Markup("({})").format(told) if all(terms) else told
        return self.term(
            "{told} cos {@direction}" if self.axis == 1 else "{told} sin {@direction}", part=part, told=told
        )


def equations(study: Study) -> list[Markup]:
    """Write what is solved: motion along the belt and across it, slip, varying load; of a prescribed slip that."""
    along, across = (Letters.of(study, axis) for axis in (1, 2))
    slips = [_slip(study, along)]
    if study.scene.planar or across.shaken("slip."):
        slips.append(_slip(study, across))
    moving = (along, across)[: study.scene.degrees_of_freedom]
    lines = [
        *(_motion(study, each) for each in moving),
        *([Markup(", &ensp; ").join(slips)] if moving else slips),
    ]
    if study.scene.normal_load_variation:
        varying = along.shaken("normal_load_variation.")
        forms = (f"<i>N</i>({{t}}) = {load} (1 + {{varying}})" for load in _NORMAL)
        lines.append(along.term(*forms, varying=varying))
    return lines


def _motion(study: Study, letters: Letters) -> Markup:
    """Inertia, dashpot, spring and friction against the load."""
    scene, on_belt = study.scene, letters.axis == 1
    part, load = ("", "drive.") if on_belt else ("transverse.", "transverse.load.")
    stretch, rate = (letters.term(*(forms if on_belt else forms[1:])) for forms in (_STRETCH, _RATE))
    springs = () if on_belt and scene.is_free else _SPRING
    body = [
        letters.term(*each, part=part, stretch=stretch, rate=rate) for each in (_INERTIA, _DASHPOT, springs)
    ]
    if on_belt and "receptance" in scene.body_terms:
        body = [letters.term("<i>H</i><sup>\N{MINUS SIGN}1</sup> {x}")]
    beside = [letters.term(each) for each in _BESIDE if on_belt]
    normal = ["<i>N</i>({t})"] if scene.normal_load_variation else _NORMAL
    friction = letters.term(*(f"{each} <i>T</i><sub>{letters.axis}</sub>" for each in normal))
    loads = [*map(letters.shaken, dict.fromkeys(["drive.", load]))]
    left, right = (Markup(" + ").join(filter(None, terms)) for terms in ([*body, *beside, friction], loads))
    return Markup("{} = {}").format(left, right or "0")


def _slip(study: Study, letters: Letters) -> Markup:
    """Slip velocity: that of the mass, or that which is prescribed, less that of the belt."""
    across = letters.shaken("transverse_slip.") if letters.axis == 2 else ""
    first = letters.term("{v}") if study.scene.degrees_of_freedom else letters.shaken("slip.") or across
    less = [letters.term("{belt_speed}") if letters.axis == 1 else "", letters.shaken("belt_vibration.")]
    told = Markup(" \N{MINUS SIGN} ").join([first, *filter(None, less)]).strip()
    return Markup("<i>v</i><sub>{}</sub> = {}").format(letters.axis, told or "0")
