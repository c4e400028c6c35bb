"""What Hypothesis draws: laws, velocities, scenes. Sizes are log-uniform over decades."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from hypothesis import strategies as st

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.theory import friction_free_velocity


def sizes(low: float, high: float) -> st.SearchStrategy[float]:
    """Positive numbers, log-uniform."""
    return st.floats(math.log10(low), math.log10(high)).map(lambda exponent: 10.0**exponent)


@st.composite
def stribeck_laws(draw: Callable[..., Any]) -> Stribeck:
    """All four curves, strengthening by viscosity included."""
    curve = draw(st.sampled_from(["exponential", "hyperbolic", "hess-soom", "cubic"]))
    kinetic = draw(sizes(1e-2, 10.0))
    own = {"stribeck_exponent": draw(st.floats(0.5, 3.0))} if curve == "exponential" else {}
    return Stribeck(
        mu_kinetic=kinetic,
        mu_static=kinetic * draw(st.floats(1.0, 3.0)),
        stribeck_speed=draw(sizes(1e-2, 1e2)),
        viscosity=draw(st.just(0.0) | sizes(1e-3, 1.0)),
        curve=curve,
        **own,
    )


planar_forms = st.sampled_from(["vectorial", "per-axis"])


@st.composite
def compliant_laws(draw: Callable[..., Any], kind: type[Any], **parameters: st.SearchStrategy[Any]) -> Any:
    """A bristle law of a stiffness over ten decades, told in any of the three ways, and in any planar form."""
    own = {name: value for name in parameters if (value := draw(parameters[name])) is not None}
    told = draw(st.sampled_from(["stiffness", "presliding_length", "contact_stiffness"]))
    law = kind(**own, **{told: draw(sizes(1e-5, 1e5))}, planar=draw(planar_forms))
    return law.under_load(draw(sizes(1e-2, 1e2)))


@st.composite
def stribeck_bristle_laws(draw: Callable[..., Any], kind: type[Any], **more: st.SearchStrategy[Any]) -> Any:
    """Stribeck curves that fall or do not, with and without damping of the bristles and viscosity."""
    kinetic = draw(sizes(1e-3, 1e3))
    return draw(
        compliant_laws(
            kind,
            mu_kinetic=st.just(kinetic),
            mu_static=st.none() | st.just(kinetic) | st.floats(1.0, 3.0).map(lambda ratio: kinetic * ratio),
            stribeck_speed=sizes(1e-2, 1e2),
            stribeck_exponent=st.floats(0.5, 3.0),
            damping=st.none() | st.just(0.0) | sizes(1e-4, 1e2),
            viscosity=st.just(0.0) | sizes(1e-3, 1.0),
            **more,
        )
    )


BRISTLE_LAWS: dict[str, st.SearchStrategy[Any]] = {
    "dahl": compliant_laws(
        Dahl,
        mu=sizes(1e-3, 1e3),
        exponent=st.sampled_from([0.0, 0.5, 1.0, 1.5, 2.0, 3.0]) | st.floats(0.0, 3.0),
    ),
    "lugre": stribeck_bristle_laws(LuGre),
    "elasto-plastic": stribeck_bristle_laws(
        ElastoPlastic, breakaway_ratio=st.sampled_from([1e-6, 1 - 1e-6]) | st.floats(0.05, 0.95)
    ),
    "jenkins": compliant_laws(Jenkins, mu=sizes(1e-3, 1e3)),
}
"""Laws with a bristle deflection."""

VECTOR_LAWS: dict[str, st.SearchStrategy[Any]] = {
    name: laws.map(lambda law: law.model_copy(update={"planar": "vectorial"}))
    for name, laws in (BRISTLE_LAWS | {"dahl": compliant_laws(Dahl, mu=sizes(1e-3, 1e3))}).items()
}
"""The same in vectorial form, of the parameters that have one."""

LAWS: dict[str, st.SearchStrategy[FrictionLaw]] = {
    "coulomb": st.builds(
        lambda mu, ratio: Coulomb(mu=mu, mu_static=None if ratio is None else mu * ratio),
        sizes(1e-3, 1e3),
        st.none() | st.floats(1.0, 3.0),
    ),
    "stribeck": stribeck_laws(),
    **BRISTLE_LAWS,
}
"""Every law of ours with any parameters it allows; a law that is not here fails its conformance tests."""

EXAMPLES: dict[str, FrictionLaw] = {
    "coulomb": Coulomb(mu=1.0, mu_static=1.0),
    "stribeck": Stribeck(mu_kinetic=1.0, mu_static=1.0),
    "dahl": Dahl(mu=1.0, stiffness=1.0),
    "lugre": LuGre(mu_kinetic=1.0, mu_static=1.0, stiffness=1.0, damping=1.0),
    "elasto-plastic": ElastoPlastic(mu_kinetic=1.0, mu_static=1.0, stiffness=1.0, damping=1.0),
    "jenkins": Jenkins(mu=1.0, stiffness=1.0),
}
"""One of each, every number in place."""

angles = st.floats(-math.pi, math.pi)
speeds = sizes(1e-6, 1e6)
signs = st.sampled_from([-1.0, 1.0])
velocities = st.builds(lambda speed, angle: speed * complex(math.cos(angle), math.sin(angle)), speeds, angles)
velocities_on_the_line = st.builds(lambda speed, sign: sign * speed, speeds, signs)

MU = 0.4


@st.composite
def scenes_on_the_line(
    draw: Callable[..., float],
    speed: tuple[float, float] = (1e-3, 1.2),
    friction: tuple[float, float] = (0.01, 3.0),
) -> Scene:
    """One degree of freedom; speed: belt speed over V_lin, either direction; friction: over the drive (mu 0.4)."""
    load, frequency = draw(sizes(0.1, 100.0)), draw(sizes(0.2, 5.0))
    one = Scene(
        damping_ratio=draw(sizes(0.01, 2.0)),
        normal_load=load * draw(sizes(*friction)) / MU,
        belt_speed=1.0,
        drive=Drive(amplitude=load, frequency=frequency, phase=draw(st.floats(0.0, 360.0))),
    )
    v = draw(signs) * draw(sizes(*speed)) * friction_free_velocity(one)
    return one.model_copy(update={"belt_speed": v})


@st.composite
def scenes_in_the_plane(draw: Callable[..., float], friction: tuple[float, float] = (0.02, 0.5)) -> Scene:
    """Two degrees of freedom with both loads of comparable size."""
    load, frequency = draw(sizes(0.3, 30.0)), draw(st.floats(0.5, 4.0))
    across = Transverse(
        natural_frequency=draw(st.floats(0.4, 6.0)),
        damping_ratio=draw(sizes(0.05, 1.0)),
        load=Load(amplitude=load * draw(st.floats(0.3, 2.0)), phase=draw(st.floats(-180.0, 180.0))),
    )
    one = Scene(
        damping_ratio=draw(sizes(0.05, 1.0)),
        normal_load=load * draw(sizes(*friction)) / MU,
        belt_speed=1.0,
        drive=Drive(amplitude=load, frequency=frequency),
        transverse=across,
    )
    v = draw(signs) * draw(st.floats(0.05, 1.5)) * friction_free_velocity(one)
    return one.model_copy(update={"belt_speed": v})
