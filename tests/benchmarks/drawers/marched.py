"""Every kind of scene (tests/draws_of_every_kind.py), marched by a stepper of its law with 200 or 400 steps a period.

Compared with shooting; what that refuses (a contact of constant stiffness) with the tests' own integration.
"""

from __future__ import annotations

import numpy as np
from campaign import Campaign, Drawn, Unknown, covered, law_of, sound
from draws_of_every_kind import Numpy, scene_of_every_kind

import frictionlab as fl
from drawers.outside import followed
from frictionlab.methods.march.steppers import steppers_of

STEPS = 200


def draw(rng: np.random.Generator) -> Drawn:
    """A scene, a law and a stepper."""
    source = Numpy(rng)
    scene, law = scene_of_every_kind(source)
    stepper = source.among(steppers_of(law_of(law).memory_kind))
    method = fl.March(stepper=stepper)
    if stepper != "smoothed":
        own = fl.March(stepper=stepper, steps=STEPS * (2 if stepper == "rk4" else 1))
        stable = "steps per period" not in (own.refusal(fl.Scene(**scene), law_of(law)) or "")
        method = own if stable else method
    return Drawn(f"{stepper}, {law['kind']}", scene, law, 1e-3, method)


def known(one: Drawn, state: fl.SteadyState) -> tuple[float, float]:
    """The mean by another way, and its error."""
    other = fl.steady_state(*one.made(), method="shooting", tolerance=1e-7)
    if other.status == "ok":
        return other.mean_friction, other.error
    if other.status != "refused":
        raise Unknown(f"shooting: {other.status}")
    found = followed(one)
    return found.mean, 10.0 * found.error + 1e-9


CAMPAIGN = Campaign(draw, sound, covered(known), scenes=300, compared=300)
