"""Laws with memory: one bristle deflection, several deflections, or scalars such as the age of a contact.

A law states how many numbers it remembers and the rate of each; methods keep them in an array. One source serves
interpreted and compiled runs, on the line and in the plane.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any, ClassVar, Literal

from frictionlab.laws.base import FrictionLaw

VECTORIAL, ROTATED, PER_AXIS = 0.0, 1.0, 2.0


class BristleLaw(FrictionLaw, ABC):
    """A law whose memory is one bristle deflection z [scene length]: slip changes it and friction depends on it.

    planar: how the law of one direction extends to the plane. ``vectorial``: v and z are vectors (isotropic; Velenis
    & Tsiotras, 2002); ``rotated``: one scalar deflection along the current slip direction (isotropic, without memory
    of direction); ``per-axis``: one law per axis (not isotropic: its yield set is a square).

    >>> import frictionlab as fl
    >>> class Brush(fl.BristleLaw):
    ...     mu: fl.Positive
    ...     stiffness: fl.Stiffness
    ...     def sliding_friction(self, speed):
    ...         return self.mu
    ...     def rate(self, v, z):
    ...         return v - abs(v) * z * self.stiffness / self.mu
    ...     def friction(self, v, z, dz):
    ...         return self.stiffness * z
    >>> Brush(mu=0.4, stiffness=40).rate(1.0, 0.01)  # at its limit a bristle moves no further
    0.0
    """

    memory_kind: ClassVar[Literal["bristle"]] = "bristle"

    planar: Literal["vectorial", "rotated", "per-axis"] = "vectorial"

    @abstractmethod
    def rate(self, v: Any, z: Any) -> Any:
        """dz/dtau [scene velocity] at slip velocity ``v`` and deflection ``z``: ``float`` or ``complex`` alike."""

    @abstractmethod
    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Friction coefficient [-] along ``v`` that resists slip, at deflection ``z`` moving at ``dz``."""

    @property
    def form(self) -> float:
        """``planar`` as a number for kernels."""
        return {"vectorial": VECTORIAL, "rotated": ROTATED, "per-axis": PER_AXIS}[self.planar]

    def count(self) -> int:
        """One."""
        return 1

    def planar_form(self) -> Literal["vectorial", "rotated", "per-axis"]:
        """As the parameter ``planar`` says."""
        return self.planar

    def largest_deflection(self) -> float:
        """Radius of the set of deflections [scene length] that no slip history leaves once inside."""
        return math.inf

    def presliding(self) -> float:
        """The presliding length [scene length]: the deflection in steady sliding at high speed."""
        return self.largest_deflection()

    def largest_rate(self, speed: float) -> float:
        """Largest modulus of d(rate)/dz [1/scene time] at this slip speed; it limits explicit steps."""
        return math.inf

    def rate_jumps(self, directions: int) -> bool:
        """In the plane: by axis, where unloading begins or ends, at yield."""
        jumps = self.elastic_unloading() or math.isfinite(self.yield_deflection())
        return directions == 2 and (jumps or self.form == PER_AXIS)

    def rate_independent(self) -> bool:
        """Whether friction depends on the path of the slip alone, not on its speed."""
        return False

    def passive(self) -> bool:
        """Whether the work of friction over any slip history is at least minus the ``stored`` work."""
        return False

    def stored(self, z: Any) -> float:
        """The recoverable work per unit normal load [scene length] of the bristle: that of a linear spring."""
        return 0.5 * float((z * self.friction(0.0 * z, z, 0.0 * z).conjugate()).real)

    def exact_path(self) -> bool:
        """Whether ``deflected`` is exact for slip along a straight line at whatever speed."""
        return False

    def deflected(self, z: Any, path: Any) -> Any:
        """The deflection after slip along a straight ``path`` [scene length] from ``z``; for ``exact_path`` laws."""
        return z

    def saturation_path(self, z: float, side: float) -> float:
        """Length of slip in one direction (side: 1 or -1) after which friction is exactly constant.

        Infinite where the limit is only approached: ``deflected`` is then smooth along the whole path.
        """
        return math.inf

    def elastic_unloading(self) -> bool:
        """Whether z follows the slip wherever z.v <= 0: friction may have a corner where that begins or ends."""
        return False

    def yield_deflection(self) -> float:
        """Deflection [scene length] below which z follows the slip and which it never exceeds; infinite for none.

        At it and with z.v > 0, ``rate`` moves z along the circle of that radius.
        """
        return math.inf


def bristle_on_the_line(law: Any, v: float, z: float) -> Any:
    """Rate of deflection and friction coefficient of a bristle law along one direction."""
    dz = law.rate(v, z)
    return dz, law.friction(v, z, dz)


