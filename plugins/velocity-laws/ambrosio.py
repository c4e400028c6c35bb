"""Ambrosio friction: none up to one slip speed, Coulomb friction from another, a straight line between."""

from __future__ import annotations

from typing import Annotated, ClassVar, Self

from pydantic import model_validator

import frictionlab as fl


class Ambrosio(fl.SlidingLaw):
    """Ambrosio friction: none up to free_speed, rises along a line, and is mu from full_speed on.

    mu (s - free_speed)/(full_speed - free_speed) at slip speeds s between the two. A body at rest on the belt is
    free: it follows its spring up to free_speed without friction.

    Parameters
    ----------
    mu : float, > 0
        Friction coefficient from full_speed on [-].
    free_speed : float, >= 0
        Slip speed up to which there is no friction, v_0 [scene velocity].
    full_speed : float, > free_speed
        Slip speed from which friction is constant, v_1 [scene velocity].

    References
    ----------
    Source: Ambrósio (2003).
    """

    bibtex: ClassVar[str] = """
    @incollection{ambrosio2003, author = {Ambrósio, J. A. C.}, title = {Impact of rigid and flexible multibody
      systems: deformation description and contact models}, booktitle = {Virtual Nonlinear Multibody Systems}, editor
      = {Schiehlen, W. and Valášek, M.}, series = {NATO Science Series}, volume = {103}, publisher = {Springer},
      pages = {57--81}, year = {2003}}
    """
    in_words: ClassVar[str] = "Ambrósio"

    mu: fl.Positive
    free_speed: Annotated[fl.NonNegative, fl.Dimension(length=1, time=-1)]
    full_speed: fl.Speed

    @model_validator(mode="after")
    def _rises_between_two_speeds(self) -> Self:
        if self.full_speed <= self.free_speed:
            raise ValueError(
                f"full_speed: must be above free_speed, {self.free_speed:g}, got {self.full_speed:g}"
            )
        return self

    def sliding_friction(self, speed: float) -> float:
        """Compute the coefficient at slip speed s >= 0."""
        if speed <= self.free_speed:
            return 0.0
        if speed >= self.full_speed:
            return self.mu
        return self.mu * (speed - self.free_speed) / (self.full_speed - self.free_speed)

    def vanishes_at_rest(self) -> bool:
        """Confirm it: friction vanishes up to free_speed."""
        return True

    def monotone(self) -> bool:
        """Confirm it: friction never falls."""
        return True
