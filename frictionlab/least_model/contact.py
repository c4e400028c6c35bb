"""Parts of the contact that may go: bristles and their damping, the fall of friction with speed, viscosity."""

from __future__ import annotations

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.laws.stribeck_bristle import StribeckBristle
from frictionlab.least_model.lesser import CannotGo, LesserModel

NO_SUCH_LAW = "no law without memory is known with the steady friction of this law"
NO_FRICTION = "without its fall this law has no friction: mu_kinetic is 0"


def rigid(model: LesserModel) -> LesserModel | None:
    """Without the compliance of the contact: the law without memory of the same friction at steady sliding."""
    law = model.law
    if law.memory_kind == "none":
        return None
    return model.with_law(_steady(law))


def _steady(law: FrictionLaw) -> FrictionLaw:
    if law.constant_sliding_friction():
        return Coulomb(mu=law.sliding_friction(0.0))
    if not isinstance(law, StribeckBristle):
        raise CannotGo(NO_SUCH_LAW)
    return Stribeck(
        mu_kinetic=law.mu_kinetic,
        mu_static=law.peak,
        stribeck_speed=law.stribeck_speed,
        stribeck_exponent=law.stribeck_exponent,
        viscosity=law.viscosity,
    )


def undamped_bristles(model: LesserModel) -> LesserModel | None:
    """Without the damping of the bristles."""
    damping = getattr(model.law, "damping", None)
    if not damping:
        return None
    return model.with_law(model.law.model_copy(update={"damping": None}))


def without_fall(model: LesserModel) -> LesserModel | None:
    """Friction at rest and in slow sliding no larger than in quick sliding (mu_kinetic, of Coulomb friction mu)."""
    law = model.law
    kinetic = law.mu if isinstance(law, Coulomb) else getattr(law, "mu_kinetic", None)
    static = getattr(law, "mu_static", None)
    if kinetic is None or static in (None, kinetic):
        return None
    if kinetic == 0.0:
        raise CannotGo(NO_FRICTION)
    if isinstance(law, Stribeck):
        return model.with_law(_flat(kinetic, law.viscosity))
    return model.with_law(law.model_copy(update={"mu_static": None}))


def without_viscosity(model: LesserModel) -> LesserModel | None:
    """Without friction that grows with speed."""
    law = model.law
    if not getattr(law, "viscosity", 0.0):
        return None
    if isinstance(law, Stribeck) and law.mu_static == law.mu_kinetic:
        return model.with_law(_flat(law.mu_kinetic, 0.0))
    return model.with_law(law.model_copy(update={"viscosity": 0.0}))


def _flat(mu: float, viscosity: float) -> FrictionLaw:
    return Stribeck(mu_kinetic=mu, mu_static=mu, viscosity=viscosity) if viscosity else Coulomb(mu=mu)
