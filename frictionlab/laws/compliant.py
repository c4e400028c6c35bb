"""Parameters of laws with a compliant contact: stiffness in three ways, damping in two."""

from __future__ import annotations

from abc import ABC
from collections.abc import Iterator
from typing import Annotated, ClassVar, Self

from pydantic import model_validator

from frictionlab.laws.base import Dimension, NonNegative, Positive
from frictionlab.laws.memory import BristleLaw
from frictionlab.values.quantities import document

Stiffness = Annotated[Positive, Dimension(length=-1)]
document(
    Stiffness,
    """Bristle stiffness > 0 per unit normal load [1/m in a scene given in SI units, else 1/L], as parameter of a law.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Spring(fl.SlidingLaw):
    ...     mu: fl.Positive
    ...     stiffness: fl.Stiffness
    ...     def sliding_friction(self, speed):
    ...         return self.mu
    >>> Spring(mu=0.4, stiffness=40)
    Spring(mu=0.4, stiffness=40)
    """,
)
Length = Annotated[Positive, Dimension(length=1)]
document(
    Length,
    """Length > 0 [m in a scene given in SI units, else L], as the parameter of a law.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Asperities(fl.SlidingLaw):
    ...     mu: fl.Positive
    ...     width: fl.Length
    ...     def sliding_friction(self, speed):
    ...         return self.mu
    >>> Asperities(mu=0.4, width=0.01)
    Asperities(mu=0.4, width=0.01)
    """,
)
ContactStiffness = Annotated[Positive, Dimension(force=1, length=-1)]
"""Contact stiffness > 0 [N/m in SI, else K_1]."""
Damping = Annotated[NonNegative, Dimension(length=-1, time=1)]
"""Bristle damping >= 0 per unit normal load [s/m in SI, else 1/scene velocity]."""
ContactDamping = Annotated[NonNegative, Dimension(force=1, length=-1, time=1)]
"""Contact damping >= 0 [N s/m in SI, else M omega_1]."""


class CompliantLaw(BristleLaw, ABC):
    """Bristle law with a stiffness: per unit normal load, by its presliding length or of the contact.

    A subclass writes ``sliding_friction``, ``rate`` and ``friction``.

    Parameters
    ----------
    stiffness : float, > 0, optional
        Stiffness: friction coefficient per deflection [1/scene length]. Exactly one is given: ``stiffness``,
        ``presliding_length`` or ``contact_stiffness``.
    presliding_length : float, > 0, optional
        Presliding length, friction coefficient in slow sliding over stiffness [scene length].
    contact_stiffness : float, > 0, optional
        Contact stiffness, ``stiffness`` times normal load [K_1].
    planar : {"vectorial", "per-axis"}, default "vectorial"
        Extension to the plane of the law of one direction, as in ``BristleLaw``.

    Examples
    --------
    >>> import frictionlab as fl
    >>> fl.Dahl(mu=0.4, presliding_length=0.01).bristle_stiffness
    40.0
    >>> fl.Dahl(mu=0.4, contact_stiffness=400).under_load(10).stiffness
    40.0
    """

    compliant: ClassVar[bool] = True

    stiffness: Stiffness | None = None
    presliding_length: Length | None = None
    contact_stiffness: ContactStiffness | None = None

    @model_validator(mode="after")
    def _values_go_together(self) -> Self:
        if problems := list(self._problems()):
            raise ValueError("; ".join(problems))
        return self

    def _problems(self) -> Iterator[str]:
        """Yield which values do not go together, each as ``name: what``."""
        names = "stiffness", "presliding_length", "contact_stiffness"
        given = [name for name in names if getattr(self, name) is not None]
        if not given:
            yield "stiffness: required, or presliding_length or contact_stiffness instead"
        yield from (f"{name}: leave it out where {given[0]} is given" for name in given[1:])

    def saturated_friction(self) -> float:
        """Return the friction coefficient that defines the presliding length: that at vanishing slip speed.

        Returns
        -------
        float
            Friction coefficient [-].
        """
        return self.sliding_friction(0.0)

    @property
    def bristle_stiffness(self) -> float:
        """Friction coefficient per deflection [1/scene length], from whichever parameter is given."""
        if self.stiffness is not None:
            return self.stiffness
        if self.presliding_length is not None:
            return self.saturated_friction() / self.presliding_length
        raise ValueError(
            "contact_stiffness: the stiffness per unit load needs the normal load; call under_load(normal_load)"
        )

    def presliding(self) -> float:
        """Return the presliding length: friction coefficient in slow sliding over stiffness.

        Returns
        -------
        float
            Length [scene length].
        """
        return self.saturated_friction() / self.bristle_stiffness

    def under_load(self, normal_load: float) -> Self:
        """Return the same law per unit of a normal load: contact parameters are divided by the load.

        Parameters
        ----------
        normal_load : float, > 0
            Normal load [scene force].

        Returns
        -------
        CompliantLaw
            Law of the same class; the law itself if it has no contact parameter.
        """
        if self.contact_stiffness is None:
            return self
        stiffness = self.contact_stiffness / normal_load
        return self.model_copy(update={"stiffness": stiffness, "contact_stiffness": None})


class DampedLaw(CompliantLaw, ABC):
    """Compliant law whose bristles are damped as well.

    A subclass writes ``sliding_friction``, ``rate`` and ``friction``.

    Parameters
    ----------
    damping : float, >= 0, optional
        Damping: friction coefficient per rate of deflection [1/scene velocity]; 0 if neither it nor
        ``contact_damping`` is given.
    contact_damping : float, >= 0, optional
        Contact damping, ``damping`` times normal load [M omega_1]; given instead of ``damping``.
    stiffness : float, > 0, optional
        Stiffness: friction coefficient per deflection [1/scene length]. Exactly one is given: ``stiffness``,
        ``presliding_length`` or ``contact_stiffness``.
    presliding_length : float, > 0, optional
        Presliding length, friction coefficient in slow sliding over stiffness [scene length].
    contact_stiffness : float, > 0, optional
        Contact stiffness, ``stiffness`` times normal load [K_1].
    planar : {"vectorial", "per-axis"}, default "vectorial"
        Extension to the plane of the law of one direction, as in ``BristleLaw``.

    Examples
    --------
    >>> import frictionlab as fl
    >>> fl.LuGre(mu_kinetic=0.4, stiffness=40, contact_damping=5).under_load(10).bristle_damping
    0.5
    """

    damping: Damping | None = None
    contact_damping: ContactDamping | None = None

    def _problems(self) -> Iterator[str]:
        yield from super()._problems()
        if self.damping is not None and self.contact_damping is not None:
            yield "contact_damping: leave it out where damping is given"

    @property
    def bristle_damping(self) -> float:
        """Friction coefficient per rate of deflection [1/scene velocity], from either parameter."""
        if self.contact_damping is not None:
            raise ValueError(
                "contact_damping: the damping per unit load needs the normal load; call under_load(normal_load)"
            )
        return self.damping or 0.0

    def under_load(self, normal_load: float) -> Self:
        """Return the same law per unit of a normal load: contact parameters are divided by the load.

        Parameters
        ----------
        normal_load : float, > 0
            Normal load [scene force].

        Returns
        -------
        DampedLaw
            Law of the same class; the law itself if it has no contact parameter.
        """
        law = super().under_load(normal_load)
        if law.contact_damping is None:
            return law
        return law.model_copy(update={"damping": law.contact_damping / normal_load, "contact_damping": None})
