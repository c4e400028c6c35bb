"""Grid of a study: every scene, law and method of its sweeps, as the rows and curves of one table."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.scene.scene import Scene, with_values
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.units import Units, scaled_law
from frictionlab.study.axes import (
    FRICTION,
    SCENE,
    Axis,
    GridValue,
    SpeedRange,
    SweepRange,
    axes_of,
    grid_points,
    owner_of,
    places,
    point_at,
)
from frictionlab.study.parts import LawChoice, MethodChoice
from frictionlab.values.notes import Mistake, StudyError
from frictionlab.values.quantities import Written
from frictionlab.values.units import ShownUnit, units_written


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
        """Return the law as methods receive it: in the scene's lengths and times, per unit of its normal load."""
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
    def labels(self) -> tuple[str, str]:
        """Labels of the law and the method: points of equal ones take about as long as each other."""
        return self.law_label, self.method.label

    @property
    def law(self) -> FrictionLaw:
        """Return the law as methods receive it: in the scene's lengths and times, per unit of its normal load."""
        return law_in_scene(self.given_law, self.scenes.scene)


@dataclass(frozen=True, repr=False, kw_only=True)
class StudyGrid:
    """Scenes, laws and methods over the full grid of their sweeps.

    scene: the scene without sweeps. sweep: ``scene.<path>``, ``laws.<label>.<parameter>`` or ``friction`` -> values,
    in a scene words and waveforms, too. links: the paths among them that advance together, which follow one another.
    ranges: those of the sweeps that were given as ranges. chosen: where belt speeds are chosen as a run goes,
    those of each scene. path: the file that says so.
    """

    scene: Scene
    laws: tuple[LawChoice, ...]
    methods: tuple[MethodChoice, ...]
    sweep: dict[str, tuple[GridValue, ...]] = field(default_factory=dict)
    ranges: dict[str, SweepRange | SpeedRange] = field(default_factory=dict)
    links: tuple[tuple[str, ...], ...] = ()
    chosen: tuple[tuple[float, ...], ...] = field(default=(), compare=False)
    path: Path | None = field(default=None, compare=False)

    def cases(self) -> list[StudyCase]:
        """List the cases of the full grid.

        Every law is taken at every value of its sweeps, by every method, in every scene.

        Returns
        -------
        list of StudyCase
            A case for each row of the table, in its order.

        Examples
        --------
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
        """Full grid, a curve at a time: every law at every value of its sweeps, by every method, in every scene.

        In a table the belt speed runs where the study has it among its sweeps.
        """
        first = 0
        for choice in self.laws:
            own = self.own_axes(choice)
            values = [of_law(axis, choice) for axis in own]
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
        ends = list(itertools.accumulate(map(len, self.chosen), initial=0))
        return tuple(
            (Scenes(scene, np.array(speeds, dtype=np.float64)), range(start, start + len(speeds)))
            for scene, speeds, start in zip(built, self.chosen, ends[:-1], strict=True)
        )

    @property
    def chosen_range(self) -> SpeedRange | None:
        """Return the range out of which belt speeds are chosen as a run goes, if they are."""
        return next((each for each in self.ranges.values() if isinstance(each, SpeedRange)), None)

    def with_speeds(self, speeds: Sequence[Iterable[float]]) -> Self:
        """Study with these belt speeds chosen, of one scene after another in the order of ``scenes_along``."""
        return replace(self, chosen=tuple(tuple(each) for each in speeds))

    def foreseen(self) -> Self:
        """Return the study with about as many belt speeds as will be chosen; itself where none are."""
        along = self.chosen_range
        return self if along is None else self.with_speeds([along.about()] * len(self.scenes_along))

    def _impossible(self, problem: ValidationError | OverflowError) -> StudyError:
        what = str(problem)
        if isinstance(problem, ValidationError):
            what = problem.errors(include_url=False)[0]["msg"]
        name = "study" if self.path is None else str(self.path)
        return StudyError([Mistake(name, None, "sweep", f"a point of the grid cannot be built: {what}")])

    def _laws_along(self, choice: LawChoice, own: dict[str, GridValue]) -> list[FrictionLaw]:
        """Law with these values, in every scene of the grid: another one where its values advance with a scene's.

        Raises StudyError where one cannot be built.
        """
        others = [axis for axis in self.scene_axes if axis is not self.speed_axis]
        values, made = [of_law(axis, choice) for axis in others], dict[tuple[Any, ...], FrictionLaw]()
        points = [own | point_at(values, at) for at in places(others)]
        try:
            for point in points:
                if (key := tuple(point.items())) not in made:
                    made[key] = choice.law(point)
        except (ValidationError, OverflowError) as problem:
            raise self._impossible(problem) from None
        return [made[tuple(point.items())] for point in points]

    def laws_in_scenes(self, choice: LawChoice) -> set[FrictionLaw]:
        """Return the different laws that result in the scales and under the normal loads of the scenes."""
        own, found = self.own_axes(choice), set[tuple[FrictionLaw, Units | None, float | None]]()
        for at in places(own):
            laws = self._laws_along(choice, point_at([of_law(axis, choice) for axis in own], at))
            for law, (scenes, _) in zip(laws, self.scenes_along, strict=True):
                si = scenes.scene.dimensional
                found.add((law, None if si is None else si.scales, scenes.scene.normal_load))
        return {_in_scene(*each) for each in found}

    @cached_property
    def in_words(self) -> dict[str, dict[str, str]]:
        """Return what figures call laws and methods, by their labels."""
        return {"law": _told_apart(self.laws), "method": _told_apart(self.methods)}

    @cached_property
    def units(self) -> dict[str, ShownUnit]:
        """Units in which numbers of a scene in SI units and of its laws were written, by columns of the table."""
        values: dict[str, Any] = {f"{SCENE}{path}": each for path, each in self.scene.given_values().items()}
        for law in self.laws:
            values |= {f"law.{name}": value for name, value in law.parameters.items()}
        for path, swept in self.sweep.items():
            name = path if path.startswith(SCENE) else f"law.{path.rpartition('.')[2]}"
            first = self.ranges[path].start if path in self.ranges else swept[0]
            values |= {name: first} if isinstance(first, Written) else {}
        return units_written(values)

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """Return the axes of the grid."""
        return axes_of(self.sweep, self.links)

    @cached_property
    def scene_axes(self) -> tuple[Axis, ...]:
        """Return the axes along which the scene varies."""
        return tuple(axis for axis in self.axes if axis.is_of_scene)

    @cached_property
    def speed_axis(self) -> Axis | None:
        """Return the axis along which belt speed alone varies: that of curves."""
        return next((axis for axis in self.axes if axis.is_of_speed), None)

    def own_axes(self, choice: LawChoice) -> tuple[Axis, ...]:
        """Return the axes along which this law varies, and the scene does not."""
        found = self._places_of_owners.get(f"laws.{choice.label}.", []) + self._places_of_owners.get("", [])
        return tuple(self.axes[place] for place in dict.fromkeys(sorted(found)))

    def swept_parameters(self, choice: LawChoice) -> dict[str, tuple[GridValue, ...]]:
        """Return the values that sweeps give the parameters of a law."""
        return {name: values for axis in self.axes for name, values in of_law(axis, choice).items()}

    @cached_property
    def _places_of_owners(self) -> dict[str, list[int]]:
        """Return the places of the axes that vary ``laws.<label>.``, and not the scene; of '': every law."""
        found: dict[str, list[int]] = {}
        for place, axis in enumerate(self.axes):
            for path in axis.values if not axis.is_of_scene else ():
                found.setdefault(owner_of(path), []).append(place)
        return found


def grid_size(grid: StudyGrid) -> int:
    """Return the number of rows of the table."""
    laws = sum(grid_points(grid.own_axes(law)) for law in grid.laws)
    points = sum(map(len, grid.chosen)) if grid.chosen else grid_points(grid.scene_axes)
    return points * laws * len(grid.methods)


def _told_apart(choices: Sequence[LawChoice | MethodChoice]) -> dict[str, str]:
    """Return the words of each by its label; the label where another has the same words."""
    words = [each.in_words for each in choices]
    return {
        each.label: said if words.count(said) == 1 else each.label
        for each, said in zip(choices, words, strict=True)
    }


def of_law(axis: Axis, choice: LawChoice) -> dict[str, tuple[GridValue, ...]]:
    """Return what varies along an axis of the parameters of a law."""
    found = axis.of(f"laws.{choice.label}.")
    return found | choice.under_friction(axis.values[FRICTION]) if FRICTION in axis.values else found


def _speeds(scene: Scene, along: Axis | None) -> NDArray[np.float64]:
    """Return the belt speeds of an axis, else that of the scene, in the units in which the scene is given."""
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
    if scales is not None:
        law = scaled_law(law, scales)
    else:
        _refuse_units(law)
    return law.under_load(normal_load)


def _refuse_units(law: FrictionLaw) -> None:
    """Raises ValueError for a law with a number that has a unit, which has no meaning in a nondimensional scene."""
    for name, value in law:
        if isinstance(value, Written):
            raise ValueError(
                f"{type(law).__name__}: {name}: {value.text} has a unit, and the scene is nondimensional: give a "
                "number in its scales, or the scene in SI units, fl.Scene.si(...)"
            )
