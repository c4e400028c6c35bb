"""Brute-force time stepping to the steady state, with an error estimate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field, ValidationInfo, field_validator

from frictionlab.laws.base import FrictionLaw, Positive
from frictionlab.methods.base import Answers, Ledger, Method
from frictionlab.methods.march.judge import FullAnswer, MarchedPoint, Plan
from frictionlab.methods.march.refusal import Request, reasons_against
from frictionlab.methods.march.steppers import STEPPERS, StepperName, steppers_of
from frictionlab.methods.reduced.common import full_answers
from frictionlab.methods.under_way import each_told
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import gone


def _whole(given: object) -> object:
    if isinstance(given, bool) or not isinstance(given, int | float) or given != int(given):
        raise ValueError("must be a whole number")
    return int(given)


def _half_or_one(given: object) -> object:
    if isinstance(given, bool) or given not in (0.5, 1):
        raise ValueError("must be 0.5 or 1")
    return 1.0 if given == 1 else 0.5


NO_EXPONENTIAL = "the exponential stepper is gone: use sdirk2, which needs no short steps either, or rk4"
NO_ROOT = "smoothing by a square root is gone: use tanh or arctan"
Theta = Annotated[float, BeforeValidator(_half_or_one)]
Count = Annotated[int, BeforeValidator(_whole), Field(ge=4, le=100_000_000)]


class March(Method):
    """Time stepping, period by period, until the motion repeats: no events, no shooting.

    Steps end at the corners of loads, belt velocity and normal load. If several frequencies act, a period is
    their common one. Under a normal load that changes, a law of one bristle may keep its stiffness (contact:
    constant); other memory may not.

    The motion starts from ``scene.initial``, else on the friction-free orbit, undriven at rest on the belt.
    The error of the mean is its distance to the answer of ``exact`` or ``shooting``, which also tell whether
    the steady state is unique. Where these have no answer march has none: nothing else tells how far off steps
    are.

    Parameters
    ----------
    stepper : {"moreau", "rk4", "smoothed", "sdirk2"}, optional
        Stepper. For laws without memory: "moreau" (default: Moreau-Jean, friction projected on its disk),
        "rk4" (Runge-Kutta of order 4, which ignores the jump of friction) or "smoothed" (DOP853 with step
        control, friction smoothed at rest). For laws with bristles: "rk4" (default; steps limited by the mass
        held by its bristles and by stiffness*speed/friction) or "sdirk2" (L-stable, of order 2, no limit). For
        laws with several memories or scalars: "rk4" (steps limited by their largest rate).
    theta : float, 0.5 or 1, optional
        Parameter theta [-] of "moreau"; 0.5 if left out.
    steps : int, >= 4, optional
        Steps per period of the drive, without a drive per 2 pi; of all steppers but "smoothed". If left out,
        steps are doubled until the error is below the tolerance or a point has cost 16 million steps.
    width : float, > 0, optional
        Width of the smoothing [scene velocity] of "smoothed"; 0.01 if left out.
    smoothing : {"tanh", "arctan"}, optional
        Smoothing function of "smoothed"; "tanh" if left out.
    periods : int, >= 4, default 100000
        Largest number of periods to wait for the motion to repeat.

    References
    ----------
    Sources: moreau: Moreau (1988), Jean (1999); rk4: Kutta (1901); smoothed: Hairer, Nørsett & Wanner (1993);
    sdirk2: Alexander (1977).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method=fl.March(steps=1000))
    >>> round(state.mean_friction, 3), state.error < 1e-2
    (0.051, True)
    """

    name: ClassVar[str] = "march"
    in_words: ClassVar[str] = "time stepping"

    stepper: Annotated[StepperName | None, gone("exponential", NO_EXPONENTIAL)] = None
    theta: Theta | None = None
    steps: Count | None = None
    width: Positive | None = None
    smoothing: Annotated[Literal["tanh", "arctan"] | None, gone("square_root", NO_ROOT)] = None
    periods: Count = 100_000

    @field_validator("theta", "steps", "width", "smoothing", mode="before")
    @classmethod
    def _key_of_the_stepper(cls, given: object, info: ValidationInfo) -> object:
        """Key by key, not for all at once, so that it is told beside whatever else is wrong."""
        stepper: StepperName = info.data.get("stepper") or "moreau"
        own = STEPPERS[stepper].keys if "stepper" in info.data else None
        if given is not None and own is not None and info.field_name not in own:
            known = ", ".join(own)
            raise ValueError(f"leave it out, stepper {stepper} knows {known} and periods")
        return given

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Return why a stepper cannot do this: another kind of law, static friction without stick, too stiff."""
        assert scene.normal_load is not None
        law = law.under_load(scene.normal_load)
        return next(reasons_against(Request(scene, law, self._stepper(law), self.theta, self.steps)), None)

    def _stepper(self, law: FrictionLaw) -> StepperName:
        known: list[StepperName] = [*steppers_of(law.memory_kind), "moreau"]
        return self.stepper or known[0]

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer each scene by itself, from its own start."""
        assert scenes[0].normal_load is not None
        law = law.under_load(scenes[0].normal_load)
        theta, width, smoothing = self.theta or 0.5, self.width or 0.01, self.smoothing or "tanh"
        plan = Plan(self._stepper(law), theta, self.steps, width, smoothing, self.periods)
        full, ledger = full_answers(scenes, law), Ledger(len(scenes))
        points = [
            MarchedPoint(scene, law, tolerance, plan, FullAnswer.of(full, i))
            for i, scene in enumerate(scenes)
        ]
        for i, point in enumerate(each_told(points)):
            point.enter(ledger, i)
        return ledger.answers(orbit=lambda i: points[i].orbit())
