"""Rules on which parts of a scene go together, in whatever units: each problem as ``path: what``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

from frictionlab.scene.parts import BY_TABLE
from frictionlab.scene.signals import FULL_TURN, signal_of
from frictionlab.scene.waveforms import LONGEST_COMMON, as_fraction

SHAKEN = "belt_vibration", "normal_load_variation"
"""Parts that take the drive's frequency, or give one if there is no drive."""


def problems_of_parts(scene: Any) -> list[str]:
    """Return the problems of a body's loads and of its other excitations."""
    found = [*_missing_parts(scene), *_directions(scene)]
    found = found or [*_problems_of_frequencies(scene)]
    return found or _problems_of_variation(scene)


def replaced_by_table(scene: Any, names: Iterable[str]) -> list[str]:
    """Return a problem for each of these names, and of the body's other keys, that a receptance replaces."""
    body = [f"body.{name}" for name in type(scene.body).model_fields if getattr(scene.body, name)]
    stray = [name for name in body if name != f"body.{BY_TABLE}"]
    stray += [name for name in names if getattr(scene, name) is not None]
    return [f"{name}: leave it out, body.receptance stands for the whole body" for name in stray]


def problems_of_slip(scene: Any) -> list[str]:
    """Return the problems of a prescribed slip, and of the variation of its normal load."""
    for name in ("damping_ratio", "spring", "drive", "transverse", "body", "initial", "belt_vibration"):
        if getattr(scene, name, None) is not None:
            return [f"{name}: leave it out with a prescribed slip"]
    if scene.transverse_slip is not None and scene.slip is not None and scene.slip.direction is not None:
        return ["slip.direction: leave it out with transverse_slip"]
    frequency = (scene.slip or scene.transverse_slip).key("frequency")
    own = getattr(scene.transverse_slip, frequency) if scene.transverse_slip is not None else None
    if scene.slip is not None and own is not None:
        return [f"transverse_slip.{frequency}: leave it out, slip.{frequency} holds for both"]
    if scene.slip is None and own is None:
        return [f"transverse_slip.{frequency}: required where slip is left out"]
    given = "slip" if scene.slip is not None else "transverse_slip"
    return [*_problems_of_frequencies(scene, given)] or _problems_of_variation(scene)


def _problems_of_variation(scene: Any) -> list[str]:
    """Return the problems of the least common period, and of a normal load that does not stay positive."""
    return [*_period(scene), *_normal_load(scene)]


def _missing_parts(scene: Any) -> Iterator[str]:
    across = scene.transverse.load if scene.transverse is not None else None
    if not _gives_frequency(scene.drive) and _varies(across):
        yield "transverse.load: needs drive for its frequency (amplitude 0 for a load across alone)"
    others = any(getattr(scene, name) is not None for name in SHAKEN)
    if scene.drive is not None and not others and not _gives_frequency(scene.drive):
        yield "drive: a constant force alone only shifts where the spring holds the body: let something vibrate"
    if scene.initial is not None and scene.transverse is None:
        stray = [name for name in scene.initial.model_fields_set if name.startswith(("x2", "velocity2"))]
        yield from (f"initial.{name}: needs transverse" for name in sorted(stray))


def _gives_frequency(drive: Any) -> bool:
    return drive is not None and getattr(drive, drive.key("frequency")) is not None


def _varies(force: Any) -> bool:
    """Check whether a force is more than a constant one."""
    return force is not None and any(
        getattr(force, force.key(name)) is not None for name in force.alternatives
    )


def _directions(scene: Any) -> Iterator[str]:
    if scene.transverse is None:
        for name in ("drive", "belt_vibration"):
            part = getattr(scene, name)
            if part is not None and part.direction:
                yield f"{name}.direction: needs transverse, without which nothing moves across the belt"
    elif scene.transverse.load is not None and scene.drive is not None and scene.drive.direction is not None:
        yield "drive.direction: leave it out with transverse.load, which gives the force across the belt"


def _problems_of_frequencies(scene: Any, given: str = "") -> Iterator[str]:
    """Yield the problems of parts that take a frequency or give one.

    ``given`` names the part that gives it: the drive if there is one.
    """
    given = "drive" if _gives_frequency(scene.drive) else given
    parts = {name: part for name in SHAKEN if (part := getattr(scene, name)) is not None}
    if not parts:
        return
    frequency = next(iter(parts.values())).key("frequency")
    own = {name for name, part in parts.items() if getattr(part, frequency) is not None}
    for name, part in parts.items():
        if name in own and given:
            yield (
                f"{name}.{frequency}: leave it out, {given}.{frequency} holds for all "
                "(frequency_ratio gives another in shares of it)"
            )
        elif name in own and part.frequency_ratio is not None:
            yield f"{name}.frequency_ratio: leave it out where {frequency} is given"
        elif name in own:
            given = name
        elif not given and not own:
            yield f"{name}.{frequency}: required where drive is left out"
            given = name


def problems_of_free(scene: Any, spring: str) -> list[str]:
    """Return the problems of a body that no spring holds; ``spring`` is the key that says so."""
    shaken = _gives_frequency(scene.drive) or any(getattr(scene, name) is not None for name in SHAKEN)
    nothing = f"{spring}: a body that nothing shakes needs a spring: without one it slides as the belt does"
    bent = "body: leave it out where no spring holds the body"
    return [*([] if shaken else [nothing]), *([bent] if scene.body is not None else [])]


def frequency_of(scene: Any) -> float:
    """Return the frequency of the drive, of a prescribed slip or of another part that gives one, else 1."""
    parts = scene.drive, scene.slip, scene.transverse_slip, *(getattr(scene, name) for name in SHAKEN)
    found = (getattr(part, part.key("frequency")) for part in parts if part is not None)
    return next((float(each) for each in found if each is not None), 1.0)


def periods_of(scene: Any) -> int:
    """Return the number of periods of the drive after which everything that changes in time has repeated."""
    return math.lcm(*_denominators(scene).values())


def _denominators(scene: Any) -> dict[str, int]:
    """Return the denominator of every frequency ratio, by the part that has it."""
    load = scene.transverse.load if scene.transverse is not None else None
    parts = ("transverse.load", load), *((name, getattr(scene, name)) for name in SHAKEN)
    return {
        name: as_fraction(part.frequency_ratio).denominator
        for name, part in parts
        if part is not None and part.frequency_ratio is not None
    }


def _period(scene: Any) -> Iterator[str]:
    denominators = _denominators(scene)
    if denominators and (periods := math.lcm(*denominators.values())) > LONGEST_COMMON:
        yield (
            f"{max(denominators, key=denominators.__getitem__)}.frequency_ratio: with it everything repeats after "
            f"{periods} periods of the drive only, more than {LONGEST_COMMON}: choose smaller denominators"
        )


def _normal_load(scene: Any) -> Iterator[str]:
    part = scene.normal_load_variation
    if part is None:
        return
    least = signal_of(part.waveform, 1.0, 0.0, mean=False).extremes(FULL_TURN)[0]
    if not 1.0 + part.amplitude * least > 1e-9:
        yield (
            "normal_load_variation.amplitude: the normal load must stay positive over the whole period, here "
            f"for amplitudes below {-1.0 / least:.6g}, got {part.amplitude:.6g}"
        )
