"""What shakes a scene, from its parts; read once of all scenes that differ in belt speed alone."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

from frictionlab.scene.parts import BeltVibration, Drive, Load, NormalLoadVariation, Slip, TransverseSlip
from frictionlab.scene.signals import FULL_TURN, Signal, Signals, signal_of
from frictionlab.scene.varying import varying_of
from frictionlab.scene.waveforms import SINE


class Shaking(NamedTuple):
    """Everything that changes in time, its harmonics at the frequency of the drive along x1 and x2, and what kernels
    are told of what changes otherwise than as one sine; nothing where nothing does."""

    signals: Signals
    load: tuple[complex, complex]
    belt: tuple[complex, complex]
    varying: Any


@lru_cache(maxsize=1024)
def shaking_by(
    parts: tuple[Drive | None, Load | None, Slip | None, TransverseSlip | None],
    others: tuple[BeltVibration | None, NormalLoadVariation | None],
    omega: float,
    periods: int,
    normal_load: float,
    is_harmonic: bool,
) -> Shaking:
    (drive, load, slip, across), (belt, normal) = parts, others
    moved = _pair(slip or belt, across, omega)
    variation = _signal(normal, omega).scaled(normal_load)
    signals = Signals(FULL_TURN * periods / omega, _pair(drive, load, omega), moved, variation)
    first, second, third, fourth = (
        each.harmonic(omega, signals.period) for each in (*signals.load, *signals.belt)
    )
    varying = () if is_harmonic else varying_of(signals, omega, keeps_stiffness(normal))
    return Shaking(signals, (first, second), (third, fourth), varying)


def keeps_stiffness(part: NormalLoadVariation | None) -> bool:
    """Whether bristles do while the normal load changes."""
    return part is not None and part.amplitude > 0.0 and part.contact == "constant"


def _signal(part: Any, omega: float) -> Signal:
    """Its waveform, as large as it says; omega: the frequency of the drive."""
    if part is None:
        return Signal()
    ratio = getattr(part, "frequency_ratio", None) or 1.0
    return signal_of(part.waveform or SINE, omega * ratio, part.phase).scaled(part.size(omega))


def _pair(part: Any, across: Any, omega: float) -> tuple[Signal, Signal]:
    """A part and one across the belt: along x1, and along x2."""
    along, aside = _turned(_signal(part, omega), (part and part.direction) or 0.0)
    return along, aside if across is None else _signal(across, omega)


def _turned(signal: Signal, direction: float) -> tuple[Signal, Signal]:
    """Its parts along x1 and x2, where it acts at an angle [degrees] to x1; right angles to the last digit."""
    quarters, rest = divmod(direction, 90.0)
    along, across = (
        (1.0, 0.0) if rest == 0.0 else (math.cos(math.radians(rest)), math.sin(math.radians(rest)))
    )
    for _ in range(int(quarters) % 4):
        along, across = -across, along
    return signal.scaled(along), signal.scaled(across)
