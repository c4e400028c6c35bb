"""The record of a study: frozen, complete, with every default filled in."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from frictionlab import columns, registry
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.mistakes.notes import Mistake, StudyError, number_text
from frictionlab.registry.law_file import LawFile
from frictionlab.scene.scene import Scene, with_values
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.units import Units, scaled_law
from frictionlab.scene.waveforms import Form
from frictionlab.study.axes import (
    FRICTION,
    LINKED,
    SCENE,
    STATIC,
    Axis,
    GridValue,
    axes_of,
    grid_points,
    owner_of,
    places,
    point_at,
)
from frictionlab.study.figure_options import USUAL_FIGURES, FigureOptions
from frictionlab.study.ranges import SpeedRange, SweepRange
from frictionlab.study.yaml_text import yaml_text

SCHEMA = 1
LAW_COPIES = "laws"
"""The folder in which a run keeps the files of laws it used."""
LIMIT_KEY = "seconds_per_point"
SECONDS_PER_POINT = 300.0
"""The time [s] that a point may take where a study does not say."""


@dataclass(frozen=True)
class LawChoice:
    """A law of the study under its label; parameters as given, with the law's defaults."""

    label: str
    kind: str
    parameters: dict[str, Any]
    law_class: type[FrictionLaw] = field(compare=False, repr=False)

    def law(self, values: Mapping[str, GridValue] | None = None) -> FrictionLaw:
        """The law, with some parameters replaced by these values."""
        return self.law_class.model_validate(self.parameters | dict(values or {}))

    def under_friction(self, coefficients: tuple[GridValue, ...]) -> dict[str, tuple[GridValue, ...]]:
        """The parameters of the law that has these friction coefficients, ``mu_static`` in the ratio it has."""
        name = coefficient_of(self.law_class)
        given, static = self.parameters[name], self.parameters.get(STATIC)
        if static is None:
            return {name: coefficients}
        numbers = [each for each in coefficients if isinstance(each, float)]
        ratio = static / given
        return {
            name: coefficients,
            STATIC: tuple(static if mu == given else mu * ratio for mu in numbers),
        }

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        label = {} if self.label == self.kind else {"label": self.label}
        return {"kind": self.kind, **_natural(self.parameters), **label}


def coefficient_of(law: type[FrictionLaw]) -> str:
    """The name of the parameter that is the friction coefficient of sliding: mu or mu_kinetic; '' without one."""
    return next((name for name in ("mu", "mu_kinetic") if name in law.model_fields), "")


@dataclass(frozen=True)
class MethodChoice:
    """A method of the study under its label; its class is imported when ``method`` is first used."""

    label: str
    name: str
    parameters: dict[str, Any]

    @classmethod
    def of(cls, method: Method) -> MethodChoice:
        """The choice of a method that is there already."""
        choice = cls(method.name, method.name, {})
        vars(choice)["method"] = method
        return choice

    @cached_property
    def method(self) -> Method:
        """The method with its parameters."""
        return registry.method_class(self.name).model_validate(self.parameters)

    def resolved(self) -> str | dict[str, Any]:
        """The entry of a study file: the name alone if it has neither parameters nor a label."""
        if self.label == self.name and not self.parameters:
            return self.name
        label = {} if self.label == self.name else {"label": self.label}
        return {"kind": self.name, **_natural(self.parameters), **label}


@dataclass(frozen=True)
class Expectation:
    """A claim of a study about its table; exactly one of the six comparisons is set.

    where: input column -> value, selects the rows. equals (needs within), below, above: of ``column``.
    status: of those rows. max_difference: two method labels whose mean_friction differs by under ``below``.
    shape: of the curves those rows make, by ``measure``.
    """

    where: dict[str, str | float]
    column: str | None = None
    equals: float | None = None
    below: float | None = None
    above: float | None = None
    within: float | None = None
    status: str | None = None
    max_difference: tuple[str, str] | None = None
    shape: str | None = None
    measure: str | None = None
    because: str = ""

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        said = {
            name: _natural(value) for name, value in vars(self).items() if value is not None and value != ""
        }
        if self.max_difference:
            said["max_difference"] = list(self.max_difference)
        return said


@dataclass(frozen=True)
class StudyCase:
    """One row of the table: a scene, a law and a method, independent of every other row.

    given_law: in SI units if the scene is.
    """

    law_label: str
    kind: str
    given_law: FrictionLaw
    method_label: str
    method: Method
    scene: Scene

    @property
    def law(self) -> FrictionLaw:
        """The law as methods receive it: in the scene's lengths and times, per unit of its normal load."""
        return law_in_scene(self.given_law, self.scene)


