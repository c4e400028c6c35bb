"""Bouc-Wen hysteresis as a law of friction."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field

from frictionlab import CompliantLaw, Finite, Positive

Exponent = Annotated[Finite, Field(ge=1, le=20)]


class BoucWen(CompliantLaw):
    """Bouc-Wen friction: a spring that yields the more abruptly the larger its exponent, and saturates at mu.

    z' = v - (beta |z.v| + gamma z.v) |z|^(n-2) z, friction = stiffness z; at the limit z_max = mu/stiffness friction
    is mu, so that beta + gamma = z_max^-n: their share is what is left to choose (sigma of Ikhouane & Rodellar).

    mu [-], > 0: friction coefficient in steady sliding, its limit.
    stiffness [1/scene length], presliding_length [scene length] (mu/stiffness) or contact_stiffness [K_1], > 0.
    exponent [-], >= 1, <= 20: n; 1 where left out, a large one nearly an ideal spring that slips (``jenkins``).
    beta_share [-], > 0: beta/(beta + gamma), 0.5 where left out (beta = gamma: unloading is elastic); below 0.5 the
    spring gives back more than it stores. Exponent 1 and share 1 (gamma = 0) are ``dahl`` along a line.

    In the plane |z.v| stands for |z v|: the law turns with the slip, as Park, Wen & Ang's with its |v1 z1| + |v2 z2|
    does not, and large n is a slider dragged as by a rope.
    Sources: Bouc (1967); Wen (1976); normalised: Ikhouane & Rodellar (2005); passivity: Erlicher & Point (2004); in
    the plane: Park, Wen & Ang (1986).
    """

    bibtex: ClassVar[str] = """
    @inproceedings{bouc1967, author = {Bouc, R.}, title = {Forced vibration of mechanical systems with hysteresis},
      booktitle = {Proceedings of the 4th Conference on Nonlinear Oscillation}, address = {Prague}, year = {1967}}
    @article{wen1976, author = {Wen, Y.-K.}, title = {Method for random vibration of hysteretic systems}, journal =
      {Journal of the Engineering Mechanics Division, ASCE}, volume = {102}, pages = {249--263}, year = {1976}}
    @article{ikhouane2005, author = {Ikhouane, F. and Rodellar, J.}, title = {On the hysteretic {Bouc-Wen} model, part
      {I}: forced limit cycle characterization}, journal = {Nonlinear Dynamics}, volume = {42}, pages = {63--78},
      year = {2005}}
    @article{erlicher2004, author = {Erlicher, S. and Point, N.}, title = {Thermodynamic admissibility of {Bouc-Wen}
      type hysteresis models}, journal = {Comptes Rendus Mécanique}, volume = {332}, pages = {51--57}, year = {2004}}
    @article{park1986, author = {Park, Y. J. and Wen, Y. K. and Ang, A. H.-S.}, title = {Random vibration of
      hysteretic systems under bi-directional ground motions}, journal = {Earthquake Engineering and Structural
      Dynamics}, volume = {14}, pages = {543--557}, year = {1986}}
    """
    in_words: ClassVar[str] = "Bouc-Wen"

    mu: Positive
    exponent: Exponent = 1.0
    beta_share: Positive = 0.5

    @property
    def limit(self) -> float:
        """Return the deflection in steady sliding [scene length]."""
        return self.mu / self.bristle_stiffness

    def sliding_friction(self, speed: float) -> float:
        """mu, at every speed."""
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        """Return the slip, less what yields."""
        size = abs(z)
        if size == 0.0:
            return v
        along = (z * v.conjugate()).real / size
        share = 1.0 if along > 0.0 else 1.0 - 2.0 * self.beta_share  # of beta |along| + gamma along
        return v - share * along * (size / self.limit) ** (self.exponent - 1.0) / self.limit * z

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Return the spring's."""
        return self.bristle_stiffness * z

    def constant_sliding_friction(self) -> bool:
        """Always."""
        return True

    def largest_deflection(self) -> float:
        """Return where the spring force is mu."""
        return self.limit

    def largest_rate(self, speed: float) -> float:
        """exponent*speed/z_max at the limit, more where unloading is stiffer than 2*stiffness."""
        return self.exponent * speed / self.limit * max(1.0, 2.0 * self.beta_share - 1.0)

    def elastic_unloading(self) -> bool:
        """Return where beta = gamma."""
        return self.beta_share == 0.5

    def rate_independent(self) -> bool:
        """Always."""
        return True

    def passive(self) -> bool:
        """Return where beta >= |gamma|: what the spring, stiffness z^2/2, does not store is lost."""
        return self.beta_share >= 0.5

    def damps_across(self, speed: float) -> bool:
        """Return where it is passive: |z2|^2 then only falls by yielding."""
        return self.passive()
