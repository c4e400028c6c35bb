"""Jenkins friction: a spring in series with a Coulomb slider."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from frictionlab.laws.base import Positive
from frictionlab.laws.compliant import CompliantLaw
from frictionlab.laws.decay import exp_decay


class Jenkins(CompliantLaw):
    """Jenkins friction: a spring that deflects with slip up to the force mu, in series with a slider.

    The slider has Coulomb friction. In the plane it moves along the spring while the spring force is
    mu: its path is a tractrix.

    Parameters
    ----------
    mu : float, > 0
        Friction coefficient of the slider [-].
    stiffness : float, > 0, optional
        Stiffness: friction coefficient per deflection [1/scene length]. Exactly one is given: ``stiffness``,
        ``presliding_length`` or ``contact_stiffness``.
    presliding_length : float, > 0, optional
        Presliding length, mu/stiffness [scene length].
    contact_stiffness : float, > 0, optional
        Contact stiffness, ``stiffness`` times normal load [K_1].
    planar : {"vectorial", "per-axis"}, default "vectorial"
        Extension to the plane of the law of one direction, as in ``BristleLaw``.

    References
    ----------
    Sources: Jenkins (1962); Griffin (1980); the spring is the contact stiffness of Menq, Bielak & Griffin
    (1986).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> law = fl.Jenkins(mu=0.4, stiffness=40)
    >>> round(fl.steady_state(scene, law).mean_friction, 4), law.presliding()
    (0.0507, 0.01)
    """

    in_words: ClassVar[str] = "Jenkins"
    mu: Positive

    @property
    def reach(self) -> float:
        """Deflection at which the slider moves [scene length]."""
        return self.mu / self.bristle_stiffness

    def sliding_friction(self, speed: float) -> float:
        """Return mu, at every speed."""
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        """Return v, without its component along the spring if slip would stretch that beyond yield."""
        along = (z * v.conjugate()).real
        if along <= 0.0 or abs(z) < self.reach:
            return v
        return v - (along / (z * z.conjugate()).real) * z

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Return stiffness z."""
        return self.bristle_stiffness * z

    def constant_sliding_friction(self) -> bool:
        """Return True: the coefficient is mu at every speed."""
        return True

    def largest_deflection(self) -> float:
        """Return the yield deflection."""
        return self.reach

    def largest_rate(self, speed: float) -> float:
        """Return speed/yield deflection: in the plane, where the spring turns towards the slip."""
        return speed / self.reach

    def rate_independent(self) -> bool:
        """Return True: friction depends on the path of the slip alone."""
        return True

    def passive(self) -> bool:
        """Return True: work that the spring does not store is dissipated by the slider."""
        return True

    def exact_path(self) -> bool:
        """Return True: ``deflected`` is exact."""
        return True

    def deflected(self, z: Any, path: Any) -> Any:
        """Compute the deflection after a straight path: elastic up to yield, then along the tractrix.

        On the tractrix tan(angle/2) falls as exp(-path/yield deflection).
        """
        length = abs(path)
        if length == 0.0:
            return z
        direction = path / length
        along = (z * direction.conjugate()).real
        across = (z * z.conjugate()).real - along * along
        free = math.sqrt(max(self.reach * self.reach - across, 0.0)) - along
        if length <= free:
            return z + path
        start = z + max(free, 0.0) * direction
        turn = start * direction.conjugate() / self.reach  # exp(i angle) from the slip to the spring
        left = exp_decay((length - max(free, 0.0)) / self.reach)
        # with c = cos(angle): tan^2(angle/2) = (1 - c)/(1 + c), to be multiplied by left^2
        below, above = (1.0 - turn.real) * left * left, 1.0 + turn.real
        size = below + above
        return self.reach * (
            ((above - below) / size) * direction
            + (2.0 * left / size) * (start / self.reach - turn.real * direction)
        )

    def saturation_path(self, z: float, side: float) -> float:
        """Compute the length of slip up to yield."""
        return self.reach - side * z

    def elastic_deflection(self) -> float:
        """Return the yield deflection."""
        return self.reach

    def elastic_unloading(self) -> bool:
        """Return True: the spring follows the slip wherever z.v <= 0."""
        return True

    def yield_deflection(self) -> float:
        """Return the yield deflection."""
        return self.reach
