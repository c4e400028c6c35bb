"""Kernels compiled ahead: every law's, for the scenes that studies are made of."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import combinations, product
from typing import Any, NamedTuple

from frictionlab.compile.call import compiling_at_once
from frictionlab.compile.notice import compiled_here
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.runner.api import curve
from frictionlab.runner.steady_state import steady_state
from frictionlab.scene.scene import Drive, Scene, Slip, Transverse, TransverseSlip

_DRIVEN = Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=1.0, drive=Drive(amplitude=2.0, frequency=1.5))
_ACROSS = Transverse.model_validate(
    {"natural_frequency": 2.0, "damping_ratio": 0.1, "load": {"amplitude": 1.0, "phase": 90.0}}
)
_SLIP = Scene(slip=Slip(velocity_amplitude=2.0, frequency=1.0), belt_speed=1.0)
SCENES = {
    "a mass shaken along the belt": _DRIVEN,
    "a mass shaken along and across the belt": _DRIVEN.with_(transverse=_ACROSS),
    "a mass on a belt that is not shaken": Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=0.5),
    "slip given along the belt": _SLIP,
    "slip given along and across the belt": _SLIP.with_(
        transverse_slip=TransverseSlip(velocity_amplitude=1.0, phase=90.0)
    ),
}
"""One of every kind that has kernels of its own."""
SPEEDS = 1.0, 1.2, 1.4, 1.6
_USUAL, _OTHERS = 0.5, (0.25, 1.5)


class Warmed(NamedTuple):
    """Kernels of a law for a kind of scene: how many were compiled, and in how long [s]."""

    law: str
    scene: str
    kernels: int
    seconds: float


def warm(laws: dict[str, type[FrictionLaw]]) -> Iterator[Warmed]:
    """Compile what one point of each kind of scene needs, law by law; what is kept already takes no time.

    Raises BrokenPlugin.
    """
    for name, kind in laws.items():
        for what, scene in SCENES.items():
            start, before = time.perf_counter(), len(compiled_here)
            with compiling_at_once():
                for law in forms(kind):
                    steady_state(scene, law, tolerance=1e-4)
                    if (
                        scene.transverse is not None
                    ):  # several belt speeds are answered by kernels of their own
                        curve(scene, law, SPEEDS, tolerance=1e-4)
            yield Warmed(name, what, len(compiled_here) - before, time.perf_counter() - start)


def forms(kind: type[FrictionLaw]) -> list[FrictionLaw]:
    """A law with each set of properties that kernels are compiled for, found by varying its parameters."""
    numbers = {name: field for name, field in kind.model_fields.items() if _may_be_a_number(field.default)}
    required = [name for name, field in kind.model_fields.items() if field.is_required()]
    values: list[tuple[Any, ...]] = [*product(*[(_USUAL, (_USUAL,))] * len(required))]  # lists, too
    rising = tuple(_USUAL + 0.25 * place for place in range(len(required)))  # where one must be above another
    values += [rising, rising[::-1]]
    bases = [dict(zip(required, each, strict=True)) for each in values]
    single: list[dict[str, Any]] = [{name: value} for name in numbers for value in _OTHERS]
    more = [{}, *single, *(one | other for one, other in combinations(single, 2))]
    given = [base | each for base in bases for each in more]
    found: dict[tuple[Any, ...], FrictionLaw] = {}
    for each in given:
        try:
            law = kind.model_validate(each)
        except ValueError:
            continue
        found.setdefault(_form(law), law)
    return list(found.values())


def _form(law: FrictionLaw) -> tuple[Any, ...]:
    """Return what kernels are chosen by."""
    return *law.structure(), isinstance(law, BristleLaw) and law.exact_path()


def _may_be_a_number(default: object) -> bool:
    return default is None or (isinstance(default, int | float) and not isinstance(default, bool))
