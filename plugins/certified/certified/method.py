"""Answers of the method ``exact`` with their means proved in interval arithmetic, where that can be done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

import frictionlab as fl
from certified.motion import NotProved
from certified.prove import prove

INTERVALS = "proved in intervals"
"""Word of the column ``model``."""
NO_EVENTS = "not proved: under a prescribed slip there are no events to enclose"
NO_ORBIT = "not proved: there is no orbit to enclose"
NO_THEOREM = "not proved: no theorem says that there is no other orbit"


class Certified(fl.Method):
    """Steady states of Coulomb friction along one line, each mean proved: no number rests on rounding.

    ``exact`` finds the orbit. Its instants and positions of stick and reversal are then enclosed in intervals by
    Krawczyk's test, and every leg between them is checked to be what it is taken for. That there is no other
    orbit is theorem T1, which needs damping. It takes some milliseconds per point. A point that is not proved
    keeps the error of ``exact``, and its reason says why.

    References
    ----------
    Sources: Krawczyk (1969); Rump (2010); of the theorem Leine & van de Wouw (2008).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="certified")
    >>> round(state.mean_friction, 10), state.error_kind
    (0.0505839238, 'guaranteed')
    """

    bibtex: ClassVar[str] = """
    @article{krawczyk1969, author = {Krawczyk, R.}, title = {{Newton-Algorithmen zur Bestimmung von Nullstellen mit
      Fehlerschranken}}, journal = {Computing}, volume = {4}, pages = {187--201}, year = {1969}, doi =
      {10.1007/BF02234767}}
    @article{rump2010, author = {Rump, S. M.}, title = {Verification methods: Rigorous results using floating-point
      arithmetic}, journal = {Acta Numerica}, volume = {19}, pages = {287--449}, year = {2010}, doi =
      {10.1017/S096249291000005X}}
    """

    name: ClassVar[str] = "certified"
    resolves_events: ClassVar[bool] = True

    def refusal(self, scene: fl.Scene, law: fl.FrictionLaw) -> str | None:
        """Return why ``exact`` cannot do this scene and law; None where it can."""
        return fl.Exact().refusal(scene, law)

    def solve(self, scenes: Sequence[fl.Scene], law: fl.FrictionLaw, tolerance: float) -> fl.Answers:
        """Answer scenes that differ in belt speed alone by ``exact``, and prove each answer."""
        answers = fl.Exact().solve(scenes, law, tolerance)
        mean, error = answers.mean.copy(), answers.error.copy()
        kind, model, reason = list(answers.error_kind), list(answers.model), list(answers.reason)
        for i, scene in enumerate(scenes):
            if answers.status[i] != "ok" or kind[i] == "guaranteed":
                continue
            try:
                mean[i], error[i] = _proved(scene, law, answers.orbit(i))
            except NotProved as why:
                reason[i] = "; ".join(filter(None, (reason[i], str(why))))
            else:
                kind[i], model[i] = "guaranteed", f"{model[i]}; {INTERVALS}"
        return replace(answers, mean=mean, error=error, error_kind=kind, model=model, reason=reason)


def _proved(scene: fl.Scene, law: fl.FrictionLaw, orbit: fl.Orbit | None) -> tuple[float, float]:
    """Return the mean friction coefficient and a bound on its error. Raises NotProved."""
    if scene.degrees_of_freedom == 0:
        raise NotProved(NO_EVENTS)
    if orbit is None:
        raise NotProved(NO_ORBIT)
    if not fl.is_unique(scene, law):
        raise NotProved(NO_THEOREM)
    try:
        return prove(scene, law.sliding_friction(1.0), orbit)
    except NotProved as why:
        raise NotProved(f"not proved: {why}") from None
