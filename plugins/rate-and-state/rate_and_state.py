"""Rate-and-state friction: a contact that strengthens with age and is renewed by slip."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

from frictionlab import Length, MemoryLaw, NonNegative, Positive, Speed


class RateAndState(MemoryLaw):
    """Rate-and-state friction: friction grows with the logarithm of slip speed and with that of the contact's age.

    friction = a asinh(|v|/(2 V*) exp((mu + b ln(V* theta/D_c))/a)) along v: mu + a ln(|v|/V*) + b ln(V* theta/D_c)
    but at speeds so low that this is not positive. theta, the memory, is an age [scene time]: theta' = 1 - x (ageing,
    Dieterich) or -x ln(x) (slip, Ruina), with x = |v| theta/D_c. In steady sliding x = 1: friction is then
    (a - b) ln(|v|/V*) above mu.

    mu [-], > 0: friction coefficient in steady sliding at V*.
    a [-], > 0: direct effect of speed.
    b [-], >= 0: effect of age; steady friction falls with speed where b > a.
    slip_length [scene length], > 0: D_c, the slip that renews the contact.
    reference_speed [scene velocity], > 0: V*, 1 where left out.
    state_law: ageing (a contact at rest strengthens) or slip (it does not).

    At rest the law is continuous and odd, hence one of creep: nothing sticks for good. In the plane it acts along the
    slip, and age knows no direction.
    Sources: Dieterich (1979); Ruina (1983); at low speeds: Rice & Ben-Zion (1996).
    """

    bibtex: ClassVar[str] = """
    @article{dieterich1979, author = {Dieterich, J. H.}, title = {Modeling of rock friction: 1. Experimental results
      and constitutive equations}, journal = {Journal of Geophysical Research}, volume = {84}, pages = {2161--2168},
      year = {1979}}
    @article{ruina1983, author = {Ruina, A.}, title = {Slip instability and state variable friction laws}, journal =
      {Journal of Geophysical Research}, volume = {88}, pages = {10359--10370}, year = {1983}}
    @article{rice1996, author = {Rice, J. R. and Ben-Zion, Y.}, title = {Slip complexity in earthquake fault models},
      journal = {Proceedings of the National Academy of Sciences}, volume = {93}, pages = {3811--3818}, year = {1996}}
    """
    in_words: ClassVar[str] = "Rate and state"

    memory_kind: ClassVar[Literal["deflections", "scalars"]] = "scalars"

    mu: Positive
    a: Positive
    b: NonNegative
    slip_length: Length
    reference_speed: Speed = 1.0
    state_law: Literal["ageing", "slip"] = "ageing"

    @property
    def heals(self) -> float:
        """1 where a contact at rest ages, 0 where it does not."""
        return 1.0 if self.state_law == "ageing" else 0.0

    def sliding_friction(self, speed: float) -> float:
        """mu + (a - b) ln(speed/V*), but at low speeds; 0 at rest."""
        if speed == 0.0:
            return 0.0
        return resisted(self, speed, self.slip_length / speed)

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Return the rate of the age."""
        renewed = abs(v) * memory[0] / self.slip_length
        if self.heals == 1.0:
            return 1.0 - renewed
        return -renewed * math.log(renewed) if renewed > 0.0 else 0.0

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Along the slip."""
        speed = abs(v)
        if speed == 0.0:
            return 0.0 * v
        return (resisted(self, speed, memory[0]) / speed) * v

    def steady(self, v: Any, k: int) -> Any:
        """Return the time in which slip renews the contact."""
        return self.slip_length / abs(v)

    def within(self, memory: Any) -> bool:
        """Ages are positive."""
        return memory[0] > 0.0

    def largest_rate(self, speed: float) -> float:
        """speed/slip_length of the ageing law; that of the slip law has no bound."""
        return speed / self.slip_length if self.heals == 1.0 else math.inf

    def steepest_fall(self) -> float:
        """None where b <= a; else without bound towards rest."""
        return 0.0 if self.b <= self.a else math.inf

    def passive(self) -> bool:
        """Always: friction is along the slip, and nothing is stored."""
        return True


def resisted(law: Any, speed: float, age: float) -> float:
    """Return the friction coefficient at this speed and age: a asinh(exp(power)/2), without overflow."""
    power = (law.mu + law.b * math.log(law.reference_speed * age / law.slip_length)) / law.a
    power = power + math.log(speed / law.reference_speed)
    return law.a * (power if power > 40.0 else math.asinh(0.5 * math.exp(power)))
