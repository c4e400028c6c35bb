"""Bengisu-Akay friction: a parabola up to static friction, from there an exponential fall to kinetic friction."""

from __future__ import annotations

import math
from typing import ClassVar, Self

from pydantic import model_validator

import frictionlab as fl


class BengisuAkay(fl.SlidingLaw):
    """Bengisu-Akay friction: rises along a parabola to mu_static at peak_speed, then falls to mu_kinetic.

    mu_static (1 - (s - peak_speed)^2/peak_speed^2) at slip speeds s up to peak_speed, beyond it mu_kinetic +
    (mu_static - mu_kinetic) exp(-fall (s - peak_speed)). Friction vanishes at rest, where its slope over speed is
    2 mu_static/peak_speed: a body creeps where it should stick.

    Parameters
    ----------
    mu_kinetic : float, >= 0
        Friction coefficient at high speed [-].
    mu_static : float, > 0 and >= mu_kinetic
        Largest friction coefficient, at peak_speed [-].
    peak_speed : float, > 0
        Slip speed of the largest friction [scene velocity].
    fall : float, >= 0
        Rate at which friction falls beyond peak_speed, over what is left of the fall [1/scene velocity].

    References
    ----------
    Source: Bengisu & Akay (1994).
    """

    bibtex: ClassVar[str] = """
    @article{bengisu1994, author = {Bengisu, M. T. and Akay, A.}, title = {Stability of friction-induced vibrations
      in multi-degree-of-freedom systems}, journal = {Journal of Sound and Vibration}, volume = {171}, number = {4},
      pages = {557--570}, year = {1994}}
    """
    in_words: ClassVar[str] = "Bengisu-Akay"

    mu_kinetic: fl.NonNegative
    mu_static: fl.Positive
    peak_speed: fl.Speed
    fall: fl.PerSpeed

    @model_validator(mode="after")
    def _static_not_below_kinetic(self) -> Self:
        if self.mu_static < self.mu_kinetic:
            raise ValueError(
                f"mu_static: must be at least mu_kinetic, {self.mu_kinetic:g}, got {self.mu_static:g}"
            )
        return self

    def sliding_friction(self, speed: float) -> float:
        """Compute the coefficient at slip speed s >= 0."""
        if speed < self.peak_speed:
            u = speed / self.peak_speed
            return self.mu_static * u * (2.0 - u)  # 1 - (u - 1)^2, without its cancellation near rest
        return self.mu_kinetic + (self.mu_static - self.mu_kinetic) * math.exp(
            -self.fall * (speed - self.peak_speed)
        )

    def vanishes_at_rest(self) -> bool:
        """Confirm it: friction has no jump at rest."""
        return True

    def steepest_fall(self) -> float:
        """Return the slope just beyond peak_speed."""
        return (self.mu_static - self.mu_kinetic) * self.fall

    def monotone(self) -> bool:
        """Check whether nothing falls beyond peak_speed."""
        return self.mu_static == self.mu_kinetic or self.fall == 0.0
