"""Numbers of laws that are out of all proportion to a scene in SI units: a bare 1 is a metre, not a micrometre."""

from __future__ import annotations

import math
from collections.abc import Iterator

from frictionlab.mistakes.notes import Note
from frictionlab.quantities import Written, dimensions
from frictionlab.scene.units import LENGTH, VELOCITY
from frictionlab.study import Study
from frictionlab.study.yaml_source import read_file
from frictionlab.theory.linear import velocity_scale
from frictionlab.units.shown import handy_unit
from frictionlab.units.text import quantity_in, unit_of_dimension

WHAT = {LENGTH: "the amplitude of the motion without friction", VELOCITY: "the fastest speed of the scene"}
"""By dimension, what a number is measured by."""
MOST = {LENGTH: 300.0, VELOCITY: 30.0}
"""Of that, beyond which a number is doubted."""


def doubts(study: Study) -> list[str]:
    """A sentence on each, with its place in the file of the study."""
    notes = list(_notes(study))
    if not notes or study.path is None:
        return [note.what for note in notes]
    places = read_file(study.path).located(notes)
    return [
        f"{each.origin}:{each.place.line if each.place else 1}: {each.path}: {each.what}" for each in places
    ]


def _notes(study: Study) -> Iterator[Note]:
    scene = study.scene
    if scene.dimensional is None or scene.undriven:
        return
    swing, scales = velocity_scale(scene), scene.dimensional.scales
    speeds = study.sweep.get("scene.dimensional.belt_speed_m_per_s", (scene.dimensional.belt_speed_m_per_s,))
    fastest = max(swing * scales.velocity, *(abs(speed) for speed in speeds if isinstance(speed, float)))
    sizes = {LENGTH: swing / scene.frequency * scales.length, VELOCITY: fastest}
    for place, choice in enumerate(study.laws):
        law, swept = choice.law(), study.swept_parameters(choice)
        for name, dimension in dimensions(choice.law_class).items():
            value, size = getattr(law, name), sizes.get(dimension, math.inf)
            if name in swept or not isinstance(value, float) or isinstance(value, Written):
                continue
            if value > MOST.get(dimension, math.inf) * size:
                unit = unit_of_dimension(dimension)
                times, shown = float(f"{value / size:.1g}"), handy_unit(unit, size).text(float(f"{size:.2g}"))
                taken = f"{value:g} {unit} is taken, {times:,.0f} times {WHAT[dimension]}, {shown}"
                meant = f"give it with its unit, such as {quantity_in(unit).example}"
                yield Note(("laws", place, name), f"{taken}; {meant}")
