"""Check arguments of ``fl.run``, ``fl.curve``, ``fl.steady_state`` ...; errors name what is allowed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from math import isfinite
from numbers import Real
from os import PathLike
from typing import Any, Literal, get_args

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.workforce import Workforce
from frictionlab.scene.scene import Scene
from frictionlab.study import registry
from frictionlab.study.axes import ENDS, WITHIN, SweepRange
from frictionlab.study.keys import USUAL_LIMIT
from frictionlab.study.load import load_study, parse_study
from frictionlab.study.study import Study
from frictionlab.values.columns import ALL, GROUPS, RESULTS, SI
from frictionlab.values.notes import (
    Mistake,
    StudyError,
    Unfit,
    closest,
    did_you_mean,
    python_text,
    unknown_name,
)
from frictionlab.values.quantities import Floats, rebuilt
from frictionlab.values.units import in_units

Existing = Literal["reuse", "replace"]
"""Ways to treat results that are already in the folder of a run."""


def given_scene(scene: Scene) -> Scene:
    """Return the scene, its values checked. Raises TypeError, WrongValues."""
    if isinstance(scene, Scene):
        return scene.checked()
    hint = "did you mean fl.Scene(**scene)?" if isinstance(scene, Mapping) else ""
    raise TypeError(_refusal("scene must be an fl.Scene", scene, hint))


def given_law(law: FrictionLaw) -> FrictionLaw:
    """Return the law, its values checked. Raises TypeError, WrongValues."""
    if isinstance(law, FrictionLaw):
        return rebuilt(law)
    kind: Any = law
    if isinstance(law, str) and (name := closest(law, registry.law_names())):
        kind = registry.law_class(name)
    hint = f"did you mean {_call(kind)}?" if isinstance(kind, type) and issubclass(kind, FrictionLaw) else ""
    raise TypeError(_refusal("law must be a friction law such as fl.Coulomb(mu=0.4)", law, hint))


def given_method(method: str | Method) -> Method:
    """Return the method, its values checked. Raises TypeError, or ValueError for an unknown name."""
    if isinstance(method, Method):
        return rebuilt(method)
    if not isinstance(method, str):
        hint = f"did you mean {_call(method)}?" if isinstance(method, type) else ""
        raise TypeError(
            _refusal("method must be a name such as 'auto', or a method such as fl.March()", method, hint)
        )
    if method not in registry.method_names():
        raise ValueError(_with(*unknown_name("method", method, registry.method_names())))
    return registry.method_class(method)()


def given_tolerance(tolerance: float, name: str = "tolerance") -> float:
    """Return the tolerance as a float; ``name`` is used in the error. Raises ValueError."""
    number = isinstance(tolerance, Real) and not isinstance(tolerance, bool)
    if not (number and isfinite(tolerance) and tolerance > 0.0):
        raise ValueError(_refusal(f"{name} must be a positive number", tolerance))
    return float(tolerance)


def given_speeds(belt_speed: Any, scene: Scene) -> Floats:
    """Return belt speeds as an array: numbers, texts with units of a scene in SI units, or a range.

    Raises ValueError.
    """
    if isinstance(belt_speed, Mapping):
        if WITHIN in belt_speed:
            raise ValueError("belt_speed: fl.compare and fl.sweep take ranges with within; give num")
        ends = {key: _speed(value, scene) if key in ENDS else value for key, value in belt_speed.items()}
        return np.array(SweepRange(**ends).values())
    given = np.atleast_1d(np.asarray(belt_speed, dtype=object))
    if given.ndim != 1:
        raise ValueError(_refusal("belt_speed must be a list of finite numbers", belt_speed))
    if not given.size:
        raise ValueError("belt_speed must be a list of finite numbers, got none")
    read = [_speed(each, scene) for each in given]
    for place, each in enumerate(read):
        if isinstance(each, bool) or not isinstance(each, Real) or not isfinite(each):
            where = f" at [{place}]" if np.ndim(belt_speed) else ""
            raise ValueError(f"{_refusal('belt_speed must be a list of finite numbers', each)}{where}")
    return np.array(read, dtype=np.float64)


def _speed(given: Any, scene: Scene) -> Any:
    """Return a belt speed, of a scene in SI units a text with a unit as a number. Raises ValueError."""
    found = in_units(given, "m/s") if isinstance(given, str) and scene.dimensional is not None else given
    if isinstance(found, Unfit):
        raise ValueError(f"belt_speed: {found.what}")
    return found


def given_columns(names: Sequence[str] | str, scene: Scene) -> tuple[str, ...]:
    """Return these names of result columns of the scene or of groups, each once. Raises ValueError."""
    known = [*RESULTS, *(SI if scene.dimensional is not None else ()), *GROUPS]
    if names == ALL:
        return (ALL,)
    if isinstance(names, str) or not isinstance(names, Sequence):
        raise ValueError(_refusal("columns must be a list of names", names))
    for name in names:
        if name not in known:
            hint = did_you_mean(str(name), known)
            raise ValueError(_with(f"columns: no result column or group '{name}'", hint))
    return tuple(dict.fromkeys(names))


def given_study(
    study: str | PathLike[str] | Mapping[str, Any] | Study,
    overrides: Sequence[str],
    columns: Sequence[str] | str | None,
) -> Study:
    """Return the study of a file, a mapping or a record, its values checked.

    Raises StudyError, TypeError, ValueError.
    """
    if isinstance(overrides, str) or not all(isinstance(each, str) for each in overrides):
        raise TypeError(_refusal("overrides must be a list such as ['scene.belt_speed=5']", overrides))
    if isinstance(study, Study):
        ready = _checked_study(study)
    elif isinstance(study, Mapping):
        ready = parse_study(study, overrides)
    elif isinstance(study, str | PathLike):
        ready = load_study(study, overrides)
    else:
        raise TypeError(_refusal("study must be the path of a study file, a mapping or a Study", study))
    return ready if columns is None else replace(ready, columns=given_columns(columns, ready.scene))


def _checked_study(study: Study) -> Study:
    """Check a study record again, since ``replace`` or ``model_copy`` may have changed it; return it."""
    for choice in study.laws:
        choice.law_class(**choice.parameters)
    given_columns(study.columns or (), study.scene)
    return replace(study, scene=given_scene(study.scene), tolerance=given_tolerance(study.tolerance))


def check_limit(study: Study, executor: Executor | Workforce | None) -> None:
    """Raise StudyError if a study limits the time of a point and threads solve it, which nobody can stop."""
    by_threads = executor is None or (isinstance(executor, Workforce) and not executor.elsewhere)
    if by_threads and study.limit != USUAL_LIMIT:
        name = "study" if study.path is None else str(study.path)
        what = "needs processes: give --processes N (in Python an executor of processes), or leave limit out"
        raise StudyError([Mistake(name, None, "limit.seconds_per_point", what)])


def check_ways(existing: Existing, executor: Executor | Workforce | None) -> None:
    """Check ``existing`` and ``executor``. Raises ValueError, TypeError."""
    if existing not in get_args(Existing):
        allowed = " or ".join(map(repr, get_args(Existing)))
        raise ValueError(_refusal(f"existing must be {allowed}", existing))
    check_executor(executor)


def check_executor(executor: Executor | Workforce | None) -> None:
    """Raise TypeError if ``executor`` is neither None, an Executor nor a Workforce."""
    if executor is not None and not isinstance(executor, Executor | Workforce):
        raise TypeError(_refusal("executor must be a concurrent.futures.Executor", executor))


def _refusal(allowed: str, value: Any, hint: str = "") -> str:
    return _with(f"{allowed}, got {python_text(value)}", hint)


def _with(what: str, hint: str) -> str:
    return f"{what}; {hint}" if hint else what


def _call(kind: Any) -> str:
    """Return the call that makes a record of this class: its name and the values that it requires."""
    fields = getattr(kind, "model_fields", {})
    required = (f"{name}=..." for name, field in fields.items() if field.is_required())
    return f"{kind.__name__}({', '.join(required)})"