def bristle_in_the_plane(law: Any, v: complex, z: complex) -> Any:
    """Rate of deflection and friction coefficient of a bristle law in the plane, in its ``planar`` form."""
    if law.form == VECTORIAL:
        dz = law.rate(v, z)
        return dz, law.friction(v, z, dz)
    if law.form == PER_AXIS:
        dz1, dz2 = law.rate(v.real, z.real), law.rate(v.imag, z.imag)
        along = law.friction(v.real, z.real, dz1)
        return complex(dz1, dz2), complex(along, law.friction(v.imag, z.imag, dz2))
    speed = abs(v)
    rate = law.rate(speed, z.real)
    direction = v / speed if speed > 0.0 else complex(0.0, 0.0)
    return complex(rate, 0.0), law.friction(speed, z.real, rate) * direction


class MemoryLaw(FrictionLaw, ABC):
    """A law whose memory is a fixed number of numbers, all of one kind.

    memory_kind: ``deflections`` [scene length] reverse and rotate with the slip: ``float`` on the line and
    ``complex`` (x1 + i x2) in the plane, as the slip velocity. ``scalars`` have no direction: always ``float``.

    >>> import frictionlab as fl
    >>> class TwoSpringsInSeriesWithSliders(fl.MemoryLaw):
    ...     mu: fl.Positive
    ...     stiffness: fl.Stiffness
    ...     def count(self):
    ...         return 2
    ...     def sliding_friction(self, speed):
    ...         return self.mu
    ...     def rate(self, v, memory, k):
    ...         return v - abs(v) * memory[k] * (k + 1) * self.stiffness / self.mu
    ...     def friction(self, v, memory, rates):
    ...         return 0.5 * self.stiffness * (memory[0] + 2 * memory[1])
    >>> TwoSpringsInSeriesWithSliders(mu=0.4, stiffness=40).friction(1.0, (0.01, 0.005), (0.0, 0.0))
    0.4
    """

    memory_kind: ClassVar[Literal["deflections", "scalars"]] = "deflections"

    @abstractmethod
    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Rate of the k-th memory [its unit/scene time] at slip velocity ``v``.

        ``memory`` is to be indexed by 0, 1, ... and nothing more: kernels have no array, and know no length of it.
        """

    @abstractmethod
    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Friction coefficient [-] along ``v`` that resists slip, at a memory that changes at ``rates``."""

    @property
    def turning(self) -> float:
        """``memory_kind`` as a number for kernels: 1 for deflections, 0 for scalars."""
        return 1.0 if self.memory_kind == "deflections" else 0.0

    def structure(self) -> tuple[str, ...]:
        """Selects kernels by the kind of memory and by the count of the numbers."""
        stick = ("stick",) if self.remembers_stick() else ()
        return self.memory_kind, *stick, f"{self.count()} numbers"

    def count(self) -> int:
        """The number of memories."""
        return 1

    def steady(self, v: Any, k: int) -> Any:
        """The k-th memory in steady sliding at slip velocity ``v`` (not zero); zero if the law does not define it."""
        return 0.0 * v

    def presliding(self) -> float:
        """The shortest deflection in steady sliding [scene length]; 0 of scalars, or where none is known."""
        if self.memory_kind == "scalars":
            return 0.0
        return min(abs(self.steady(1.0, k)) for k in range(self.count()))

    def stored(self, memory: Any) -> float:
        """The recoverable work [scene length, per unit load] in the memory; used where a law is passive."""
        return 0.0

    def yield_deflection(self, k: int) -> float:
        """Deflection [scene length] below which the k-th moves with the slip, and which it never exceeds.

        At it and with z.v > 0, ``rate`` moves it along the circle of that radius. Infinite for none, or where
        a law does not say: it is then found from ``rate`` and ``steady``, if it is the same at slips of any speed.
        """
        return math.inf

    def elastic_unloading(self) -> bool:
        """Whether each deflection follows the slip wherever z.v <= 0; found from ``rate`` if not declared."""
        return False

    def remembers_stick(self) -> bool:
        """Whether each deflection remembers if it sticks (it follows the slip) or slips (it moves at ``rate``)."""
        return False

    def breakaway(self, v: Any, k: int) -> float:
        """Deflection [scene length] at which the k-th, sticking and loaded by slip at ``v``, begins to slip.

        Slip of a deflection ends where the slip velocity reverses, in the plane where it begins to unload it.
        """
        return math.inf

    def within(self, memory: Any) -> bool:
        """Whether the memory lies in the set that no slip history can leave."""
        return True

    def largest_rate(self, speed: float) -> float:
        """Largest modulus of d(rate)/d(memory) [1/scene time] at this slip speed; infinite where none is known."""
        return math.inf

    def rate_jumps(self, directions: int) -> bool:
        """Of deflections it may, at yield."""
        return self.memory_kind == "deflections"

    def rate_independent(self) -> bool:
        """Whether friction depends on the path of the slip alone, not on its speed."""
        return False

    def passive(self) -> bool:
        """Whether the work of friction over any slip history is at least minus the ``stored`` work."""
        return False
