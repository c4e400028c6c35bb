"""The kinds of period maps, by what a law remembers: how fine each is, and what is said of it."""

from __future__ import annotations

from typing import NamedTuple

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.words import ModelWord


class MapKind(NamedTuple):
    """What is known of a kind of map.

    said: of how it is computed, in ``model``. rough: accuracy of the maps that follow a transient: with memory they
    are of lower order. finest: tolerance on the mean of maps that are differentiated; noise: what steps chosen
    otherwise change in them, relative to the size of a state.
    """

    said: str
    rough: float
    finest: float = 1e-10
    noise: float = 2e-12


_OF_MEMORY = MapKind(ModelWord.WITH_MEMORY, rough=1e-7)
MAP_KINDS = {
    "none": MapKind("", 1e-9, finest=1e-12, noise=1e-14),
    "exact path": MapKind(ModelWord.SLIP_PATH, 1e-6, finest=1e-12, noise=1e-14),
    "bristle": MapKind(ModelWord.WITH_BRISTLE, rough=1e-6),
    "deflections": _OF_MEMORY,
    "scalars": _OF_MEMORY,
}
"""By the kind of memory, and that of a bristle whose deflection the slip path tells."""


def map_kind(law: FrictionLaw, pathless: bool) -> str:
    """Which period map serves a law: that of an exact path along a line, else that of its kind of memory.

    pathless: in the plane, or on a body that remembers.
    """
    exact = not pathless and isinstance(law, BristleLaw) and law.exact_path()
    return "exact path" if exact else law.memory_kind