@dataclass(frozen=True)
class StudyCurve:
    """Rows of the table that differ in belt speed alone: one scene along its belt speeds, a law and a method.

    rows: that of each belt speed. given_law: in SI units if the scene is.
    """

    law_label: str
    kind: str
    given_law: FrictionLaw
    method: MethodChoice
    scenes: Scenes
    rows: range

    @property
    def law(self) -> FrictionLaw:
        """The law as methods receive it: in the scene's lengths and times, per unit of its normal load."""
        return law_in_scene(self.given_law, self.scenes.scene)


@dataclass(frozen=True, repr=False)
class Study:
    """Scenes, laws and methods, their full grid, and the expectations of the table.

    scene: the scene without sweeps. sweep: ``scene.<path>``, ``laws.<label>.<parameter>`` or ``friction`` -> values,
    in a scene words and waveforms, too. links: the paths among them that advance together, which follow one another.
    ranges: those of the sweeps that were given as ranges. chosen: where belt speeds are chosen as a run goes,
    those of each scene.
    tolerance: absolute, on mean_friction [-]. keep_orbit: samples per period to keep, None for none.
    keep_attractors: starts a point from which every state is looked for, None for none. keep_harmonics: the highest
    harmonic of velocity and friction to keep, None for none.
    columns: result columns asked for, None for all. seconds_per_point: the time a point may take [s].
    figures: how they are drawn. plugins: its law files. code: SHA-256 of every law that is not frictionlab's own.
    ``Study.of`` makes one of Python objects, ``fl.run`` solves it.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
    >>> fl.Study.of(scene, fl.Coulomb(mu=0.4))
    Study.of(Scene(belt_speed=1, slip=Slip(velocity_amplitude=2, frequency=1)), Coulomb(mu=0.4))
    >>> study = fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep={"scene.belt_speed": [1, 2]})
    >>> fl.run(study)
    Run(2 points: 2 ok)
    """

    scene: Scene
    laws: tuple[LawChoice, ...]
    methods: tuple[MethodChoice, ...]
    tolerance: float
    sweep: dict[str, tuple[GridValue, ...]] = field(default_factory=dict)
    expect: tuple[Expectation, ...] = ()
    keep_orbit: int | None = None
    keep_attractors: int | None = None
    keep_harmonics: int | None = None
    columns: tuple[str, ...] | None = None
    seconds_per_point: float = SECONDS_PER_POINT
    figures: FigureOptions = USUAL_FIGURES
    title: str = ""
    source: str = ""
    plugins: tuple[LawFile, ...] = ()
    code: dict[str, str] = field(default_factory=dict)
    ranges: dict[str, SweepRange | SpeedRange] = field(default_factory=dict)
    links: tuple[tuple[str, ...], ...] = ()
    chosen: tuple[tuple[float, ...], ...] = field(default=(), compare=False)
    path: Path | None = field(default=None, compare=False)

    @classmethod
    def of(
        cls,
        scene: Scene,
        laws: Any,
        methods: Any = "auto",
        sweep: Mapping[str, Any] | None = None,
        **told: Any,
    ) -> Study:
        """The study of Python objects.

        laws: a friction law, several, of which two of one kind need a ``label=``, or a mapping label -> law.
        methods: likewise, names or methods. sweep: ``scene.<path>`` or ``laws.<label>.<parameter>`` -> values.
        told: the other keys of a study file, such as ``tolerance=1e-6``, ``title=``, ``keep={"orbit": 200}``.

        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> study = fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep={"scene.belt_speed": [5, 25]})
        >>> len(study.cases())
        2

        Raises StudyError with every mistake, TypeError for what is no scene, law or method.
        """
        from frictionlab.study.objects import study_of_objects  # which reads it as a file is read

        return study_of_objects(scene, laws, methods, sweep, **told)

    def __repr__(self) -> str:
        """What one would type to make it of objects; of long lists the ends."""
        from frictionlab.study.objects import study_as_typed

        return study_as_typed(self)

    def to_yaml(self) -> str:
        """The study as a study file that loads to an equal study; law files of its own have to lie beside it.

        >>> import frictionlab as fl
        >>> scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
        >>> print(fl.Study.of(scene, fl.Coulomb(mu=0.4)).to_yaml().rstrip())
        schema: 1
        scene: {normal_load: 1, belt_speed: 1, slip: {velocity_amplitude: 2, frequency: 1, phase: 0}}
        laws: [{kind: coulomb, mu: 0.4}]
        methods: [auto]
        tolerance: 1.0e-08
        """
        return yaml_text(self.resolved())

    def cases(self) -> list[StudyCase]:
        """The full grid, a case a row: every law at every value of its sweeps, by every method, in every scene.

        >>> import frictionlab as fl
        >>> scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
        >>> study = fl.Study.of(scene, fl.Coulomb(mu=0.4), ["auto", "march"], {"scene.belt_speed": [1, 2]})
        >>> [(case.method_label, case.scene.belt_speed) for case in study.cases()]
        [('auto', 1.0), ('auto', 2.0), ('march', 1.0), ('march', 2.0)]
        """
        found = {
            row: StudyCase(
                each.law_label, each.kind, each.given_law, each.method.label, each.method.method, scene
            )
            for each in self.curves()
            for row, scene in zip(each.rows, each.scenes, strict=True)
        }
        return [found[row] for row in range(len(found))]

    def curves(self) -> Iterator[StudyCurve]:
        """The full grid, a curve at a time: every law at every value of its sweeps, by every method, in every scene.

        In a table the belt speed runs where the study has it among its sweeps.
        """
        first = 0
        for choice in self.laws:
            own = self.own_axes(choice)
            values = [_of_law(axis, choice) for axis in own]
            for at, method in itertools.product(places(own), self.methods):
                laws = self._laws_along(choice, point_at(values, at))
                for (scenes, rows), law in zip(self.scenes_along, laws, strict=True):
                    shifted = range(first + rows.start, first + rows.stop, rows.step)
                    yield StudyCurve(choice.label, choice.kind, law, method, scenes, shifted)
                first += sum(len(rows) for _, rows in self.scenes_along)

    @cached_property
    def scenes_along(self) -> tuple[tuple[Scenes, range], ...]:
        """Every scene of the grid along its belt speeds, with their places among the rows of one law and method.

        The last sweep runs fastest. Raises StudyError where one cannot be built.
        """
        axes, along = self.scene_axes, self.speed_axis
        others, top = [axis for axis in axes if axis is not along], dict[str, GridValue]()
        if along is not None:  # of the belt speeds the largest: where that makes a scene, all do
            speeds = _speeds(self.scene, along)
            top = dict.fromkeys(along.of(SCENE), float(speeds[np.argmax(np.abs(speeds))]))
        values, tree = [axis.of(SCENE) for axis in others], self.scene.given()
        try:
            points = (point_at(values, at) | top for at in places(others))
            built = [Scene.model_validate(with_values(tree, point)) for point in points]
        except (ValidationError, OverflowError) as problem:
            raise self._impossible(problem) from None
        if self.chosen:
            return self._along_chosen(built)
        within = grid_points(axes[axes.index(along) + 1 :]) if along else 1
        block = within * (len(along) if along else 1)
        starts = [at // within * block + at % within for at in range(len(built))]
        return tuple(
            (Scenes(scene, _speeds(scene, along)), range(start, start + block, within))
            for scene, start in zip(built, starts, strict=True)
        )

    def _along_chosen(self, built: list[Scene]) -> tuple[tuple[Scenes, range], ...]:
        assert self.chosen_range is not None
        known = np.array(self.chosen_range.known())
        ends = list(itertools.accumulate(map(len, self.chosen), initial=0))
        return tuple(
            (Scenes(scene, np.array(speeds, dtype=np.float64), known), range(start, start + len(speeds)))
            for scene, speeds, start in zip(built, self.chosen, ends[:-1], strict=True)
        )

    @property
    def chosen_range(self) -> SpeedRange | None:
        """The range out of which belt speeds are chosen as a run goes, if they are."""
        return next((each for each in self.ranges.values() if isinstance(each, SpeedRange)), None)

    def with_speeds(self, speeds: Sequence[Iterable[float]]) -> Study:
        """The study with these belt speeds chosen, of one scene after another in the order of ``scenes_along``."""
        return replace(self, chosen=tuple(tuple(each) for each in speeds))

    def foreseen(self) -> Study:
        """The study with about as many belt speeds as will be chosen; itself where none are."""
        along = self.chosen_range
        return self if along is None else self.with_speeds([along.about()] * len(self.scenes_along))

    def _impossible(self, problem: ValidationError | OverflowError) -> StudyError:
        what = str(problem)
        if isinstance(problem, ValidationError):
            what = problem.errors(include_url=False)[0]["msg"]
        name = "study" if self.path is None else str(self.path)
        return StudyError([Mistake(name, None, "sweep", f"a point of the grid cannot be built: {what}")])

    def _laws_along(self, choice: LawChoice, own: dict[str, GridValue]) -> list[FrictionLaw]:
        """The law with these values, in every scene of the grid: another one where its values advance with a scene's.

        Raises StudyError where one cannot be built.
        """
        others = [axis for axis in self.scene_axes if axis is not self.speed_axis]
        values, made = [_of_law(axis, choice) for axis in others], dict[tuple[Any, ...], FrictionLaw]()
        points = [own | point_at(values, at) for at in places(others)]
        try:
            for point in points:
                if (key := tuple(point.items())) not in made:
                    made[key] = choice.law(point)
        except (ValidationError, OverflowError) as problem:
            raise self._impossible(problem) from None
        return [made[tuple(point.items())] for point in points]

    def laws_in_scenes(self, choice: LawChoice) -> set[FrictionLaw]:
        """The different laws that result in the scales and under the normal loads of the scenes."""
        own, found = self.own_axes(choice), set[tuple[FrictionLaw, Units | None, float | None]]()
        for at in places(own):
            laws = self._laws_along(choice, point_at([_of_law(axis, choice) for axis in own], at))
            for law, (scenes, _) in zip(laws, self.scenes_along, strict=True):
                si = scenes.scene.dimensional
                found.add((law, None if si is None else si.scales, scenes.scene.normal_load))
        return {_in_scene(*each) for each in found}

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """The axes of the grid."""
        return axes_of(self.sweep, self.links)

    @cached_property
    def scene_axes(self) -> tuple[Axis, ...]:
        """Those along which the scene varies."""
        return tuple(axis for axis in self.axes if axis.is_of_scene)

    @cached_property
    def speed_axis(self) -> Axis | None:
        """That along which belt speed alone varies: of curves."""
        alone = [axis for axis in self.axes if len(axis.values) == 1]
        return next((axis for axis in alone if not axis.values.keys().isdisjoint(columns.BELT_SPEEDS)), None)

    def own_axes(self, choice: LawChoice) -> tuple[Axis, ...]:
        """Those along which this law varies, and the scene does not."""
        found = self._places_of_owners.get(f"laws.{choice.label}.", []) + self._places_of_owners.get("", [])
        return tuple(self.axes[place] for place in dict.fromkeys(sorted(found)))

    def swept_parameters(self, choice: LawChoice) -> dict[str, tuple[GridValue, ...]]:
        """The values that sweeps give the parameters of a law."""
        return {name: values for axis in self.axes for name, values in _of_law(axis, choice).items()}

    @cached_property
    def _places_of_owners(self) -> dict[str, list[int]]:
        """Which axes, apart from those of the scene, vary ``laws.<label>.``; of '': every law."""
        found: dict[str, list[int]] = {}
        for place, axis in enumerate(self.axes):
            for path in axis.values if not axis.is_of_scene else ():
                found.setdefault(owner_of(path), []).append(place)
        return found

    def resolved(self) -> dict[str, Any]:
        """The study as plain values; with its ``law_texts`` beside it they load to an equal study."""
        words = {"title": self.title, "source": self.source}
        told: dict[str, Any] = {"schema": SCHEMA, **{key: text for key, text in words.items() if text}}
        told["scene"] = _natural(self.scene.given())
        if self.plugins:
            told["plugins"] = list(self.law_texts())
        told["laws"] = [law.resolved() for law in self.laws]
        told["methods"] = [method.resolved() for method in self.methods]
        told["tolerance"] = self.tolerance
        if self.sweep:
            told["sweep"] = self._told_sweep()
        keep = {
            "orbit": self.keep_orbit,
            "attractors": self.keep_attractors,
            "harmonics": self.keep_harmonics,
        }
        if kept := {name: count for name, count in keep.items() if count is not None}:
            told["keep"] = kept
        if self.columns is not None:
            told["columns"] = list(self.columns)
        if self.seconds_per_point != SECONDS_PER_POINT:
            told["limit"] = {LIMIT_KEY: self.seconds_per_point}
        if figures := self.figures.resolved():
            told["figures"] = figures
        if self.expect:
            told["expect"] = [expectation.resolved() for expectation in self.expect]
        return told

    def _told_sweep(self) -> dict[str, Any]:
        told: dict[str, Any] = {}
        for axis in self.axes:
            values = {
                path: _natural(self.ranges[path].resolved() if path in self.ranges else list(values))
                for path, values in axis.values.items()
            }
            if tuple(values) in self.links:
                told.setdefault(LINKED, []).append(values)
            else:
                told |= values
        return told

    def selected(self) -> frozenset[str]:
        """The result columns of its table: those asked for, those of every table and those that ``expect`` judges."""
        if self.columns is None:
            return columns.selected(None)
        judged = [each.column for each in self.expect if each.column is not None]
        of_shape = columns.OF_SHAPE if any(each.shape is not None for each in self.expect) else ()
        return columns.selected([*self.columns, *judged, *of_shape])

    def law_texts(self) -> dict[str, str]:
        """The files of laws, by the names under which a run keeps copies of them."""
        found: dict[str, str] = {}
        for file in self.plugins:
            stem = f"{LAW_COPIES}/{file.path.stem}"
            others = (f"{stem}_{number}.py" for number in itertools.count(2))
            names = itertools.chain([f"{stem}.py"], others)
            found[next(name for name in names if name not in found)] = file.text
        return found

    def digest(self) -> str:
        """SHA-256 of what determines the numbers: scene, laws, methods, tolerance and sweep, nothing else."""
        swept = {path.removeprefix("scene.") for path in self.sweep}
        numbers = {
            "scene": {path: value for path, value in self.scene.given_values().items() if path not in swept},
            "laws": [[law.label, law.kind, self._fixed(law)] for law in self.laws],
            "methods": [[method.label, method.name, method.parameters] for method in self.methods],
            "tolerance": self.tolerance,
            "sweep": {path: self._swept(path) for path in self.sweep},
            **({"code": self.code} if self.code else {}),
            **({"links": [list(entry) for entry in self.links]} if self.links else {}),
        }
        if FRICTION in self.sweep:
            under = {law.label: law.under_friction(self.sweep[FRICTION]) for law in self.laws}
            numbers["friction"] = [[label, list(map(list, each.values()))] for label, each in under.items()]
        return hashlib.sha256(json.dumps(_natural(numbers), sort_keys=True).encode()).hexdigest()

    def _swept(self, path: str) -> Any:
        along = self.ranges.get(path)
        return along.resolved() if isinstance(along, SpeedRange) else list(self.sweep[path])

    def _fixed(self, law: LawChoice) -> dict[str, Any]:
        swept = self.swept_parameters(law)
        return {name: v for name, v in law.parameters.items() if name not in swept}


def _of_law(axis: Axis, choice: LawChoice) -> dict[str, tuple[GridValue, ...]]:
    """What varies along an axis of the parameters of a law."""
    found = axis.of(f"laws.{choice.label}.")
    return found | choice.under_friction(axis.values[FRICTION]) if FRICTION in axis.values else found


def _speeds(scene: Scene, along: Axis | None) -> NDArray[np.float64]:
    """The belt speeds of an axis, else that of the scene, in the units in which the scene is given."""
    si = scene.dimensional
    own: tuple[GridValue, ...] = (scene.belt_speed if si is None else si.belt_speed_m_per_s,)
    return np.array(own if along is None else next(iter(along.values.values())), dtype=np.float64)


def law_in_scene(law: FrictionLaw, scene: Scene) -> FrictionLaw:
    """A law in the lengths and times of a scene, per unit of its normal load."""
    si = scene.dimensional
    return _in_scene(law, None if si is None else si.scales, scene.normal_load)


def _in_scene(law: FrictionLaw, scales: Units | None, normal_load: float | None) -> FrictionLaw:
    """A law converted to these scales and to unit normal load."""
    assert normal_load is not None  # every valid scene has one
    scaled = law if scales is None else scaled_law(law, scales)
    return scaled.under_load(normal_load)


def _natural(value: Any) -> Any:
    """The value with whole floats as integers, as a person would write them (and -0.0 as 0)."""
    if isinstance(value, dict):
        return {key: _natural(item) for key, item in value.items()}
    if isinstance(value, Form):
        return _natural(value.plain())
    if isinstance(value, list):
        return [_natural(item) for item in value]
    if isinstance(value, float) and "." not in (text := number_text(value)) and "e" not in text:
        return int(text)
    return value
