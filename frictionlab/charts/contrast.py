"""How dark a colour is, as WCAG 2 measures it, and colours of one hue that are as dark as asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

_WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def luminance(color: Any) -> float:
    """0 for black, 1 for white."""
    return float(_WEIGHTS @ _linear(color))


def contrast(color: Any) -> float:
    """Of a colour against white, 1 to 21."""
    return 1.05 / (luminance(color) + 0.05)


def with_contrast(color: Any, wanted: float) -> tuple[float, float, float]:
    """The colour mixed with as much black or white as gives it this contrast against white."""
    light, level = _linear(color), 1.05 / wanted - 0.05
    own = float(_WEIGHTS @ light)
    mixed = light * level / own if level < own else 1.0 - (1.0 - light) * (1.0 - level) / (1.0 - own)
    red, green, blue = np.where(mixed <= 0.0031308, 12.92 * mixed, 1.055 * mixed ** (1 / 2.4) - 0.055)
    return float(red), float(green), float(blue)


def _linear(color: Any) -> NDArray[np.float64]:
    levels = np.array(to_rgb(color), dtype=np.float64)
    return np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)
