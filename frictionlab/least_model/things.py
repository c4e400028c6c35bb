"""Everything that may be taken away from a model, from the scene's parts to the way its motion is found."""

from __future__ import annotations

from typing import NamedTuple

from frictionlab.least_model.contact import rigid, undamped_bristles, without_fall, without_viscosity
from frictionlab.least_model.lesser import LesserModel, Taken
from frictionlab.least_model.motion import cut_to, friction_free_of, orders
from frictionlab.least_model.shaking import on_a_line, sines, steady_normal_load, without_load_across
from frictionlab.least_model.without_rest import slipping


class Thing(NamedTuple):
    """A part of a model. group: of those of one group one alone is taken away, a later one takes more away.

    weight: by which sets of things are ranked: a heavier one outweighs all lighter ones together.
    """

    name: str
    group: str
    weight: int
    away: Taken


def things(rests: bool) -> tuple[Thing, ...]:
    """In the order in which several are taken away; of a group the later ones take more away.

    rests: whether the full motion rests at some belt speed.
    """
    cuts = [
        Thing(f"harmonics above {n}", "motion", 20 + 10 * rank, cut_to(n))
        for rank, n in enumerate(reversed(orders()))
    ]
    return (
        Thing("waveform", "waveform", 1, sines),
        Thing("load variation", "normal load", 1, steady_normal_load),
        Thing("load across the belt", "across", 1, without_load_across),
        Thing("transverse motion", "across", 1000, on_a_line),
        Thing("bristle damping", "bristles", 1, undamped_bristles),
        Thing("contact compliance", "bristles", 400, rigid),
        Thing("fall of friction with speed", "fall", 1, without_fall),
        Thing("viscosity", "viscosity", 1, without_viscosity),
        *([Thing("stick", "motion", 10, slipping)] if rests else []),
        *cuts,
        Thing("friction's effect on the motion", "motion", 200, friction_free_of),
    )


def without_these(model: LesserModel, chosen: tuple[Thing, ...]) -> LesserModel | None:
    """The model without these things; None where it has one of them not. Raises CannotGo, WrongValues."""
    found: LesserModel | None = model
    for thing in chosen:
        found = None if found is None else thing.away(found)
    return found
