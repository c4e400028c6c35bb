"""Which kernels a study may compile, and what that takes, before anything is computed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from frictionlab.columns import FROM_ORBITS
from frictionlab.compile.call import KernelCall
from frictionlab.study import Study, StudyCurve

COMPILE_SECONDS = {
    "answer_curve": 12.0,
    "maps_of": 6.0,
    "answer_lanes": 10.0,
    "record_in_lanes": 11.0,
    "differentiate_in_lanes": 5.0,
    "continue_in_speed": 4.0,
    "make_orbits": 4.0,
    "read_each": 4.0,
    "follow_undriven": 9.0,
    "follow_period": 8.0,
    "closed_legs": 3.0,
    "friction_of_each": 2.0,
}
"""Processor time [s] that compiling each takes on the machine of docs/bench.md, to a third, whatever the law."""
_OTHERS = 10.0
OF_VARYING = "Packed(", "Forcing("
"""Records that hold what changes in time in a scene, where that is more than one sine."""


def kernels_to_compile(curves: Iterable[StudyCurve], study: Study) -> dict[str, float] | None:
    """Kernels that have no machine code on this machine, name -> seconds that compiling it takes, about.

    At most these: a kernel is compiled where Python would take long over it, and not before. None where some method
    does not know beforehand which kernels it calls.
    """
    missing = dict[str, float]()
    for curve in _one_of_each_kind(curves):
        calls = _calls(curve, study)
        if calls is None:
            return None
        names = {call.name: call.kernel.__name__ for call in calls if not _is_kept(call, curve)}
        missing |= {name: COMPILE_SECONDS.get(kernel, _OTHERS) for name, kernel in names.items()}
    return missing


def _one_of_each_kind(curves: Iterable[StudyCurve]) -> Iterator[StudyCurve]:
    """A curve for each set of what decides which kernels are needed."""
    seen = set()
    for curve in curves:
        scene, law = curve.scenes.scene, curve.law
        of_scene = scene.degrees_of_freedom, scene.undriven, scene.load_along_belt_only, scene.is_harmonic
        kind = (curve.law_label, curve.method.label, type(law), law.structure(), *of_scene)
        if kind not in seen:
            seen.add(kind)
            yield curve


def _calls(curve: StudyCurve, study: Study) -> list[KernelCall] | None:
    """The kernels of a curve; None where they are not known."""
    method, law = curve.method.method, curve.law
    able = [place for place, reason in enumerate(method.refusals(curve.scenes, law)) if reason is None]
    if not able:
        return []
    scenes = curve.scenes.taken(able)
    found = method.kernels(scenes, law, study.tolerance) if scenes.scene.is_harmonic else None
    if found is None:
        return None
    calls = [KernelCall(kernel, law) for kernel, law in found]
    return [*calls, KernelCall(_reader())] if set(FROM_ORBITS) & study.selected() else calls


def _reader() -> Any:
    from frictionlab.orbit.read import read_each  # brings numba: only where it is needed

    return read_each


def _is_kept(call: KernelCall, curve: StudyCurve) -> bool:
    """Whether there is machine code for such a scene: what it is made for is told by the types of its arguments."""
    planar = not curve.scenes.scene.load_along_belt_only
    for types in call.kept_for():
        varies = any(record in types for record in OF_VARYING)
        if not varies and (call.law is None or ("complex" in types) == planar):
            return True
    return False
