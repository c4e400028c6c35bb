"""The equations of motion of a study with its numbers in them; what is swept stays a symbol."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup, escape

from frictionlab.report.markup import symbol_html
from frictionlab.report.tables import number
from frictionlab.scene.waveforms import SINE
from frictionlab.study import Study

_MINUS = "\N{MINUS SIGN}"
_SI = {
    "frequency": "frequency_rad_per_s",
    "unbalance": "unbalance_kg_m",
    "amplitude": "amplitude_N",
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

    def shown(self, path: str) -> Markup:
        """Its number, or its symbol where it is swept."""
        if (value := self.fixed(path)) is None:
            return symbol_html(f"scene.{'dimensional.' if self.in_si else ''}{path}")
        return _signed(value)

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
    return Markup(number(value).replace("-", _MINUS))


def _motion(n: _Numbers, axis: int) -> Markup:
    """Inertia, dashpot, spring and friction against the load."""
    place, first, second = (Markup("<i>{}</i><sub>{}</sub>").format(each, axis) for each in n.letters)
    mass, dashpot, spring = _coefficients(n, axis)
    terms = [_times(mass, second), _times(dashpot, first), _times(spring, place)]
    normal = Markup("<i>N</i>") if n.has("normal_load_variation") else _load(n)
    friction = _times(normal, Markup("<i>T</i><sub>{}</sub>").format(axis))
    left = Markup(" + ").join(each for each in [*terms, friction] if each)
    return Markup("{} = {}").format(left, Markup(" + ").join(_loads(n, axis)) or "0")


def _coefficients(n: _Numbers, axis: int) -> tuple[Markup, Markup, Markup]:
    one = Markup("1")
    if n.in_si:
        part = "" if axis == 1 else "transverse."
        names = f"{part}damping_N_s_per_m", f"{part}stiffness_N_per_m"
        return n.shown("mass_kg"), n.shown(names[0]), n.shown(names[1])
    if axis == 1:
        ratio = n.fixed("damping_ratio")
        return one, _doubled(ratio, n.shown("damping_ratio")), one
    ratio, natural = (n.fixed(f"transverse.{name}") for name in ("damping_ratio", "natural_frequency"))
    symbol = n.shown("transverse.natural_frequency")
    if natural is None:
        dashpot = Markup("{} {}").format(_doubled(ratio, n.shown("transverse.damping_ratio")), symbol)
        return one, Markup("0") if ratio == 0.0 else dashpot, Markup("{}<sup>2</sup>").format(symbol)
    shown = Markup("{} {}").format(_signed(natural), n.shown("transverse.damping_ratio"))
    return one, _doubled(None if ratio is None else ratio * natural, shown), _signed(natural**2)


def _doubled(value: float | None, shown: Markup) -> Markup:
    return Markup("2 {}").format(shown) if value is None else _signed(2.0 * value)


def _times(factor: Markup, what: Markup) -> Markup:
    """A product; nothing where the factor is zero, and a factor of one is not written."""
    if factor == "0":
        return Markup("")
    return what if factor == "1" else Markup("{} {}").format(factor, what)


def _load(n: _Numbers) -> Markup:
    if not n.in_si:
        return n.shown("normal_load") if n.has("normal_load") else Markup("1")
    if n.has("normal_load_N"):
        return n.shown("normal_load_N")
    mass, gravity = n.fixed("mass_kg"), n.fixed("gravity_m_per_s2")
    if mass is not None and gravity is not None:
        return _signed(mass * gravity)
    return Markup("{} {}").format(n.shown("mass_kg"), n.shown("gravity_m_per_s2"))


def _loads(n: _Numbers, axis: int) -> list[Markup]:
    found = []
    if n.has("drive") and (turned := _along(n, "drive", axis)) is not None:
        found.append(Markup("{}{}").format(_force(n, "drive"), turned))
    if axis == 2 and n.has("transverse.load"):
        found.append(_force(n, "transverse.load"))
    return [each for each in found if each]


def _along(n: _Numbers, part: str, axis: int) -> Markup | None:
    """The share of a part along this axis; None where it has none there."""
    path = f"{part}.direction"
    direction = n.fixed(path)
    if path not in n.swept and not direction:
        return Markup("") if axis == 1 else None
    degrees = "" if path in n.swept else "°"
    return Markup(" {} {}{}").format("cos" if axis == 1 else "sin", n.shown(path), degrees)


def _force(n: _Numbers, part: str) -> Markup:
    """The size of a load times its wave; an unbalance grows with the square of the frequency."""
    if not n.has(n.path(part, "unbalance")):
        return _wave(n, part, "amplitude")
    size, omega = n.fixed(n.path(part, "unbalance")), n.fixed(n.frequency)
    if size is not None and omega is not None:
        return _times(_signed(size * omega**2), _form(n, part))
    squared = Markup("{}<sup>2</sup>").format(n.shown(n.frequency))
    product = Markup("{} {}").format(n.shown(n.path(part, "unbalance")), squared)
    return Markup("{} {}").format(squared if size == 1.0 else product, _form(n, part))


def _wave(n: _Numbers, part: str, size: str) -> Markup:
    return _times(n.shown(n.path(part, size)), _form(n, part))


def _form(n: _Numbers, part: str) -> Markup:
    """The waveform of a part with what it depends on."""
    path = f"{part}.waveform"
    form = n.values.get(path)
    name = escape("sin" if form in (None, SINE.shape) else str(form) if " " not in str(form) else "w")
    shown = Markup("<i>w</i>") if path in n.swept or name == "w" else name
    return Markup("{}({})").format(shown, _angle(n, part))


def _angle(n: _Numbers, part: str) -> Markup:
    time = Markup("<i>t</i>") if n.in_si else Markup("<i>τ</i>")
    omega, ratio = n.fixed(n.frequency), f"{part}.frequency_ratio"
    times = n.fixed(ratio) if ratio in n.values else 1.0
    if times is None or ratio in n.swept:
        speed = Markup("{} {}").format(n.shown(ratio), n.shown(n.frequency))
    elif omega is None:
        speed = _times(_signed(times), n.shown(n.frequency))
    else:
        speed = _signed(times * omega)
    phase = f"{part}.phase"
    if phase in n.swept:
        return Markup("{} + {}").format(_times(speed, time), n.shown(phase))
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
    size = "velocity_amplitude_m_per_s" if n.in_si else "velocity_amplitude"
    return told + Markup(" {} {}{}").format(_MINUS, _wave(n, part, size), turned)


def _less(n: _Numbers, path: str) -> Markup:
    value = n.fixed(path)
    if value is None or value >= 0.0:
        return Markup("{} {}").format(_MINUS, n.shown(path))
    return Markup("+ {}").format(_signed(-value))


def _slip_line(n: _Numbers, axis: int, part: str) -> Markup:
    """A prescribed slip velocity."""
    wave = _wave(n, part, "velocity_amplitude") if n.has(part) else Markup("")
    belt = _less(n, "belt_speed") if axis == 1 else Markup("")
    alone = Markup(belt.removeprefix("+ ").replace(f"{_MINUS} ", _MINUS))
    told = Markup("{} {}").format(wave, belt) if wave else alone
    return Markup("<i>v</i><sub>{}</sub> = {}").format(axis, told)
