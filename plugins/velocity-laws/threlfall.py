"""Threlfall friction: an exponential rise from rest to constant friction."""

from __future__ import annotations

import math
from typing import ClassVar

import frictionlab as fl


class Threlfall(fl.SlidingLaw):
    """Threlfall friction: rises from zero at rest to 0.95 mu at rise_speed, and is constant beyond.

    mu (1 - exp(-3 s/rise_speed)) at slip speed s up to rise_speed, mu (1 - exp(-3)) = 0.9502 mu beyond. Friction
    vanishes at rest, where its slope over speed is 3 mu/rise_speed: a body creeps where it should stick.

    Parameters
    ----------
    mu : float, > 0
        Friction coefficient of which quick slip feels 1 - exp(-3) [-].
    rise_speed : float, > 0
        Slip speed from which friction is constant [scene velocity].

    References
    ----------
    Source: Threlfall (1978), there with the constant rounded to 0.95 mu, which leaves a jump.
    """

    bibtex: ClassVar[str] = """
    @article{threlfall1978, author = {Threlfall, D. C.}, title = {The inclusion of {Coulomb} friction in mechanisms
      programs with particular reference to {DRAM} au programme {DRAM}}, journal = {Mechanism and Machine Theory},
      volume = {13}, number = {4}, pages = {475--483}, year = {1978}}
    """
    in_words: ClassVar[str] = "Threlfall"

    mu: fl.Positive
    rise_speed: fl.Speed

    def sliding_friction(self, speed: float) -> float:
        """Compute the coefficient at slip speed s >= 0."""
        return self.mu * (1.0 - math.exp(-3.0 * min(speed / self.rise_speed, 1.0)))

    def vanishes_at_rest(self) -> bool:
        """Confirm it: friction has no jump at rest."""
        return True

    def monotone(self) -> bool:
        """Confirm it: friction never falls."""
        return True
