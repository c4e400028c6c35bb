"""Random scenes, drawn, answered, compared and counted: python tests/benchmarks/campaign.py KIND [options].

KIND is a name of ``drawers/kinds.py``, whose drawer says what is drawn and what it is compared with. Printed: how
many scenes came to which end, and each that is wrong; exit code 1 where there is one.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path[:0] = [str(Path(__file__).parents[2]), str(Path(__file__).parents[1])]

import conftest  # noqa: E402, F401  # plugins are seen without being installed
import frictionlab as fl  # noqa: E402
from frictionlab.study import registry  # noqa: E402

Keys = dict[str, Any]
WRONG = "WRONG"
SLOW = 3.0
"""Seconds of one scene that are worth a line."""


@dataclass(frozen=True)
class Drawn:
    """A scene and a law as the plain keys of a study; kind: what it is counted under. method: a name, or a method."""

    kind: str
    scene: Keys
    law: Keys
    tolerance: float = 1e-8
    method: Any = "auto"

    def made(self) -> tuple[fl.Scene, Any]:
        """The scene and the law."""
        return fl.Scene(**self.scene), law_of(self.law)

    def answered(self) -> fl.SteadyState:
        """Its steady state."""
        return fl.steady_state(*self.made(), method=self.method, tolerance=self.tolerance)


Verdicts = Iterable[tuple[str, Any]]
"""What came of a scene, in words that are counted, and more that is printed where they begin with WRONG."""


class Unknown(Exception):
    """There is no reference; why not."""


@dataclass(frozen=True)
class Campaign:
    """draw: a scene; None for one of no use. judge: of every scene. compare: of so many of those that are ok."""

    draw: Callable[[np.random.Generator], Drawn | None]
    judge: Callable[[Drawn], Verdicts]
    compare: Callable[[Drawn], Verdicts] | None = None
    scenes: int = 1000
    compared: int = 100


def law_of(keys: Keys) -> Any:
    """The law of these keys."""
    return registry.law_class(keys["kind"])(**{name: keys[name] for name in keys if name != "kind"})


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Between two positive numbers, their logarithm uniform."""
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def sound(one: Drawn) -> Verdicts:
    """Whether an answer is what its status says: a number with an error, or a reason."""
    state = one.answered()
    right = state.status in ("ok", "not_unique") or bool(state.reason)
    if state.status == "ok":
        told = 0.0 <= state.error <= one.tolerance or bool(state.reason and one.method != "auto")
        right = math.isfinite(state.mean_friction) and told
    elif state.status == "not_unique":
        right = state.mean_low <= state.mean_high
    elif state.status == "failed":
        right = "without bound" in state.reason  # an undamped resonance
    if not right:
        yield f"{WRONG}: {state.status}", (state.reason, state.mean_friction, state.error)
    elif state.status == "ok":
        yield "ok", ""
    else:
        yield f"{state.status}: {state.reason[:80]}", ""


def covered(reference: Callable[[Drawn, fl.SteadyState], tuple[float, float]]) -> Callable[[Drawn], Verdicts]:
    """Whether errors cover the distance from a reference: a mean and its own error. It raises Unknown."""

    def compare(one: Drawn) -> Verdicts:
        state = one.answered()
        try:
            true, own = reference(one, state)
        except (Unknown, ArithmeticError, ValueError) as why:
            yield f"not compared: {str(why)[-60:]}", ""
            return
        off = abs(state.mean_friction - true)
        if off <= state.error + own:
            yield "compared", ""
        else:
            yield f"{WRONG}: uncovered", f"{off:.2e} > {state.error:.1e} + {own:.1e}, {true!r}, {state.model}"

    return compare


def scenes_of(campaign: Campaign, count: int, seed: int) -> Iterator[Drawn]:
    """So many scenes."""
    rng = np.random.default_rng(seed)
    while count > 0:
        if (one := campaign.draw(rng)) is not None:
            yield one
            count -= 1


def run(campaign: Campaign, scenes: int, compared: int, seed: int) -> int:
    """Print what became of the scenes; 1 where something is wrong."""
    found, seconds, left = Counter[str](), list[float](), compared
    for number, one in enumerate(scenes_of(campaign, scenes, seed)):
        begun = time.perf_counter()
        verdicts = [*campaign.judge(one)]
        seconds.append(time.perf_counter() - begun)
        if campaign.compare is not None and left > 0 and verdicts[0][0] == "ok":
            more = [*campaign.compare(one)]
            left -= not more[0][0].startswith("not compared")
            verdicts += more
        for what, told in verdicts:
            found[f"{one.kind}: {what}"] += 1
            if what.startswith(WRONG):
                print(f"{number}: {what}: {told}; {one}", flush=True)
        if seconds[-1] > SLOW:
            print(
                f"{number}: {seconds[-1]:.1f} s, compiling included: {one.kind}", file=sys.stderr, flush=True
            )
    for line in sorted(found.items()):
        print(*line)
    spans = ", ".join(f"{part:.3g}" for part in np.quantile(seconds, [0.5, 0.9, 0.99, 1.0]))
    print(f"{scenes} scenes, seconds each: {spans} (median, 90 %, 99 %, most)")
    return int(any(WRONG in what for what in found))


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line."""
    from drawers.kinds import KINDS, campaign_of

    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--scenes", type=int)
    parser.add_argument("--compared", type=int)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args(arguments)
    campaign = campaign_of(given.kind)
    scenes = campaign.scenes if given.scenes is None else given.scenes
    compared = campaign.compared if given.compared is None else given.compared
    return run(campaign, scenes, compared, given.seed)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parent))
    from campaign import main as run_as_module  # one module, whoever imports it

    sys.exit(run_as_module())
