"""Shooting: the period map of adaptive eighth-order steps, stick included, closed by quasi-Newton steps.

The end of a refusal: the advice to use shooting, or the reason why shooting refuses as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import (
    Answers,
    FoundState,
    Method,
    about_rest,
    beyond_linear,
    beyond_springs,
)
from frictionlab.methods.periodic.period_map import MAP_KINDS
from frictionlab.methods.periodic.problem import along_the_belt
from frictionlab.methods.prescribed.method import solve_prescribed
from frictionlab.methods.shooting.decoupled import axes_apart, solve_apart
from frictionlab.methods.shooting.driven import solve_driven
from frictionlab.methods.shooting.followed_states import follow_motion, follow_states
from frictionlab.methods.shooting.undriven import ACROSS, Undriven, solve_undriven
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.parts import BENDING
from frictionlab.scene.scene import Scene

Applies = Callable[[Scene, FrictionLaw], bool]
Solve = Callable[[Sequence[Scene], FrictionLaw, float], Answers]

CASES: tuple[tuple[Applies, Solve], ...] = (
    (lambda scene, _law: scene.degrees_of_freedom == 0, solve_prescribed),
    (lambda scene, _law: scene.undriven, solve_undriven),
    (axes_apart, solve_apart),
    (lambda _scene, _law: True, solve_driven),
)
"""Kinds of scene and law, and what answers a curve of them: the first that applies."""


def _case(scene: Scene, law: FrictionLaw) -> Solve:
    return next(solve for applies, solve in CASES if applies(scene, law))


CONSTANT_CONTACT = (
    "normal_load_variation.contact: constant keeps the stiffness of one bristle; a law with another memory has none "
    "of its own: give per_load"
)
CREEPS = (
    "on a belt at rest a contact whose memory has no direction creeps as long as its spring pulls: no state is "
    "steady but that of the unstretched spring; leave initial out, or give a belt speed"
)


def starts_to_creep(scene: Scene) -> bool:
    """Check whether the mass moves, or its spring pulls, on a belt at rest."""
    return scene.belt_speed == 0.0 and (scene.start.x != 0.0 or scene.start.velocity != 0.0)


class Shooting(Method):
    """Shooting on the period map of any law, with or without memory, along one line or in the plane.

    DOP853 integrates the deviation from the friction-free response, and the instants of stick and release are
    resolved. Bristles are integrated by Rodas5P or computed as a function of the path slid. Planar slip near
    rest is integrated implicitly in polar coordinates. Broyden's method closes the orbit, with Newton and
    Picard steps if it stalls. If no theorem makes the state unique, the state must attract, and motions from
    starts far from each other must reach it.

    Without a drive the period is an unknown, too, and the answer is the state reached from ``scene.initial``:
    steady sliding, a cycle or rest. Under a prescribed slip the mean is computed by quadrature, or from the
    closed loop of the memory.

    References
    ----------
    Sources: DOP853: Hairer, Nørsett & Wanner (1993); Broyden (1965); Rodas5P: Steinebach (2023).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="shooting")
    >>> round(state.mean_friction, 4), state.error < 1e-8
    (0.0506, True)
    """

    name: ClassVar[str] = "shooting"
    resolves_events: ClassVar[bool] = True

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """An undriven start across the belt, or of a contact that creeps; a law of none of the kinds known."""
        if reason := (
            beyond_springs(scene) or beyond_linear(self.name, scene, BENDING) or about_rest(self.name, scene)
        ):
            return reason
        if law.memory_kind not in MAP_KINDS:
            return "shooting needs a SlidingLaw, a BristleLaw or a MemoryLaw"
        if scene.constant_contact and law.memory_kind in ("deflections", "scalars"):
            return CONSTANT_CONTACT
        if scene.undriven and (scene.start.x2 != 0.0 or scene.start.velocity2 != 0.0):
            return "undriven scenes are solved along the belt only: leave initial.x2 and velocity2 at 0"
        if scene.undriven and law.memory_kind == "scalars" and starts_to_creep(scene):
            return CREEPS
        if scene.undriven and scene.degrees_of_freedom == 2 and not law.damps_across(abs(scene.belt_speed)):
            return ACROSS
        if law.planar_form() == "vectorial" and not along_the_belt(scene, law):
            return law.no_vector_form() or None
        return None

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer a curve by continuation in belt speed."""
        return _case(scenes[0], law)(scenes, law, tolerance)

    def motion(self, scene: Scene, law: FrictionLaw, periods: int, tolerance: float) -> list[Orbit]:
        """Follow a driven mass by the period map that closes its orbits, an undriven one in turns of that."""
        solve = _case(scene, law)
        if solve is solve_undriven:
            return Undriven(scene, law, tolerance).from_the_start(periods)
        return follow_motion(scene, law, periods, tolerance) if solve is solve_driven else []

    def states(
        self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, starts: int
    ) -> list[FoundState]:
        """Motions of a driven mass followed to their ends, and from the ends at one belt speed on at the next."""
        solve = _case(scenes[0], law)
        return follow_states(scenes, law, tolerance, starts) if solve is solve_driven else []


def suggest_shooting(reason: str, scene: Scene, law: FrictionLaw) -> str:
    """A refusal with advice on what to use instead."""
    return f"{reason}; {Shooting().refusal(scene, law) or 'use shooting'}"
