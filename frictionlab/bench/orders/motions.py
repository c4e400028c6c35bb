"""The kinds of motion on which orders are measured: one scene and law each."""

from __future__ import annotations

from dataclasses import dataclass

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.scene.scene import Drive, Load, Scene, Transverse

_RESONANCE = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=20.0, drive=Drive(amplitude=10.0, frequency=1.0)
)
"""Strong friction at resonance: without friction the velocity has the amplitude 50."""
_MOSTLY_HELD = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=1.0, drive=Drive(amplitude=2.5, frequency=0.5)
)
"""The load is below friction: the mass sticks most of the time."""
_IN_PHASE = Scene(
    damping_ratio=0.1,
    normal_load=1.0,
    belt_speed=5.0,
    drive=Drive(unbalance=10.0, frequency=4.0),
    transverse=Transverse(natural_frequency=1.0, damping_ratio=0.1, load=Load(unbalance=10.0)),
)
"""Both velocities swing in phase, with 43: slip turns round twice a period at 0.7 of the belt's speed."""
_OFF_RESONANCE = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=45.0, drive=Drive(amplitude=30.0, frequency=1.5)
)
"""Off resonance; without friction the velocity has the amplitude 35."""
_COULOMB = Coulomb(mu=0.4)
_FALLING = Stribeck(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=40.0)
_DRAGGED = LuGre(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=40.0, presliding_length=10.0)
_SOFT, _STIFF = LuGre(mu_kinetic=0.4, presliding_length=5.0), LuGre(mu_kinetic=0.4, presliding_length=0.5)


@dataclass(frozen=True)
class KindOfMotion:
    """A steady state whose errors are typical; law_text: in a few words.

    irregular: where in a step slip reverses or stick begins decides how large the error is.
    """

    name: str
    title: str
    scene: Scene
    law: FrictionLaw
    law_text: str
    irregular: bool


_ALL = (
    KindOfMotion("smooth", "slip without reversal", _OFF_RESONANCE, _FALLING, "Stribeck, falling", False),
    KindOfMotion("crossing", "slip reverses", _RESONANCE, _COULOMB, "Coulomb", True),
    KindOfMotion("grazing", "slip just reaches rest", _RESONANCE.at(50.0), _COULOMB, "Coulomb", True),
    KindOfMotion("stick", "mostly stick", _MOSTLY_HELD, _COULOMB, "Coulomb", True),
    KindOfMotion(
        "bristle_dragged", "bristles, no reversal", _OFF_RESONANCE, _DRAGGED, "LuGre, falling", False
    ),
    KindOfMotion("bristle_soft", "soft bristles, 5 long", _RESONANCE, _SOFT, "LuGre", True),
    KindOfMotion("bristle_stiff", "stiff bristles, 0.5 long", _RESONANCE, _STIFF, "LuGre", True),
    KindOfMotion("plane_near_rest", "plane, slip passes near rest", _IN_PHASE, _COULOMB, "Coulomb", False),
)
MOTIONS: dict[str, KindOfMotion] = {motion.name: motion for motion in _ALL}
"""By name, in the order of tables and pictures."""
