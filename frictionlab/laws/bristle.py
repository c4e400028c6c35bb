"""Laws of a contact that deflects: one bristle deflection is their memory.

The state equation is written for one direction and, where it can be, for the plane, in the same lines: slip
velocity v and deflection z are both ``float`` on the line and both ``complex`` (x1 + i x2) in the plane.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Annotated, Any, Literal, Self

from pydantic import model_validator

from frictionlab.laws.base import Dimension, FrictionLaw, NonNegative, Positive

VECTORIAL, ROTATED, PER_AXIS = 0.0, 1.0, 2.0

Stiffness = Annotated[Positive, Dimension(length=-1)]
"""A bristle stiffness > 0 per unit normal load [1/m in SI, else 1/scene length]."""
Length = Annotated[Positive, Dimension(length=1)]
"""A length > 0 [m in SI, else scene length]."""
ContactStiffness = Annotated[Positive, Dimension(force=1, length=-1)]
"""A stiffness > 0 of the contact [N/m in SI, else K_1]."""
Damping = Annotated[NonNegative, Dimension(length=-1, time=1)]
"""A bristle damping >= 0 per unit normal load [s/m in SI, else 1/scene velocity]."""
ContactDamping = Annotated[NonNegative, Dimension(force=1, length=-1, time=1)]
"""A damping >= 0 of the contact [N s/m in SI, else M omega_1]."""


class BristleLaw(FrictionLaw, ABC):
    """A law whose memory is a bristle deflection z [scene length], moved by slip and felt as friction.

    planar: how the law of one direction is carried into the plane. ``vectorial``: |v| and z become the vectors'
    (isotropic; Velenis & Tsiotras, 2002); ``rotated``: one deflection along the slip direction, whatever it was
    (isotropic, without memory of direction); ``per-axis``: each axis for itself (not isotropic: its yield set is a
    square).
    """

    planar: Literal["vectorial", "rotated", "per-axis"] = "vectorial"

    @abstractmethod
    def rate(self, v: Any, z: Any) -> Any:
        """dz/dtau [scene velocity] at slip velocity ``v`` and deflection ``z``: ``float`` or ``complex`` alike."""

    @abstractmethod
    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Friction coefficient [-] along ``v`` that resists slip, at deflection ``z`` moving at ``dz``."""

    @property
    def form(self) -> float:
        """``planar`` as kernels know it."""
        return {"vectorial": VECTORIAL, "rotated": ROTATED, "per-axis": PER_AXIS}[self.planar]

    def structure(self) -> tuple[str, ...]:
        """Whether the path is exact."""
        return ("exact path",) if self.exact_path() else ()

    def no_vector_form(self) -> str:
        """Why ``planar: vectorial`` has no meaning for this law, as a sentence; empty where it has one."""
        return ""

    def largest_deflection(self) -> float:
        """Radius of the set of deflections [scene length] that no slip history leaves once inside."""
        return math.inf

    def presliding(self) -> float:
        """The presliding length [scene length]: deflection that steady sliding in quick slip tends to."""
        return self.largest_deflection()

    def elastic_deflection(self) -> float:
        """Deflection [scene length] up to which z moves with the slip whatever its direction: nothing drifts."""
        return 0.0

    def largest_rate(self, speed: float) -> float:
        """Largest modulus of d(rate)/dz [1/scene time] at this slip speed: what explicit steps are limited by."""
        return math.inf

    def rate_independent(self) -> bool:
        """Whether friction depends on the path of the slip alone, not on how fast it is travelled."""
        return False

    def passive(self) -> bool:
        """Whether the work of friction from any slip history is at least minus what the bristle has stored."""
        return False

    def stored(self, z: Any) -> float:
        """The work per unit normal load [scene length] that the bristle can give back: that of a linear spring."""
        return 0.5 * float((z * self.friction(0.0 * z, z, 0.0 * z).conjugate()).real)

    def damps_across(self, speed: float) -> bool:
        """Whether friction never feeds a motion across the slip, at slip speeds up to this.

        Spring and bristle across then only lose energy, and with no load across the belt x2 dies out.
        """
        return self.planar != "rotated"

    def exact_path(self) -> bool:
        """Whether ``deflected`` is exact for slip along a straight line at whatever speed."""
        return False

    def deflected(self, z: Any, path: Any) -> Any:
        """The deflection after slip along a straight ``path`` [scene length] from ``z``; for ``exact_path`` laws."""
        return z

    def saturation_path(self, z: float, side: float) -> float:
        """Length of one-directional slip (side: 1 or -1) after which friction stays what it is, exactly.

        Infinite where that is only approached: there ``deflected`` is smooth along the whole path.
        """
        return math.inf

    def elastic_unloading(self) -> bool:
        """Whether z moves with the slip wherever z.v <= 0: friction may have a corner where that begins or ends."""
        return False

    def yield_deflection(self) -> float:
        """Deflection [scene length] below which z moves with the slip, and which it never exceeds; infinite for none.

        At it and with z.v > 0, ``rate`` moves z along the circle of that radius.
        """
        return math.inf


