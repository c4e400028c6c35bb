"""Draws of Hypothesis for a law: any parameters its own limits allow, and slip and memory of their size."""

from __future__ import annotations

import math
from functools import cache
from itertools import combinations
from random import Random
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import hypothesis
from hypothesis import strategies as st
from pydantic import ValidationError
from pydantic.fields import FieldInfo

from frictionlab.laws.base import FrictionLaw

PARAMETER_DECADES = 3.0
"""A number without an upper limit is drawn within so many decades of one."""
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
TRIES = 50
"""Sets of parameters before these count as ones that cannot be given together."""
MOST_PRESENCES = 256
"""Largest number of combinations of optional parameters that are tried."""


class NoParameters(AssertionError):
    """Law accepts none of the drawn parameters."""


def evenly(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers spread evenly, the middle the simplest.

    Hypothesis prefers round and small numbers; steps of the golden ratio spread even the smallest whole ones.
    """
    return st.integers(0, 65_535).map(lambda n: low + (high - low) * ((0.5 + n * GOLDEN) % 1.0))


def sizes(low: float, high: float) -> st.SearchStrategy[float]:
    """Positive numbers, log-uniform."""
    return evenly(math.log10(low), math.log10(high)).map(lambda exponent: 10.0**exponent)


def seldom(special: st.SearchStrategy[Any], usual: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """Return what is special one time in four, and simplest; else what is usual."""
    return st.integers(0, 3).flatmap(lambda way: usual if way else special)


signs = st.sampled_from([1.0, -1.0])
shares = seldom(st.sampled_from([0.0, 1.0, -1.0, 1.0, -1.0]), evenly(-1.0, 1.0))
"""Shares of what a memory can hold, either way: none and all of it often enough to be seen."""
angles = evenly(-math.pi, math.pi)
directions = seldom(
    st.sampled_from([1.0 + 0j, -1.0 + 0j, 1j, -1j]),
    angles.map(lambda angle: complex(math.cos(angle), math.sin(angle))),
)
"""Directions in the plane; along the axes often enough that a form of its own there is seen."""
speeds = sizes(1e-6, 1e6)


@cache
def loaded_laws(law: type[FrictionLaw]) -> st.SearchStrategy[FrictionLaw]:
    """A law with parameters drawn from its own limits, under a normal load. Raises NoParameters."""
    return st.builds(lambda made, load: made.under_load(load), unloaded_laws(law), sizes(1e-1, 1e1))


@cache
def unloaded_laws(law: type[FrictionLaw]) -> st.SearchStrategy[FrictionLaw]:
    """A law as its parameters were given. Raises NoParameters."""
    return _of_presences(law, _presences(law))


@cache
def fullest_laws(law: type[FrictionLaw]) -> st.SearchStrategy[FrictionLaw]:
    """Return the same, as many parameters as can be given together given more often. Raises NoParameters."""
    presences = _presences(law)
    fullest = {
        max((given for given in presences if name in given), key=len, default=()) for name in law.model_fields
    }
    return _of_presences(law, [*fullest, *presences])


def _of_presences(law: type[FrictionLaw], presences: list[tuple[str, ...]]) -> st.SearchStrategy[FrictionLaw]:
    chosen = {name: values(field) for name, field in law.model_fields.items()}
    lists = [name for name, field in law.model_fields.items() if get_args(_inside(field)[0])[-1:] == (...,)]

    def with_values(given: tuple[str, ...]) -> st.SearchStrategy[FrictionLaw]:
        drawn = st.fixed_dictionaries({name: chosen[name] for name in given})
        told = seldom(drawn, drawn.map(lambda told: _of_one_length(told, lists)))
        return told.filter(lambda told: _made(law, told) is not None).map(lambda told: law(**told))

    return st.sampled_from(presences).flatmap(with_values)


def _of_one_length(told: dict[str, Any], lists: list[str]) -> dict[str, Any]:
    """Values, every list as long as the shortest: laws of elements ask for as many values in each of theirs."""
    shortest = min([len(told[name]) for name in lists if name in told], default=0)
    return {name: value[:shortest] if name in lists else value for name, value in told.items()}


def _made(law: type[FrictionLaw], told: dict[str, Any]) -> FrictionLaw | None:
    try:
        return law.model_validate(told)
    except ValidationError:
        return None


@cache
def _presences(law: type[FrictionLaw]) -> list[tuple[str, ...]]:
    """Find by trying which parameters can be given together; those that must be given are in every one."""
    optional = [name for name, field in law.model_fields.items() if not field.is_required()]
    must = [name for name in law.model_fields if name not in optional]
    free = [
        name for name in optional if law.model_fields[name].get_default(call_default_factory=True) is not None
    ]
    choices = [name for name in optional if name not in free]
    subsets = [given for size in range(len(choices) + 1) for given in combinations(choices, size)]
    tried = [(*must, *free, *given) for given in subsets[:MOST_PRESENCES]]
    found = [given for given in tried if _is_accepted(law, given)]
    if not found:
        raise NoParameters(
            f"no parameters within their limits make a {law.__name__}: {_refusal(law, tried[0])}"
        )
    return found


def _is_accepted(law: type[FrictionLaw], given: tuple[str, ...]) -> bool:
    """Check whether some values of these make a law."""
    random = Random(0)
    fields = {name: law.model_fields[name] for name in given}
    tries = ({name: _probed(_inside(field), random) for name, field in fields.items()} for _ in range(TRIES))
    return any(_made(law, told) is not None for told in tries)


def _inside(field: FieldInfo) -> tuple[Any, tuple[Any, ...]]:
    """Return the type of a field that is given, and the rules beside it."""
    kind, rules = field.annotation, tuple(field.metadata)
    while get_origin(kind) in (Annotated, Union, UnionType):
        if get_origin(kind) is Annotated:
            kind, *more = get_args(kind)
            rules = (*rules, *more)
        else:
            kind = next(each for each in get_args(kind) if each is not NoneType)
    return kind, rules


def _probed(inside: tuple[Any, tuple[Any, ...]], random: Random) -> Any:
    """A value of a type, without Hypothesis: it is asked thousands of times."""
    kind, rules = inside
    if get_origin(kind) is Literal:
        return random.choice(get_args(kind))
    if get_origin(kind) is tuple:
        each = _inside(FieldInfo(annotation=get_args(kind)[0]))
        return tuple(_probed(each, random) for _ in range(3))
    low, high = limits(rules)
    if math.isfinite(low) and math.isfinite(high):
        number = random.uniform(low, high)
    else:
        size = 10.0 ** random.uniform(-1.0, 1.0)
        number = high - size if math.isfinite(high) else max(low, 0.0) + size
    return max(math.ceil(low), round(number)) if kind is int and math.isfinite(low) else number


def _refusal(law: type[FrictionLaw], given: tuple[str, ...]) -> str:
    """Why a law of these, each as large as one, is refused."""
    try:
        law.model_validate(dict.fromkeys(given, 1.0))
    except ValidationError as problem:
        return "; ".join(error["msg"] for error in problem.errors())
    return "its limits leave next to nothing"


def quietly(examples: int, *phases: hypothesis.Phase) -> hypothesis.settings:
    """Settings of a run that is the same every time and keeps nothing."""
    return hypothesis.settings(
        max_examples=examples,
        deadline=None,
        database=None,
        derandomize=True,
        report_multiple_bugs=False,
        print_blob=False,
        phases=(hypothesis.Phase.generate, *phases),
        suppress_health_check=list(hypothesis.HealthCheck),
    )


def values(field: FieldInfo) -> st.SearchStrategy[Any]:
    """Return what a field may hold, by its annotation; its default often enough to be seen."""
    drawn = _of(field.annotation, tuple(field.metadata))
    default = None if field.is_required() else field.get_default(call_default_factory=True)
    return drawn if default is None else seldom(st.just(default), drawn)


def words(law: type[FrictionLaw], name: str) -> tuple[str, ...]:
    """Return the words a parameter that takes no number may be."""
    kind = law.model_fields[name].annotation
    return get_args(kind) if get_origin(kind) is Literal else ()


def _of(kind: Any, rules: tuple[Any, ...]) -> st.SearchStrategy[Any]:
    if get_origin(kind) is Annotated:
        inside, *more = get_args(kind)
        return _of(inside, (*rules, *more))
    if get_origin(kind) in (Union, UnionType):
        return st.one_of([_of(each, rules) for each in get_args(kind) if each is not NoneType])
    if get_origin(kind) is Literal:
        return st.sampled_from(get_args(kind))
    if get_origin(kind) is tuple:
        return _tuples(get_args(kind), rules)
    if kind is bool:
        return st.booleans()
    low, high = limits(rules)
    if kind is int:
        most = high if math.isfinite(high) else max(low, 0.0) + 8.0
        return st.integers(math.ceil(low) if math.isfinite(low) else -8, math.floor(most))
    if kind is float:
        return numbers(low, high)
    return st.from_type(kind)


def _tuples(kinds: tuple[Any, ...], rules: tuple[Any, ...]) -> st.SearchStrategy[Any]:
    """Draw tuples of any length up to four, or by one strategy per place."""
    if kinds[-1] is not Ellipsis:
        return st.tuples(*[_of(kind, ()) for kind in kinds])
    least = max([getattr(rule, "min_length", 0) or 0 for rule in rules], default=0)
    lists = st.lists(_of(kinds[0], ()), min_size=least, max_size=max(4, least))
    return lists.map(tuple)


def limits(rules: tuple[Any, ...]) -> tuple[float, float]:
    """Return the least and largest number that pydantic's rules let through, whether or not they do at the limit."""
    flat = [each for rule in rules for each in (rule, *getattr(rule, "metadata", ()))]
    low = [getattr(rule, key, None) for rule in flat for key in ("gt", "ge")]
    high = [getattr(rule, key, None) for rule in flat for key in ("lt", "le")]
    return (
        max([float(bound) for bound in low if bound is not None], default=-math.inf),
        min([float(bound) for bound in high if bound is not None], default=math.inf),
    )


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers between two limits: log-uniform away from a limit at zero, even between two others."""
    if low >= 0.0 and high == math.inf:
        spread = sizes(10.0**-PARAMETER_DECADES, 10.0**PARAMETER_DECADES).map(lambda size: low + size)
        return spread if low > 0.0 else seldom(st.just(0.0), spread)
    if math.isfinite(low) and math.isfinite(high):
        return evenly(low + 1e-6 * (high - low), high - 1e-6 * (high - low))
    size = sizes(10.0**-PARAMETER_DECADES, 10.0**PARAMETER_DECADES)
    if math.isfinite(high):
        return size.map(lambda distance: high - distance)
    if math.isfinite(low):
        return size.map(lambda distance: low + distance)
    return st.builds(lambda sign, number: sign * number, signs, size)
