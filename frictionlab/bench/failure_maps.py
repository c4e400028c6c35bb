"""Failure maps: belt speed against one other number of a scene or law, and what theory and references say of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Annotated, Any, NamedTuple

import numpy as np
import pandas as pd
from pydantic import model_validator

from frictionlab.bench.blocks import OwnBlock
from frictionlab.bench.charts import FailurePicture
from frictionlab.bench.contenders import FILLED, Contender, ReferenceSource, built
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.solve import known_means, solve_points
from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.axes import GridValue
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.rest import can_hold, friction_at_rest, is_unique
from frictionlab.values.columns import BELT_SPEEDS, word
from frictionlab.values.quantities import Finite, Floats, Record

OF_FRICTION_TO_LOAD = ("scene.normal_load", "scene.drive.amplitude", "scene.drive.unbalance")
"""Quantities that are drawn as friction over load."""
PEER_MARGIN = 10.0
MOTION = ("stick_fraction", "reversals")
_HALVINGS = 30
"""Parts of the interval between two values of the grid in which an edge lies."""


class NamedPoint(Record):
    """A point of a map with a name: its belt speed [scene velocity] and the value of the other quantity."""

    name: Annotated[str, FILLED]
    belt_speed: Finite
    value: Finite


class MapRow(NamedTuple):
    """Scenes of a map that differ in belt speed alone, at a value of the other quantity; name: of a named point."""

    value: float
    scenes: Scenes
    law: FrictionLaw
    name: str = ""

    @property
    def friction_to_load(self) -> float:
        """Largest friction at rest over the amplitude of the load along the belt; NaN where nothing loads a mass."""
        scene = self.scenes.scene
        if scene.degrees_of_freedom == 0 or not (mass := scene.mass()).force:
            return math.nan
        return friction_at_rest(self.law) * mass.normal_load / abs(mass.force)


class FailureMap(OwnBlock):
    """An item of ``failures``: a grid of scenes, belt speed along, another quantity across, and named points."""

    points: Annotated[tuple[dict[str, Any], ...], FILLED] = ()

    @model_validator(mode="after")
    def _is_a_map(self) -> FailureMap:
        if several := [each for each in self.contenders if len(each.settings) > 1]:
            told = f"'{several[0].label}': a map takes one setting; give each a label of its own"
            raise ValueError(f"{several[0].side}s: {told}")
        if len(self.study.laws) != 1:
            raise ValueError(f"laws: a map has one law, got {len(self.study.laws)}")
        others = [values for name, values in self.study.sweep.items() if name not in BELT_SPEEDS]
        plain = all(isinstance(value, float | int) for values in others for value in values)
        if len(self.study.sweep) != 2 or len(others) != 1 or not plain:
            raise ValueError("sweep: a map sweeps the belt speed and one other number")
        _ = self.named_points
        return self

    @cached_property
    def paths(self) -> tuple[str, str]:
        """Return the path of the belt speed and that of the other quantity."""
        one, other = self.study.sweep
        return (one, other) if one in BELT_SPEEDS else (other, one)

    @cached_property
    def named_points(self) -> list[NamedPoint]:
        """``[{name: S2, scene.belt_speed: 0.5, scene.normal_load: 10}]``."""
        found, keys = [], ("name", *self.paths)
        for index, item in enumerate(self.points):
            if item.keys() != {*keys}:
                raise ValueError(f"points[{index}]: give {', '.join(keys)}, no other keys")
            told = dict(zip(NamedPoint.model_fields, map(item.get, keys), strict=True))
            found.append(built(NamedPoint, told))
        return found

    def _swept(self, path: str) -> Floats:
        return np.sort(np.array(self.study.sweep[path], dtype=np.float64))

    @cached_property
    def grid_rows(self) -> list[MapRow]:
        """Return the grid, a row for each value, which ascend. Raises StudyError where one cannot be built."""
        speeds, values = map(self._swept, self.paths)
        return [self.row(value, speeds) for value in values.tolist()]

    @cached_property
    def rows(self) -> list[MapRow]:
        """Return the rows of the grid, and one of a single scene for each named point."""
        named = (self.row(each.value, [each.belt_speed], each.name) for each in self.named_points)
        return [*self.grid_rows, *named]

    def row(self, value: float, speeds: Sequence[float] | Floats, name: str = "") -> MapRow:
        """Return the scenes at any value and belt speeds."""
        along = tuple(float(speed) for speed in speeds)
        sweep: dict[str, tuple[GridValue, ...]] = dict(zip(self.paths, (along, (value,)), strict=True))
        (curve,) = replace(self.study, sweep=sweep, ranges={}).curves()
        return MapRow(value, curve.scenes, curve.law, name)

    def ordinate(self, row: MapRow) -> float:
        """Return what a row is drawn at: its value, or friction over load where the quantity makes that vary."""
        return row.friction_to_load if self.paths[1] in OF_FRICTION_TO_LOAD else row.value

    # --- what a solver says of it ---------------------------------------------------------------------------------

    def _of_rows(self, found: Callable[[MapRow], pd.DataFrame]) -> pd.DataFrame:
        return pd.concat([found(row) for row in self.rows], ignore_index=True)

    @cached_property
    def places(self) -> pd.DataFrame:
        """Every point, those of the grid first."""

        def told(row: MapRow) -> pd.DataFrame:
            found: dict[str, Any] = {"map": self.name, "quantity": self.paths[1]}
            found |= {"belt_speed": row.scenes.belt_speeds, "value": row.value}
            found |= {"friction_to_load": row.friction_to_load, "ordinate": self.ordinate(row)}
            return pd.DataFrame(found | {"point": row.name})

        return self._of_rows(told)

    @cached_property
    def known(self) -> list[tuple[ReferenceSource, pd.DataFrame]]:
        """Return what every reference says of every point, the first method with the columns of ``MOTION``."""
        first = next((each for each in self.references if not isinstance(each.solver, Peer)), None)
        return [(each, self._known(each, MOTION if each is first else ())) for each in self.references]

    def _known(self, reference: ReferenceSource, more: Sequence[str]) -> pd.DataFrame:
        return self._of_rows(lambda row: known_means(reference, row.scenes, row.law, more))

    def measured(self, contender: Contender) -> pd.DataFrame:
        """Return what this solver says of every point, and how far that is from the first reference of another kind.

        ``silent`` is a number that is wrong without a word: for a method its true error is above the error it states,
        for a peer above ten times the tolerance asked, each with the reference's own error added.
        """
        (setting,) = contender.settings
        solver, asked = setting.solver, setting.tolerance
        found = self._of_rows(lambda row: solve_points(solver, row.scenes, row.law, asked))
        trusted, ok = self._trusted(contender.kind), found["status"] == "ok"
        off, stated = (found["mean"] - trusted["mean"]).abs().where(ok), found["error"].where(ok)
        claimed = stated if contender.side == "method" else PEER_MARGIN * asked
        told = {"outcome": found["status"].mask(off > claimed + trusted["error"], "silent")}
        told |= {"reason": found["reason"], "stated_error": stated, "true_error": off}
        told |= {"reference": trusted["reference"], "reference_error": trusted["error"]}
        return self.places.drop(columns="point").assign(**told, point=self.places["point"])

    def _trusted(self, kind: str) -> pd.DataFrame:
        """At each point the first reference not made by this kind of solver that has an answer there."""
        found = self.places[[]].assign(reference="", mean=math.nan, error=math.nan)
        for reference, known in reversed(self.known):
            if reference.kind != kind:
                there = known["mean"].notna()
                found.loc[there, ["mean", "error"]] = known.loc[there, ["mean", "error"]]
                found.loc[there, "reference"] = reference.label
        return found

    # --- what is drawn --------------------------------------------------------------------------------------------

    def picture(self, table: pd.DataFrame) -> FailurePicture:
        """Return the map with the points of a solver."""
        ordinates = np.array([self.ordinate(row) for row in self.grid_rows])
        rising, x = np.argsort(ordinates), self.grid_rows[0].scenes.belt_speeds
        grid = table[table["point"] == ""].sort_values("ordinate", kind="stable")
        found = {name: where.reshape(-1, len(x))[rising] for name, where in self.motions().items()}
        named, y, free = table[table["point"] != ""], ordinates[rising], self.free_velocities()[rising]
        return FailurePicture(self.name, self._across(), x, y, grid, named, free, self.edges(), found)

    def _across(self) -> str:
        quantity = self.paths[1]
        if quantity in OF_FRICTION_TO_LOAD:
            return "friction over load"
        kind, _, parameter = quantity.rpartition(".")
        return word(f"law.{parameter}" if kind.startswith("laws.") else quantity, 22)

    def motions(self) -> dict[str, Floats]:
        """Find where slip reverses or sticks, and where the mass sticks, by the first method of references.

        1 or 0, NaN where that is not known.
        """
        for found in (found for _, found in self.known if MOTION[0] in found):
            stick, turns = (found.loc[self.places["point"] == "", name].to_numpy() for name in MOTION)
            turning = np.where(np.isnan(turns), np.nan, (stick > 0.0) | (turns > 0.0))
            sticking = np.where(np.isnan(stick), np.nan, stick > 0.0)
            return {"end of reversal": turning, "stick window": sticking}
        return {}

    def free_velocities(self) -> Floats:
        """V_lin at every value of the map; infinite where the friction-free motion has no bound."""
        return np.array([friction_free_velocity(row.scenes[0], row.law) for row in self.grid_rows])

    def edges(self) -> dict[str, list[float]]:
        """Return the ordinates at which a condition on the other quantity alone changes.

        Theorem T1 proves that the steady state is the only one and attracts every start; static friction can hold the
        mass against the load on a belt at rest.
        """
        conditions = {"one steady state proved: edge": is_unique, "friction holds the load: edge": can_hold}
        return {name: [*self._changes(condition)] for name, condition in conditions.items()}

    def _changes(self, condition: Callable[[Scene, FrictionLaw], bool]) -> Iterator[float]:
        speed = self.grid_rows[0].scenes.belt_speeds[-1:]

        def true(value: float) -> bool:
            row = self.row(value, speed)
            return condition(row.scenes[0], row.law)

        for one, other in pairwise(self.grid_rows):
            low, high = one.value, other.value
            if (at_low := true(low)) != true(high):
                for _ in range(_HALVINGS):
                    middle = math.sqrt(low * high) if low > 0.0 else 0.5 * (low + high)
                    low, high = (middle, high) if true(middle) == at_low else (low, middle)
                yield self.ordinate(self.row(low, speed))
