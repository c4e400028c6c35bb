"""Options of figures: the keys of ``figures`` of a study.

What a study wants level lines of: the key ``boundaries``, and the two swept numbers they are over.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, get_args

from pydantic import Field, StrictBool, model_validator

from frictionlab.laws.base import Record
from frictionlab.study.axes import SCENE, Axis, GridValue, axes_of
from frictionlab.study.grid import StudyGrid, of_law
from frictionlab.study.parts import LawChoice
from frictionlab.study.sweeps import Sweeps
from frictionlab.values.columns import CURVE_MEASURES
from frictionlab.values.notes import Mistake, Notes, WrongValues
from frictionlab.values.quantities import gone

WIDTHS = {"single": 85.0, "double": 175.0}
"""Widths of a journal's column and page [mm]."""
FORMATS = "svg", "png", "pdf"
FigureName = Literal[
    "bifurcation",
    "mean_friction",
    "map",
    "differences",
    "shape",
    "velocity",
    "hysteresis",
    "energies",
    "phase",
    "time_series",
    "velocity_harmonics",
    "friction_harmonics",
]
FIGURE_NAMES: tuple[str, ...] = get_args(FigureName)
"""Every kind of figure, the most telling first."""
EVERY = "all"
"""In place of the mapping: every figure there is, drawn as usual."""


NO_INSET = "closer views are gone: narrow the sweep, or draw the figure of differences"


class FigureOptions(Record):
    """Options of figures.

    normalized: mean over steady sliding friction against belt speed over V_lin
    against: label of the law that others are subtracted from in the figure of differences; Coulomb's where left out,
    else the first
    inset: false; closer views are gone
    width: of a journal's column (single, 85 mm) or page (double, 175 mm); what the figure needs where left out
    formats: of the files; the report shows svg or png
    title: whether the study's title stands above
    shape: a figure of each curve with its chord, the area between them and the verdict
    stick: a pale band along curves wherever the body sticks in part of the period
    all: every figure there is, not the three most telling and what is asked for alone
    finding: the figure that shows what the title says, which is drawn first and alone bears it
    """

    normalized: StrictBool = False
    against: str | None = None
    inset: Annotated[StrictBool, gone(True, NO_INSET)] = False
    width: Literal["single", "double"] | None = None
    formats: Annotated[tuple[Literal["svg", "png", "pdf"], ...], Field(min_length=1)] = ("svg", "png")
    title: StrictBool = True
    shape: StrictBool = False
    stick: StrictBool = False
    all: StrictBool = False
    finding: FigureName | None = None

    @model_validator(mode="before")
    @classmethod
    def _every(cls, given: Any) -> Any:
        return {"all": True} if given == EVERY else given

    @classmethod
    def called(cls) -> str:
        """Return what one would type in Python to give them."""
        return "figures"

    def resolved(self) -> dict[str, Any]:
        """Return the entry of a study file: what differs from the defaults."""
        return self.model_dump(mode="json", exclude_defaults=True)


USUAL_FIGURES = FigureOptions()


def check_against(given: FigureOptions, laws: tuple[str, ...], notes: Notes) -> None:
    """Note a law that is to be subtracted and is none of the study's. laws: their labels."""
    if given.against is not None:
        notes.one_of(given.against, ("figures", "against"), laws)


def figure_options(given: Mapping[str, Any], laws: tuple[str, ...]) -> FigureOptions:
    """Read options from keywords in Python, checked as a study's. laws: the study's labels. Raises WrongValues."""
    read, notes = FigureOptions(**given), Notes()
    check_against(read, laws, notes)
    if notes.all:
        raise WrongValues([Mistake("figures", None, "against", notes.all[0].what, notes.all[0].hint)])
    return read


BOUNDARIES_KEY = "boundaries"
_NEEDED = "needs the belt speed and two numbers swept"


def check_boundaries(given: Mapping[str, Any], sweeps: Sweeps, notes: Notes) -> None:
    """Note measures that no curve has, and sweeps over which there are no lines."""
    notes.mapping(given, (BOUNDARIES_KEY,), CURVE_MEASURES)
    axes = axes_of(sweeps.sweep, sweeps.links)
    speeds = [axis for axis in axes if axis.is_of_speed]
    if given and (len(speeds) != 1 or len(axes) != 3 or not all(map(_is_number, axes))):
        notes.add((BOUNDARIES_KEY,), f"{_NEEDED}; swept here: {', '.join(sweeps.sweep) or 'nothing'}")


def swept_numbers(study: StudyGrid) -> tuple[Axis, Axis]:
    """Return the two axes of a study that has boundaries beside that of belt speed."""
    one, other = (axis for axis in study.axes if not axis.is_of_speed)
    return one, other


def columns_swept(axis: Axis, law: LawChoice) -> dict[str, tuple[GridValue, ...]]:
    """Return the columns of the table that have numbers of an axis in the rows of a law, and these numbers."""
    own = [(SCENE, axis.of(SCENE)), ("law.", of_law(axis, law))]
    return {f"{owner}{name}": values for owner, found in own for name, values in found.items()}


def _is_number(axis: Axis) -> bool:
    different = all(len(set(values)) == len(axis) for values in axis.values.values())
    numbers = all(isinstance(value, float | int) for values in axis.values.values() for value in values)
    return axis.is_of_speed or (numbers and different and len(axis) > 1)
