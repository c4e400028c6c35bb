"""A derivative and its error from values on both sides of a place, or on the one side where there are any.

Differences over h, h/2, h/4 and h/8 are extrapolated to h = 0 (Richardson, 1911): central ones in even powers of h,
and in all powers where the second derivative jumps; one-sided ones in all powers. Where the two one-sided derivatives
differ by more than their errors the function has a corner there, and no derivative.

The numbers of a scene and of a law by dotted path, and both with one of them changed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.table import cells
from frictionlab.scene.scene import Scene
from frictionlab.values.notes import did_you_mean
from frictionlab.values.quantities import Floats, given_values

_RATIO = "frequency_ratio"
"""A ratio of periods: no motion beside it has the same period."""


class Pair(NamedTuple):
    """A scene and a law as they were given."""

    scene: Scene
    law: FrictionLaw

    def numbers(self) -> dict[str, float]:
        """``scene.<path>`` and ``law.<name>`` of every number that may be changed a little."""
        told = {f"scene.{path}": value for path, value in self.scene.given_values().items()}
        told |= {f"law.{name}": value for name, value in cells(dict(self.law)).items()}
        return {
            path: float(value)
            for path, value in told.items()
            if isinstance(value, float) and not path.endswith(_RATIO) and ".initial." not in path
        }

    def with_(self, path: str, value: float) -> Pair:
        """Both with this number in place of theirs. Raises ValueError where it makes no scene or law."""
        owner, _, name = path.partition(".")
        if owner == "scene":
            return self._replace(scene=self.scene.with_(**{name: value}))
        return self._replace(law=with_numbers(self.law, {name: value}))


def asked_for(numbers: dict[str, float], paths: Any) -> list[str]:
    """Return the paths asked for, all where none are. Raises ValueError, TypeError."""
    if paths is None:
        return list(numbers)
    if isinstance(paths, str) or not all(isinstance(path, str) for path in paths):
        raise TypeError(f"parameters must be a list such as ['law.mu', 'scene.damping_ratio'], got {paths!r}")
    for path in paths:
        if path not in numbers:
            hint = did_you_mean(path, [*numbers])
            raise ValueError(
                f"parameters: no number '{path}' of this scene or law{f'; {hint}' if hint else ''}"
            )
    return list(dict.fromkeys(paths))


INSTEAD = [
    {"stiffness", "presliding_length", "contact_stiffness"},
    {"damping", "contact_damping"},
]
"""Numbers of a law of which one alone is given."""


def with_numbers(law: FrictionLaw, values: Mapping[str, float]) -> FrictionLaw:
    """Return the law with these numbers in place of its own; one of several in a list by ``name[0]``."""
    told = given_values(law)
    for name, value in values.items():
        for group in INSTEAD:
            if name in group:
                told = {key: x for key, x in told.items() if key not in group or key == name}
        head, bracket, place = name.partition("[")
        if bracket:
            several = list(told[head])
            several[int(place.rstrip("]"))] = value
            told[head] = tuple(several)
        else:
            told[name] = value
    return type(law)(**told, label=law.label)


_Values = Callable[[Floats], list[Floats | None]]
"""Function at such offsets, each as an array; None where it has no value there."""

_LEVELS = 4
_NARROWER = 8.0
"""By how much the offsets shrink from one try to the next."""
_MOST_TRIES = 6
CORNER = "there is no derivative here: the two one-sided ones differ"
NO_VALUES = "there are no values close to this one on either side"
_PARTS = 0.5 ** np.arange(_LEVELS)
_AMPLIFIED = 8.0
"""Growth of the errors of single values in an extrapolated difference, over that in one over the smallest offset."""
_SAFETY = 10.0
"""On what the last extrapolation changes: a jump of the second derivative leaves as much as that."""
_FAR_FROM_ROUNDING = 1e3
"""Errors over those of rounding from which on narrower offsets are tried even though errors have risen."""
_DEGREE = 5
"""Degree of the polynomial through the values of both sides; what it leaves is taken for noise."""


class Derivative(NamedTuple):
    """Derivative and its error [of each component]; tries: how often offsets were chosen. reason: '' if found."""

    value: Floats
    error: Floats
    tries: int
    reason: str = ""


def derivative(
    values: _Values, here: Floats, widest: float, noise: Floats, scatters: bool = True
) -> Derivative:
    """Return the derivative of ``values`` at offset 0, where its value is ``here`` and each is in error by ``noise``.

    widest: the largest offset. Offsets shrink until errors no longer fall. scatters: whether values that miss a
    polynomial may be in error by as much.
    """
    best, width, reason, tries = None, widest, NO_VALUES, 0
    for _ in range(_MOST_TRIES):
        tries += 1
        found = values(np.concatenate((width * _PARTS, -width * _PARTS)))
        ahead, behind = _complete(found[:_LEVELS]), _complete(found[_LEVELS:])
        one, why = _from_both(ahead, behind, here, width, noise, scatters)
        if why == CORNER and best is not None:
            best = None  # offsets before were too wide to see it
        reason = why or reason
        if one is not None:
            if best is not None and _size(one.error) >= _size(best.error):
                # errors rise by rounding at last; before that where a corner comes within other offsets
                if _size(best.error) <= _FAR_FROM_ROUNDING * _size(_rounding(width, noise)):
                    break
            else:
                best = one
            if _size(best.error) <= 2.0 * _size(_rounding(width, noise)):
                break
        width /= _NARROWER
    if best is None:
        return Derivative(np.full(here.shape, np.nan), np.full(here.shape, np.nan), tries, reason)
    return best._replace(tries=tries)


def _size(error: Floats) -> float:
    return float(np.linalg.norm(error))


def _rounding(width: float, noise: Floats) -> Floats:
    return np.asarray(_AMPLIFIED * noise / (width * _PARTS[-1]))


def _complete(values: list[Floats | None]) -> Floats | None:
    known = [each for each in values if each is not None and np.isfinite(each).all()]
    return np.array(known) if len(known) == len(values) else None


def _from_both(
    ahead: Floats | None, behind: Floats | None, here: Floats, width: float, noise: Floats, scatters: bool
) -> tuple[Derivative | None, str]:
    """Return the derivative, or why there is none over these offsets."""
    steps, rounding = (width * _PARTS)[:, None], _rounding(width, noise)
    if ahead is None and behind is None:
        return None, NO_VALUES
    if ahead is None or behind is None:
        quotients = [
            (side - here) / way for side, way in ((ahead, steps), (behind, -steps)) if side is not None
        ]
        return _extrapolated(quotients[0], 1.0, rounding), ""
    after, before = (ahead - here) / steps, (here - behind) / steps
    right, left = _extrapolated(after, 1.0, rounding), _extrapolated(before, 1.0, rounding)
    if (np.abs(right.value - left.value) > 2.0 * (right.error + left.error)).any():
        return None, CORNER
    if scatters:
        rounding = rounding + _rounding(width, _scatter(ahead, behind, here))
    smooth, bent = (_extrapolated(0.5 * (after + before), power, rounding) for power in (2.0, 1.0))
    better = smooth.error <= bent.error
    value = np.where(better, smooth.value, bent.value)
    return Derivative(value, np.where(better, smooth.error, bent.error), 1), ""


def _scatter(ahead: Floats, behind: Floats, here: Floats) -> Floats:
    """By how much values on both sides miss a polynomial."""
    values = np.vstack((ahead, here, behind))
    powers = np.vander(np.concatenate((_PARTS, [0.0], -_PARTS)), _DEGREE + 1)
    fitted = powers @ np.linalg.lstsq(powers, values, rcond=None)[0]
    left_over: Floats = np.abs(values - fitted).max(axis=0)
    return left_over


def _extrapolated(quotients: Floats, power: float, rounding: Floats) -> Derivative:
    """To h = 0, in powers of h^power; the error is what the last extrapolation but one says otherwise."""
    table, before = quotients, quotients
    for order in range(1, _LEVELS):
        factor = 2.0 ** (power * order)
        before, table = table, (factor * table[1:] - table[:-1]) / (factor - 1.0)
    return Derivative(table[0], _SAFETY * np.abs(table[0] - before).max(axis=0) + rounding, 1)