def on_the_line(law: Any, v: float, z: float) -> Any:
    """Rate of deflection and friction coefficient of a bristle law along one direction."""
    dz = law.rate(v, z)
    return dz, law.friction(v, z, dz)


def in_the_plane(law: Any, v: complex, z: complex) -> Any:
    """Rate of deflection and friction coefficient of a bristle law in the plane, in the form it names."""
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


class CompliantLaw(BristleLaw, ABC):
    """A bristle law of a known stiffness, given per unit normal load, by its presliding length or as the contact's.

    stiffness [1/scene length], > 0: friction coefficient per deflection, or instead
    presliding_length [scene length], > 0: friction coefficient in slow sliding over stiffness, or instead
    contact_stiffness [K_1], > 0: stiffness times normal load.
    """

    stiffness: Stiffness | None = None
    presliding_length: Length | None = None
    contact_stiffness: ContactStiffness | None = None

    @model_validator(mode="after")
    def _one_stiffness(self) -> Self:
        names = "stiffness", "presliding_length", "contact_stiffness"
        given = [name for name in names if getattr(self, name) is not None]
        if not given:
            raise ValueError("stiffness: required, or presliding_length or contact_stiffness instead")
        if len(given) > 1:
            raise ValueError(
                "; ".join(f"{name}: leave it out where {given[0]} is given" for name in given[1:])
            )
        return self

    def saturated_friction(self) -> float:
        """The friction coefficient [-] that the presliding length is told by: that of vanishing slip speed."""
        return self.sliding_friction(0.0)

    @property
    def bristle_stiffness(self) -> float:
        """Friction coefficient per deflection [1/scene length], however it was given."""
        if self.stiffness is not None:
            return self.stiffness
        if self.presliding_length is not None:
            return self.saturated_friction() / self.presliding_length
        raise ValueError(
            "contact_stiffness: is per normal load only under a load; call under_load(normal_load)"
        )

    def presliding(self) -> float:
        """Friction coefficient in slow sliding over stiffness."""
        return self.saturated_friction() / self.bristle_stiffness

    def under_load(self, normal_load: float) -> Self:
        """The same law per unit of this normal load [scene force], without what is given as the contact's."""
        if self.contact_stiffness is None:
            return self
        stiffness = self.contact_stiffness / normal_load
        return self.model_copy(update={"stiffness": stiffness, "contact_stiffness": None})


class DampedLaw(CompliantLaw, ABC):
    """A compliant law whose bristles are damped as well.

    damping [1/scene velocity], >= 0: friction coefficient per rate of deflection, 0 where left out; or instead
    contact_damping [M omega_1], >= 0: damping times normal load.
    """

    damping: Damping | None = None
    contact_damping: ContactDamping | None = None

    @model_validator(mode="after")
    def _one_damping(self) -> Self:
        if self.damping is not None and self.contact_damping is not None:
            raise ValueError("contact_damping: leave it out where damping is given")
        return self

    @property
    def bristle_damping(self) -> float:
        """Friction coefficient per rate of deflection [1/scene velocity], however it was given."""
        if self.contact_damping is not None:
            raise ValueError(
                "contact_damping: is per normal load only under a load; call under_load(normal_load)"
            )
        return self.damping or 0.0

    def under_load(self, normal_load: float) -> Self:
        """The same law per unit of this normal load [scene force], without what is given as the contact's."""
        law = super().under_load(normal_load)
        if law.contact_damping is None:
            return law
        return law.model_copy(update={"damping": law.contact_damping / normal_load, "contact_damping": None})
