"""The equations of motion of a study with its numbers in them; what is swept stays a symbol."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup, escape

from frictionlab.report.tables import number, symbol_html
from frictionlab.scene.waveforms import SINE
from frictionlab.study.study import Study

_MINUS = "\N{MINUS SIGN}"
_BY_TABLE = "body.receptance"
_SI = {
    "frequency": "frequency_rad_per_s",
    "unbalance": "unbalance_kg_m",
    "amplitude": "amplitude_N",
    "offset": "offset_N",
    "belt_speed": "belt_speed_m_per_s",
}


def equations(study: Study) -> list[Markup]:
    """What is solved: the motion along the belt and across it, slip, and what varies; of a prescribed slip that."""
    n, degrees = _Numbers.of(study), study.scene.degrees_of_freedom
    axes = range(1, degrees + 1)
    slips = [_slip_of_mass(n, axis) for axis in axes]
    lines = [*(_motion(n, axis) for axis in axes), *([Markup(", &ensp; ").join(slips)] if slips else [])]
    if degrees == 0:
        lines = [_slip_line(n, 1, "slip")]
        lines += [_slip_line(n, 2, "transverse_slip")] if n.has("transverse_slip") else []
    if n.has("normal_load_variation"):
        varying = Markup("(1 + {})").format(_wave(n, "normal_load_variation", "amplitude"))
        lines.append(Markup("<i>N</i> = {}").format(_times(_load(n), varying)))
    return lines


def letters_sentence(study: Study) -> str:
    """What the letters of the equations are that no other table of the page names."""
    told = ["T is the friction coefficient of the law, along the slip velocity v"]
    if study.scene.degrees_of_freedom:
        told[0] += "; a mass that sticks has v = 0"
    if any("<i>w</i>" in line for line in equations(study)):
        told.append("w is the waveform")
    if _Numbers.of(study).has(_BY_TABLE):
        told.append("H is the receptance of the table, harmonic by harmonic")
    if study.scene.dimensional is not None:
        told.append("forces are in N, lengths in m, t in s")
    return f"{'; '.join(told)}."


_WITH_FREQUENCY = "drive", "slip", "transverse_slip", "belt_vibration", "normal_load_variation"


@dataclass(frozen=True)
class _Numbers:
    """The values of a scene by their paths, in the units given. owner: the part that has the frequency."""

    values: Mapping[str, Any]
    swept: set[str]
    in_si: bool
    owner: str

    @classmethod
    def of(cls, study: Study) -> _Numbers:
        in_si = study.scene.dimensional is not None
        kept = "dimensional." if in_si else ""
        values = {path.removeprefix(kept): value for path, value in study.scene.given_values().items()}
        swept = {path.removeprefix("scene.").removeprefix(kept) for path in study.sweep}
        owners = (name for name in _WITH_FREQUENCY if any(path.startswith(f"{name}.freq") for path in values))
        return cls(values, swept, in_si, next(owners, ""))

    def has(self, part: str) -> bool:
        return any(path == part or path.startswith(f"{part}.") for path in (*self.values, *self.swept))

    def path(self, part: str, name: str) -> str:
        own = _SI.get(name, name) if self.in_si and part.partition(".")[0] not in _SHARES else name
        if self.in_si and name == "frequency":
            own = _SI[name]
        return f"{part}.{own}" if part else own

    def fixed(self, path: str) -> float | None:
        """Its number; None where it is swept, or no number."""
        value = self.values.get(path)
        return None if path in self.swept or isinstance(value, str) or value is None else float(value)

    def product(self, *paths: str, factor: float = 1.0) -> Markup:
        """Of a factor and the numbers of these paths; a swept one stays a symbol, to the power that it has there."""
        symbols = Counter(path for path in paths if self.fixed(path) is None)
        value = factor * math.prod(fixed for path in paths if (fixed := self.fixed(path)) is not None)
        unit = "scene.dimensional." if self.in_si else "scene."
        powers = {path: Markup("<sup>{}</sup>").format(power) for path, power in symbols.items() if power > 1}
        told = Markup(" ").join(symbol_html(f"{unit}{path}") + powers.get(path, "") for path in symbols)
        return _times(_signed(value), told) if told and value else _signed(value)

    @property
    def letters(self) -> tuple[str, str, str]:
        """Place, velocity and acceleration."""
        return ("X", "\u1e8a", "\u1e8c") if self.in_si else ("x", "\u1e8b", "\u1e8d")

    @property
    def frequency(self) -> str:
        return self.path(self.owner, "frequency")


_SHARES = frozenset({"normal_load_variation"})
"""Parts whose amplitude has no unit."""


def _signed(value: float) -> Markup:
    """A number with a minus, not a hyphen, and its power of ten as one."""
    digits, _, power = number(value).replace("-", _MINUS).partition("e")
    if not power:
        return Markup(digits)
    times = "" if digits == "1" else f"{digits}·"
    return Markup("{}10<sup>{}</sup>").format(times, power.lstrip("+0").replace(f"{_MINUS}0", _MINUS))


def _motion(n: _Numbers, axis: int) -> Markup:
    """Inertia, dashpot, spring and friction against the load."""
    place, first, second = (Markup("<i>{}</i><sub>{}</sub>").format(each, axis) for each in n.letters)
    mass, dashpot, spring = _coefficients(n, axis)
    bent, stretched, more = _bends(n, place, first) if axis == 1 else (first, place, [])
    terms = [_times(mass, second), _times(dashpot, bent), _times(spring, stretched), *more]
    if axis == 1 and n.has(_BY_TABLE):
        terms = [_times(Markup("<i>H</i><sup>\N{MINUS SIGN}1</sup>"), place)]
    normal = Markup("<i>N</i>") if n.has("normal_load_variation") else _load(n)
    friction = _times(normal, Markup("<i>T</i><sub>{}</sub>").format(axis))
    left = Markup(" + ").join(each for each in [*terms, friction] if each)
    return Markup("{} = {}").format(left, Markup(" + ").join(_loads(n, axis)) or "0")


def _bends(n: _Numbers, place: Markup, rate: Markup) -> tuple[Markup, Markup, list[Markup]]:
    """What dashpot and spring along the belt are multiplied by, and the terms beside them."""
    by, strained = "_{}" if n.in_si else "", f"body.curvature{'_per_m' if n.in_si else ''}"
    powers = {
        f"body.cubic_stiffness{by.format('N_per_m3')}": Markup("{}<sup>3</sup>").format(place),
        f"body.amplitude_damping{by.format('N_s_per_m3')}": Markup("{}<sup>2</sup> {}").format(place, rate),
    }
    more = [_times(n.product(path), power) for path, power in powers.items() if n.has(path)]
    if not n.has(strained) or n.fixed(strained) == 0.0:
        return rate, place, more
    once, twice = (_times(n.product(strained, factor=factor), place) for factor in (1.0, 2.0))
    rate = Markup("(1 + {})<sup>2</sup> {}").format(twice, rate)
    return rate, Markup("(1 + {}) (1 + {}) {}").format(once, twice, place), more


def _coefficients(n: _Numbers, axis: int) -> tuple[Markup, Markup, Markup]:
    """Of acceleration, velocity and place."""
    part = "" if axis == 1 else "transverse."
    if n.in_si:
        return n.product("mass_kg"), _dashpot(n, part), n.product(*_spring(n, part))
    natural = [] if axis == 1 else ["transverse.natural_frequency"]
    held = 0.0 if not part and n.values.get("spring") is False else 1.0
    damping = n.product(f"{part}damping_ratio", *natural, factor=2.0)
    return Markup("1"), damping, n.product(*natural, *natural, factor=held)


def _spring(n: _Numbers, part: str) -> tuple[str, ...]:
    """The numbers whose product its stiffness is."""
    given = f"{part}stiffness_N_per_m"
    natural = f"{part}natural_frequency_rad_per_s"
    return (given,) if n.has(given) else ("mass_kg", natural, natural)


def _dashpot(n: _Numbers, part: str) -> Markup:
    """In SI units; of a damping ratio twice that and the square root of stiffness and mass."""
    given, ratio = f"{part}damping_N_s_per_m", f"{part}damping_ratio"
    if n.has(given):
        return n.product(given)
    spring = _spring(n, part)
    if len(spring) > 1:
        return n.product(ratio, *spring[:2], factor=2.0)
    if n.fixed(spring[0]) is None or n.fixed("mass_kg") is None:
        return _times(n.product(ratio, factor=2.0), Markup("√({})").format(n.product(*spring, "mass_kg")))
    return n.product(ratio, factor=2.0 * math.sqrt((n.fixed(spring[0]) or 0.0) * (n.fixed("mass_kg") or 0.0)))


def _times(factor: Markup, what: Markup) -> Markup:
    """A product; nothing where the factor is zero, and a factor of one is not written."""
    if factor == "0":
        return Markup("")
    return what if factor == "1" else Markup("{} {}").format(factor, what)


def _load(n: _Numbers) -> Markup:
    given = [name for name in ("normal_load", "normal_load_N") if n.has(name)]
    return n.product(*(given or (["mass_kg", "gravity_m_per_s2"] if n.in_si else [])))


def _loads(n: _Numbers, axis: int) -> list[Markup]:
    found = []
    if n.has("drive") and (turned := _along(n, "drive", axis)) is not None:
        found.append(Markup("{}{}").format(_force(n, "drive"), turned))
    if axis == 2 and n.has("transverse.load"):
        found.append(_force(n, "transverse.load"))
    part = "drive" if axis == 1 else "transverse.load"
    found.append(n.product(n.path(part, "offset")) if n.has(n.path(part, "offset")) else Markup(""))
    return [each for each in found if each]


def _along(n: _Numbers, part: str, axis: int) -> Markup | None:
    """The share of a part along this axis; None where it has none there."""
    path = f"{part}.direction"
    direction = n.fixed(path)
    if path not in n.swept and not direction:
        return Markup("") if axis == 1 else None
    degrees = "" if path in n.swept else "°"
    return Markup(" {} {}{}").format("cos" if axis == 1 else "sin", n.product(path), degrees)


def _force(n: _Numbers, part: str) -> Markup:
    """The size of a load times its wave; an unbalance grows with the square of the frequency."""
    unbalance = n.path(part, "unbalance")
    if not n.has(unbalance) and not n.has(n.path(part, "amplitude")):
        return Markup("")
    if not n.has(unbalance):
        return _wave(n, part, "amplitude")
    return _times(n.product(unbalance, n.frequency, n.frequency), _form(n, part))


def _wave(n: _Numbers, part: str, size: str) -> Markup:
    return _times(n.product(n.path(part, size)), _form(n, part))


def _form(n: _Numbers, part: str) -> Markup:
    """The waveform of a part with what it depends on."""
    path = f"{part}.waveform"
    form = n.values.get(path)
    name = escape("sin" if form in (None, SINE.shape) else str(form) if " " not in str(form) else "w")
    shown = Markup("<i>w</i>") if path in n.swept or name == "w" else name
    return Markup("{}({})").format(shown, _angle(n, part))


def _angle(n: _Numbers, part: str) -> Markup:
    time = Markup("<i>t</i>") if n.in_si else Markup("<i>τ</i>")
    ratio = f"{part}.frequency_ratio"
    speed = n.product(*([ratio] if n.has(ratio) else []), n.frequency)
    phase = f"{part}.phase"
    if phase in n.swept:
        return Markup("{} + {}").format(_times(speed, time), n.product(phase))
    shift = n.fixed(phase) or 0.0
    sign = f" {'+' if shift > 0.0 else _MINUS} {number(abs(shift))}°" if shift else ""
    return Markup("{}{}").format(_times(speed, time), sign)


def _slip_of_mass(n: _Numbers, axis: int) -> Markup:
    """The slip velocity: that of the mass less that of the belt."""
    part = "belt_vibration"
    told = Markup("<i>v</i><sub>{0}</sub> = <i>{1}</i><sub>{0}</sub>").format(axis, n.letters[1])
    if axis == 1:
        told += Markup(" {}").format(_less(n, n.path("", "belt_speed")))
    turned = _along(n, part, axis) if n.has(part) else None
    if turned is None:
        return told
    return told + Markup(" {} {}{}").format(_MINUS, _times(_velocity(n, part), _form(n, part)), turned)


def _velocity(n: _Numbers, part: str) -> Markup:
    """The velocity amplitude of what shakes."""
    ratio = f"{part}.frequency_ratio"
    angular = [*([ratio] if n.has(ratio) else []), n.frequency]
    if n.has(f"{part}.displacement_amplitude_m"):
        return n.product(f"{part}.displacement_amplitude_m", *angular)
    acceleration = f"{part}.acceleration_amplitude_m_per_s2"
    if not n.has(acceleration):
        return n.product(f"{part}.velocity_amplitude{'_m_per_s' if n.in_si else ''}")
    numbers = [n.fixed(path) for path in angular]
    if any(each is None for each in numbers):
        return Markup("({}) / ({})").format(n.product(acceleration), n.product(*angular))
    return n.product(acceleration, factor=1.0 / math.prod(each or 1.0 for each in numbers))


def _less(n: _Numbers, path: str) -> Markup:
    value = n.fixed(path)
    if value is None or value >= 0.0:
        return Markup("{} {}").format(_MINUS, n.product(path))
    return Markup("+ {}").format(_signed(-value))


def _slip_line(n: _Numbers, axis: int, part: str) -> Markup:
    """A prescribed slip velocity."""
    wave = _times(_velocity(n, part), _form(n, part)) if n.has(part) else Markup("")
    belt = _less(n, n.path("", "belt_speed")) if axis == 1 else Markup("")
    alone = Markup(belt.removeprefix("+ ").replace(f"{_MINUS} ", _MINUS))
    told = Markup("{} {}").format(wave, belt) if wave else alone
    return Markup("<i>v</i><sub>{}</sub> = {}").format(axis, told)
