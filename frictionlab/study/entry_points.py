"""Loading of laws and methods from entry points, with a message for every way in which they can be broken.

Trial calls of a law of another package before it is used, interpreted.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from importlib.metadata import EntryPoint
from numbers import Complex, Real
from operator import attrgetter
from typing import Any, NamedTuple

from pydantic import ValidationError

from frictionlab.laws.base import FrictionLaw, as_written
from frictionlab.laws.faults import (
    BrokenPlugin,
    definition_line,
    describe_error,
    files_of,
    from_outside,
    innermost_line,
    outside_files,
    shown,
)
from frictionlab.methods.base import Method
from frictionlab.study.bibliography import read_bibtex

SAMPLES = (1.0, 0.5, 2.0, 10.0)
"""Trial values for the parameters of a law."""

Fault = str
"""A sentence that says what is wrong with a law."""


def faults_of_samples(law: type[FrictionLaw]) -> Iterator[Fault]:
    """Yield the faults of a law when it is built and called with sample parameters, one after the other."""
    for parameters in _samples(law):
        try:
            made = law.model_validate(parameters)
        except ValidationError as problem:
            if not law.model_fields or (not parameters and not _optional(law)):
                yield f"its own defaults are refused: {problem.errors(include_url=False)[0]['msg']}"
            continue
        except Exception as problem:
            given = ", ".join(f"{name}={value:g}" for name, value in parameters.items())
            yield f"{law.__name__}({given}) raises {describe_error(problem, files_of(law))}"
            return
        yield from faults_of_methods(made)
        return


def _samples(law: type[FrictionLaw]) -> Iterator[dict[str, float]]:
    """Parameters to build a law with: the required ones, then each optional one beside them."""
    required = [name for name, field in law.model_fields.items() if field.is_required()]
    for number in SAMPLES:
        given = dict.fromkeys(required, number)
        yield given
        yield from (given | {name: number} for name in _optional(law))


def _optional(law: type[FrictionLaw]) -> list[str]:
    return [name for name, field in law.model_fields.items() if field.default is None]


def faults_of_methods(given: FrictionLaw) -> Iterator[Fault]:
    """Yield the faults of the interfaces' methods that the law's author wrote, on the line and in the plane."""
    law = given.under_load(1.0)
    if wrong := _fault_of_error(law, "its properties", law.numbers):
        yield wrong
        return
    for v in (1.0, complex(0.6, 0.8)) if _is_planar(law) else (1.0,):
        arguments = _arguments(law, v)
        for name, interface in overridden_methods(type(law)):
            if wrong := _fault_of_call(law, name, interface, arguments):
                yield wrong


def overridden_methods(law: type[FrictionLaw]) -> list[tuple[str, Any]]:
    """Return the public methods of the interfaces that a law overrides, each with the method of the interface."""
    interfaces = [kind for kind in law.__mro__ if issubclass(kind, FrictionLaw) and not from_outside(kind)]
    said: dict[str, Any] = {}
    for kind in reversed(interfaces):
        methods = ((name, as_written(member)) for name, member in vars(kind).items())
        said |= {name: method for name, method in methods if inspect.isfunction(method)}
    return [
        (name, method)
        for name, method in said.items()
        if name[0] != "_" and as_written(inspect.getattr_static(law, name)) is not method
    ]


def _is_planar(law: Any) -> bool:
    return law.memory_kind != "bristle" or (law.planar == "vectorial" and not law.no_vector_form())


def _arguments(law: Any, v: Any) -> dict[str, Any]:
    """Arguments for the methods, by the names in their interfaces."""
    told: dict[str, Any] = {
        "speed": 1.0,
        "normal_load": 1.0,
        "side": 1.0,
        "v": v,
        "path": v,
        "z": 0.0 * v,
        "k": 0,
    }
    if law.memory_kind == "bristle":
        told["dz"] = 0.0 * v
    if law.memory_kind in ("deflections", "scalars"):
        still = 0.0 * v if law.memory_kind == "deflections" else 0.0
        told |= {"memory": [still] * law.count(), "rates": [still] * law.count()}
    return told


def _fault_of_call(law: FrictionLaw, name: str, interface: Any, arguments: dict[str, Any]) -> Fault | None:
    names = list(inspect.signature(interface).parameters)[1:]
    if not set(names) <= set(arguments):
        return None
    answer: list[Any] = []
    values = [arguments[each] for each in names]
    call = f"{name}({', '.join(f'{each}={arguments[each]}' for each in names)})"
    if wrong := _fault_of_error(law, call, lambda: answer.append(getattr(law, name)(*values))):
        return wrong
    kind = str(inspect.signature(interface).return_annotation)
    if not answer or _is_a(answer[0], kind, any(isinstance(value, complex) for value in values)):
        return None
    hint = ": is its return missing?" if answer[0] is None else ""
    code = inspect.unwrap(getattr(type(law), name)).__code__
    return f"{call} returns {shown(answer[0])}, which is no {_KINDS[kind]}{hint}{definition_line(code)}"


def _fault_of_error(law: FrictionLaw, what: str, call: Callable[[], object]) -> Fault | None:
    """Return the fault of a call that raises; arithmetic errors, which may depend on the numbers, are no fault."""
    try:
        call()
    except (ArithmeticError, ValueError):
        return None
    except Exception as problem:
        return f"{what} raises {describe_error(problem, files_of(type(law)))}"
    return None


_KINDS = {"float": "number", "int": "whole number", "bool": "True or False", "str": "text", "Any": "number"}
_KINDS |= {"complex": "number", "Self": "law", "tuple[str, ...]": "tuple of words"}


def _is_a(answer: Any, kind: str, planar: bool) -> bool:
    if kind not in _KINDS:
        return True
    if kind == "bool":
        return isinstance(answer, bool) or type(answer).__name__ == "bool_"
    if kind == "Self":
        return isinstance(answer, FrictionLaw)
    if kind in ("str", "tuple[str, ...]"):
        return isinstance(answer, str if kind == "str" else tuple)
    if isinstance(answer, bool):
        return False
    return isinstance(answer, Complex if planar and kind in ("Any", "complex") else Real)


class Home(NamedTuple):
    """Origin of a law or method, and the remedy if it is broken, as sentences."""

    name: str
    remedy: str

    def broken(self, what: str, why: BaseException | None = None) -> BrokenPlugin:
        """Return the error for a broken law or method."""
        problem = BrokenPlugin(f"{self.name}: {what}\n{self.remedy}")
        problem.__cause__ = why
        return problem


def is_own(door: EntryPoint) -> bool:
    """Check whether frictionlab itself brings it."""
    return door.dist is not None and door.dist.name == "frictionlab"


def package(door: EntryPoint) -> str:
    """Name and version of the package of an entry point; '' where it is not known."""
    return f"{door.dist.name} {door.dist.version}" if door.dist is not None else ""


def home_of(door: EntryPoint) -> Home:
    """Return the origin of an installed law or method."""
    what = door.group.rpartition(".")[2].removesuffix("s")
    whose = f" of package {package(door)}" if package(door) else ""
    name = door.dist.name if door.dist is not None else "its package"
    return Home(f"{what} '{door.name}'{whose} ({door.value})", f"correct it, or: pip uninstall {name}")


def open_entry_point(doors: Sequence[EntryPoint], kind: type[FrictionLaw] | type[Method]) -> Any:
    """Return the law or method behind the entry points of one name. Raises BrokenPlugin."""
    # a plugin never replaces a law or method of frictionlab
    door, *others = [door for door in doors if is_own(door)] or doors
    if others:
        raise BrokenPlugin(f"{describe_clash(doors)}\nrename one of them, or uninstall it")
    home = home_of(door)
    loaded = _load(door, home)
    if not isinstance(loaded, type):
        raise home.broken(f"is not a class but {shown(loaded)}; its entry point must name the class itself")
    if not issubclass(loaded, kind):
        bases = "SlidingLaw, BristleLaw or MemoryLaw" if kind is FrictionLaw else kind.__name__
        raise home.broken(f"class {loaded.__name__} is not derived from frictionlab.{bases}")
    return check_class(loaded, home)


def describe_clash(doors: Sequence[EntryPoint]) -> str:
    """Return the message that several packages define the same name."""
    owners = " and ".join(f"{package(door) or 'a package'} ({door.value})" for door in doors)
    what = doors[0].group.rpartition(".")[2].removesuffix("s")
    return f"{what} '{doors[0].name}' is defined by {owners}"


def _load(door: EntryPoint, home: Home) -> Any:
    try:
        module = import_module(door.module)
    except (Exception, SystemExit) as problem:
        if isinstance(problem, ModuleNotFoundError) and f"{door.module}.".startswith(f"{problem.name}."):
            raise home.broken(f"does not exist: {problem}", problem) from problem
        raise unloadable(home, problem) from problem
    try:
        return attrgetter(door.attr)(module)
    except AttributeError as problem:
        raise home.broken(f"does not exist: {problem}", problem) from problem


def unloadable(home: Home, problem: BaseException) -> BrokenPlugin:
    """Return the error for a module that cannot be imported."""
    files = outside_files(problem)
    if isinstance(problem, ModuleNotFoundError) and problem.name:
        what = f"needs '{problem.name}', which is not installed{innermost_line(problem, files) or ''}"
        remedy = f"install it, or remove the import: pip install {problem.name.partition('.')[0]}"
        return home._replace(remedy=remedy).broken(what, problem)
    if found := re.match(r"A non-annotated attribute was detected: `(\w+) = (.+?)`", str(problem)):
        name, value = found.groups()
        what = f"{name} = {value} has no type: write {name}: fl.Positive = {value}"
        return home.broken(f"{what}{innermost_line(problem, files) or ''}", problem)
    return home.broken(f"cannot be loaded: {describe_error(problem, files)}", problem)


def check_class(loaded: Any, home: Home) -> Any:
    """Return the class, after a few trial calls. Raises BrokenPlugin."""
    try:
        wrong = next(_faults(loaded), "")
    except Exception as problem:
        said = describe_error(problem, outside_files(problem))
        raise home.broken(f"cannot be checked: {said}", problem) from problem
    if wrong:
        raise home.broken(wrong)
    return loaded


def _faults(loaded: Any) -> Iterator[str]:
    yield from _missing(loaded)
    try:
        read_bibtex(loaded.bibtex)
    except ValueError as problem:
        yield f"its bibtex: {problem}"
    if issubclass(loaded, FrictionLaw) and from_outside(loaded):
        yield from _mutable(loaded)
        yield from _signatures(loaded)
        yield from faults_of_samples(loaded)


def _missing(loaded: Any) -> Iterator[str]:
    if missing := sorted(getattr(loaded, "__abstractmethods__", ())):
        told = ", ".join(f"{name}({', '.join(_names(getattr(loaded, name)))})" for name in missing)
        yield f"class {loaded.__name__} does not define {told}"


def _names(method: Any) -> list[str]:
    return list(inspect.signature(method).parameters)


def _signatures(law: type[FrictionLaw]) -> Iterator[str]:
    """Methods that do not accept the arguments of their interface."""
    for name, interface in overridden_methods(law):
        given, wanted = as_written(inspect.getattr_static(law, name)), _names(interface)
        if not inspect.isfunction(given):
            yield f"{name} must be an ordinary method, {name}({', '.join(wanted)}), not a {type(given).__name__}"
            continue
        try:
            inspect.signature(given).bind(*wanted)
        except TypeError:
            line = definition_line(given.__code__)
            yield f"{name}({', '.join(_names(given))}) must take ({', '.join(wanted)}){line}"


def _mutable(law: type[FrictionLaw]) -> Iterator[str]:
    """Attributes that may change between calls and so change results."""
    for name, field in law.model_fields.items():
        if field.default_factory is not None or isinstance(field.default, list | dict | set):
            default = type(field.default).__name__ if field.default_factory is None else "factory"
            yield f"parameter '{name}' has a mutable default, a {default}; {_FIXED}"
    own = [kind for kind in law.__mro__ if issubclass(kind, FrictionLaw) and from_outside(kind)]
    for kind in own:
        held = [name for name, value in vars(kind).items() if isinstance(value, list | dict | set)]
        for name in [name for name in held if not name.startswith(("_", "model_", "expected_failures"))]:
            yield f"its attribute {name} = {shown(vars(kind)[name])} is mutable; {_FIXED}"
        for name in kind.__private_attributes__:
            yield f"it has a private state, {name}; {_FIXED}"


_FIXED = "a law consists of its parameters only: use numbers, or a tuple of them"
