"""Laws with memory: one bristle deflection, several deflections, or scalars such as the age of a contact.

A law states how many numbers it remembers and the rate of each; methods keep them in an array. The same
source serves interpreted and compiled runs, on the line and in the plane.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Annotated, Any, ClassVar, Literal

from frictionlab.laws.base import FrictionLaw
from frictionlab.values.quantities import gone

VECTORIAL, PER_AXIS = 0.0, 1.0
NOT_ROTATED = "rotated bristles, which remember no direction, are gone: use vectorial or per-axis"


class BristleLaw(FrictionLaw, ABC):
    """Law whose memory is one bristle deflection z [scene length]: slip changes z and friction depends on it.

    A subclass writes ``sliding_friction``, ``rate`` and ``friction``.

    Parameters
    ----------
    planar : {"vectorial", "per-axis"}, default "vectorial"
        Extension to the plane of the law of one direction. ``vectorial``: v and z are vectors (isotropic;
        Velenis & Tsiotras, 2002). ``per-axis``: one law per axis (not isotropic: its yield set is a square).

    Examples
    --------
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

    planar: Annotated[Literal["vectorial", "per-axis"], gone("rotated", NOT_ROTATED)] = "vectorial"

    @abstractmethod
    def rate(self, v: Any, z: Any) -> Any:
        """Compute the rate of the bristle deflection, dz/dtau.

        Parameters
        ----------
        v : float or complex
            Slip velocity [scene velocity]; ``float`` on the line, ``complex`` in the plane.
        z : float or complex
            Bristle deflection [scene length]; of the type of ``v``.

        Returns
        -------
        float or complex
            Rate [scene velocity].
        """

    @abstractmethod
    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Compute the friction coefficient along ``v`` that resists slip.

        Parameters
        ----------
        v : float or complex
            Slip velocity [scene velocity].
        z : float or complex
            Bristle deflection [scene length].
        dz : float or complex
            Rate of ``z`` [scene velocity].

        Returns
        -------
        float or complex
            Friction coefficient [-].
        """

    @property
    def form(self) -> float:
        """Number that stands for ``planar`` in kernels."""
        return VECTORIAL if self.planar == "vectorial" else PER_AXIS

    def count(self) -> int:
        """Return the number of memories, 1.

        Returns
        -------
        int
            Count.
        """
        return 1

    def planar_form(self) -> Literal["vectorial", "per-axis"]:
        """Return how the law of one direction extends to the plane: the parameter ``planar``.

        Returns
        -------
        {"vectorial", "per-axis"}
            Form.
        """
        return self.planar

    def largest_deflection(self) -> float:
        """Return the radius of the set of deflections that no slip history leaves once inside.

        Returns
        -------
        float
            Radius [scene length]; infinite if not declared.
        """
        return math.inf

    def presliding(self) -> float:
        """Return the presliding length: the deflection in steady sliding at high speed.

        Returns
        -------
        float
            Length [scene length]; ``largest_deflection()`` if not declared.
        """
        return self.largest_deflection()

    def largest_rate(self, speed: float) -> float:
        """Return the largest modulus of d(rate)/dz; it limits explicit steps.

        Parameters
        ----------
        speed : float, >= 0
            Slip speed [scene velocity].

        Returns
        -------
        float
            Modulus [1/scene time]; infinite if not declared.
        """
        return math.inf

    def rate_jumps(self, directions: int) -> bool:
        """Check whether the rate of deflection may jump while slip does not reverse.

        It may in the plane: at yield, where elastic unloading begins or ends, and in the form per axis.

        Parameters
        ----------
        directions : int
            1 on the line, 2 in the plane.

        Returns
        -------
        bool
            True if it may jump.
        """
        jumps = self.elastic_unloading() or math.isfinite(self.yield_deflection())
        return directions == 2 and (jumps or self.form == PER_AXIS)

    def rate_independent(self) -> bool:
        """Check whether friction depends on the path of the slip alone, not on its speed.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def passive(self) -> bool:
        """Check whether the work of friction over any slip history is at least minus the ``stored`` work.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def stored(self, z: Any) -> float:
        """Compute the recoverable work of the bristle: that of a linear spring.

        Parameters
        ----------
        z : float or complex
            Bristle deflection [scene length].

        Returns
        -------
        float
            Work per unit normal load [scene length].
        """
        return 0.5 * float((z * self.friction(0.0 * z, z, 0.0 * z).conjugate()).real)

    def exact_path(self) -> bool:
        """Check whether ``deflected`` is exact for slip along a straight line at whatever speed.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def deflected(self, z: Any, path: Any) -> Any:
        """Compute the deflection after slip along a straight path; called only if ``exact_path`` holds.

        Parameters
        ----------
        z : float or complex
            Deflection before [scene length].
        path : float or complex
            Slip [scene length].

        Returns
        -------
        float or complex
            Deflection after the slip [scene length].
        """
        return z

    def saturation_path(self, z: float, side: float) -> float:
        """Compute the length of slip in one direction after which friction is exactly constant.

        Parameters
        ----------
        z : float
            Deflection before [scene length].
        side : float
            Direction of slip, 1 or -1.

        Returns
        -------
        float
            Length [scene length]. Infinite if the limit is only approached: ``deflected`` is then smooth
            along the whole path.
        """
        return math.inf

    def elastic_unloading(self) -> bool:
        """Check whether z follows the slip wherever z.v <= 0.

        Friction may have a corner where that begins or ends.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def yield_deflection(self) -> float:
        """Return the deflection below which z follows the slip and which z never exceeds.

        At this deflection and with z.v > 0, ``rate`` moves z along the circle of that radius.

        Returns
        -------
        float
            Deflection [scene length]; infinite if there is none.
        """
        return math.inf


def bristle_on_the_line(law: Any, v: float, z: float) -> Any:
    """Compute rate of deflection and friction coefficient of a bristle law along one direction."""
    dz = law.rate(v, z)
    return dz, law.friction(v, z, dz)


def bristle_in_the_plane(law: Any, v: complex, z: complex) -> Any:
    """Compute rate of deflection and friction coefficient of a bristle law in the plane, by its form."""
    if law.form == VECTORIAL:
        dz = law.rate(v, z)
        return dz, law.friction(v, z, dz)
    dz1, dz2 = law.rate(v.real, z.real), law.rate(v.imag, z.imag)
    along = law.friction(v.real, z.real, dz1)
    return complex(dz1, dz2), complex(along, law.friction(v.imag, z.imag, dz2))


class MemoryLaw(FrictionLaw, ABC):
    """Law whose memory is a fixed number of numbers, all of one kind.

    A subclass writes ``count``, ``sliding_friction``, ``rate`` and ``friction``.

    Attributes
    ----------
    memory_kind : {"deflections", "scalars"}
        Kind of the numbers. ``deflections`` [scene length] reverse and rotate with the slip: ``float`` on the
        line and ``complex`` (x1 + i x2) in the plane, as the slip velocity. ``scalars`` have no direction and
        are always ``float``. ``deflections`` if left out.

    Examples
    --------
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
        """Compute the rate of the k-th memory.

        Parameters
        ----------
        v : float or complex
            Slip velocity [scene velocity].
        memory : sequence of float or complex
            Memory, only to be indexed by 0, 1, ...: kernels have no array and do not know its length.
        k : int
            Index of the memory, from 0.

        Returns
        -------
        float or complex
            Rate [its unit/scene time].
        """

    @abstractmethod
    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Compute the friction coefficient along ``v`` that resists slip.

        Parameters
        ----------
        v : float or complex
            Slip velocity [scene velocity].
        memory : sequence of float or complex
            Memory, only to be indexed by 0, 1, ...
        rates : sequence of float or complex
            Rates of the memory, only to be indexed by 0, 1, ...

        Returns
        -------
        float or complex
            Friction coefficient [-].
        """

    @property
    def turning(self) -> float:
        """Number that stands for ``memory_kind`` in kernels: 1 for deflections, 0 for scalars."""
        return 1.0 if self.memory_kind == "deflections" else 0.0

    def structure(self) -> tuple[str, ...]:
        """Return the kind of memory and the count of its numbers, which select the kernels.

        Returns
        -------
        tuple of str
            Properties as words; ``stick`` among them if the law remembers stick.
        """
        stick = ("stick",) if self.remembers_stick() else ()
        return self.memory_kind, *stick, f"{self.count()} numbers"

    def count(self) -> int:
        """Return the number of memories.

        Returns
        -------
        int
            Count of the numbers that the law remembers; 1 if not declared.
        """
        return 1

    def steady(self, v: Any, k: int) -> Any:
        """Compute the k-th memory in steady sliding.

        Parameters
        ----------
        v : float or complex, not zero
            Slip velocity [scene velocity].
        k : int
            Index of the memory, from 0.

        Returns
        -------
        float or complex
            Memory [its unit]; zero if the law does not define it.
        """
        return 0.0  # and not 0*v: scalars are real in the plane, too

    def presliding(self) -> float:
        """Return the shortest deflection in steady sliding.

        Returns
        -------
        float
            Deflection [scene length]; 0 for scalars, or if the law does not define ``steady``.
        """
        if self.memory_kind == "scalars":
            return 0.0
        return min(abs(self.steady(1.0, k)) for k in range(self.count()))

    def stored(self, memory: Any) -> float:
        """Compute the recoverable work in the memory; used for a law that is passive.

        Parameters
        ----------
        memory : sequence of float or complex
            Memory.

        Returns
        -------
        float
            Work per unit normal load [scene length]; 0 if not declared.
        """
        return 0.0

    def yield_deflection(self, k: int) -> float:
        """Return the deflection below which the k-th memory moves with the slip, and which it never exceeds.

        At this deflection and with z.v > 0, ``rate`` moves the memory along the circle of that radius.

        Parameters
        ----------
        k : int
            Index of the memory, from 0.

        Returns
        -------
        float
            Deflection [scene length]. Infinite if there is none, or if the law does not declare it: it is
            then found from ``rate`` and ``steady``, if it is the same at slips of any speed.
        """
        return math.inf

    def elastic_unloading(self) -> bool:
        """Check whether each deflection follows the slip wherever z.v <= 0.

        Returns
        -------
        bool
            False if not declared; it is then found from ``rate``.
        """
        return False

    def remembers_stick(self) -> bool:
        """Check whether each deflection remembers if it sticks or slips.

        A deflection that sticks follows the slip; one that slips moves at ``rate``.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def breakaway(self, v: Any, k: int) -> float:
        """Compute the deflection at which the k-th memory, sticking and loaded by slip, begins to slip.

        Slip of a deflection ends when the slip velocity reverses; in the plane it ends when the slip velocity
        begins to unload the deflection.

        Parameters
        ----------
        v : float or complex
            Slip velocity [scene velocity] that loads the deflection.
        k : int
            Index of the memory, from 0.

        Returns
        -------
        float
            Deflection [scene length]; infinite if not declared.
        """
        return math.inf

    def within(self, memory: Any) -> bool:
        """Check whether the memory lies in the set that no slip history can leave.

        Parameters
        ----------
        memory : sequence of float or complex
            Memory.

        Returns
        -------
        bool
            True if not declared.
        """
        return True

    def largest_rate(self, speed: float) -> float:
        """Return the largest modulus of d(rate)/d(memory); it limits explicit steps.

        Parameters
        ----------
        speed : float, >= 0
            Slip speed [scene velocity].

        Returns
        -------
        float
            Modulus [1/scene time]; infinite if not declared.
        """
        return math.inf

    def rate_jumps(self, directions: int) -> bool:
        """Check whether the rate of a memory may jump while slip does not reverse.

        That of deflections may, at yield.

        Parameters
        ----------
        directions : int
            1 on the line, 2 in the plane.

        Returns
        -------
        bool
            True for deflections.
        """
        return self.memory_kind == "deflections"

    def rate_independent(self) -> bool:
        """Check whether friction depends on the path of the slip alone, not on its speed.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def passive(self) -> bool:
        """Check whether the work of friction over any slip history is at least minus the ``stored`` work.

        Returns
        -------
        bool
            False if not declared.
        """
        return False
