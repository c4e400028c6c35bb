"""Keys of a study file that say what is asked of its table: everything but scene, laws, methods and sweep."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema, model_validator

from frictionlab.laws.base import Finite, FrictionLaw, Positive, Record
from frictionlab.scene.dimensional import unit_of
from frictionlab.study.expectations import Expectation, NumberSchema, OrText
from frictionlab.study.figure_options import FigureOptions
from frictionlab.study.written import column_of, number_of
from frictionlab.values import columns
from frictionlab.values.notes import Unfit, value_text
from frictionlab.values.units import in_units
from frictionlab.values.validation import checked_value

STUDY_KEYS = (
    *("schema", "title", "source", "scene", "plugins", "laws", "methods", "tolerance", "sweep"),
    *("keep", "columns", "limit", "figures", "boundaries", "data", "free", "expect"),
)
"""Keys of a study file, in the order in which it is written."""
MEASURED = {
    "belt_speed": ("belt_speed_m_per_s", "m/s"),
    "mean_friction": ("mean_friction_N", "N"),
    "sigma": ("sigma_N", "N"),
}
"""Columns of measurements that may have units, each with that in SI units and its unit."""
KINDS_OF_FILE = ".csv", ".tsv", ".txt", ".parquet"
"""Ends of names; those of text may be followed by .gz."""
SLIP_ALONE: dict[str, Any] = {"belt_speed": 1, "slip": {"velocity_amplitude": 1, "frequency": 1}}
"""Scene of a study of slip over time, which needs none: nothing of it is used by a fit."""


def _listed(given: Any) -> Any:
    """One value as a list of it."""
    return given if isinstance(given, list | tuple) else [given]


def _or_alone(made: dict[str, Any]) -> None:
    """Let the JSON schema of a list allow one of its values without brackets."""
    listed = {key: made.pop(key) for key in ("type", "items")}
    made["anyOf"] = [listed["items"], listed]


_Alone = BeforeValidator(_listed), Field(min_length=1, json_schema_extra=_or_alone)
"""Marks of a list of which one value may stand alone."""


def _is_measured(name: str) -> str:
    """Return the name of a file of measurements. Raises ValueError for another end."""
    if not name.removesuffix(".gz").endswith(KINDS_OF_FILE):
        raise ValueError(f"must be a file {', '.join(KINDS_OF_FILE)} (text may be .gz, too)")
    return name


class Keep(Record):
    """Counts of what is written beside the table.

    orbit: samples per period of every orbit, written to orbits.parquet
    attractors: starts followed at every belt speed; all states they end in are written to attractors.csv
    harmonics: harmonics of velocity and friction of every orbit, written to harmonics.csv
    """

    orbit: Annotated[int, Field(strict=True, ge=2)] | None = None
    attractors: Annotated[int, Field(strict=True, ge=1)] | None = None
    harmonics: Annotated[int, Field(strict=True, ge=1)] | None = None


class Limit(Record):
    """Limit of the cost of a point.

    seconds_per_point: seconds that a point may take, compiling left out, until it counts as killed
    """

    seconds_per_point: Positive = 300.0


class DataFiles(Record):
    """Measurements: `frictionlab fit` fits to them, run and check solve at their belt speeds.

    file: a file, or a list of files, .csv, .tsv or .parquet, from the study's folder; text may be .gz
    columns: how the files call our columns, such as {belt_speed: v, mean_friction: mu_bar}
    units: of our columns, of a scene in SI units, such as {belt_speed: mm/s, mean_friction: N}
    """

    file: Annotated[tuple[Annotated[str, AfterValidator(_is_measured)], ...], _Alone[0], _Alone[1]]
    columns: dict[str, str] = Field(default_factory=dict)
    units: dict[str, str] = Field(default_factory=dict)

    def resolved(self) -> dict[str, Any]:
        """Return the entry of a study file."""
        told = self.model_dump(exclude_defaults=True)
        return told | {"file": self.file[0] if len(self.file) == 1 else list(self.file)}


class FreeRange(Record):
    """Range of a number that `frictionlab fit` may change.

    from: least value, here ``low``
    to: largest value, here ``high``
    spacing: how the search is spread over the range; log where left out and the ends are a hundredfold apart
    """

    low: Annotated[Finite, OrText, NumberSchema] = Field(alias="from")
    high: Annotated[Finite, OrText, NumberSchema] = Field(alias="to")
    spacing: Literal["linear", "log"] | None = None

    @model_validator(mode="before")
    @classmethod
    def _ends(cls, given: Any) -> Any:
        if isinstance(given, list | tuple) and len(given) == 2:
            return {"from": given[0], "to": given[1]}
        if not isinstance(given, dict | cls):
            raise ValueError("must be a range such as [0.1, 1.0]")
        return given

    @model_validator(mode="after")
    def _rises(self) -> Self:
        if isinstance(self.low, str) or isinstance(self.high, str):
            return self  # until it is known which unit they must have
        low, high = value_text(self.low), value_text(self.high)
        if self.low >= self.high:
            raise ValueError(f"must rise, got {low} to {high}")
        if self.spacing == "log" and self.low <= 0.0:
            raise ValueError(f"a log range must begin above 0, got {low}")
        return self

    def resolved(self) -> list[float] | dict[str, Any]:
        """Return the entry of a study file."""
        ends = [self.low, self.high]
        return {"from": ends[0], "to": ends[1], "spacing": self.spacing} if self.spacing else ends


ColumnName = Annotated[str, WithJsonSchema({"enum": [*columns.RESULTS, *columns.SI, *columns.GROUPS]})]


class StudyKeys(Record):
    """Study file without scene, laws, methods and sweep.

    title: heading of figures and report
    source: where the scene comes from, such as a paper and its figure
    tolerance: largest absolute error of mean_friction that auto lets pass
    expect: what the table is expected to say; where it does not, run ends with exit code 3
    keep: what to write beside the table
    columns: result columns and groups of them to find, told by `frictionlab columns`; all for every one
    limit: what a point may cost
    figures: how figures are drawn
    boundaries: measures of curves and levels: their lines over the two swept numbers, in boundaries.csv
    data: measurements: `frictionlab fit` fits to them, run and check solve at their belt speeds
    free: ranges of the numbers that `frictionlab fit` may change: of laws by name, of the scene by path
    """

    title: str = ""
    source: str = ""
    tolerance: Positive = 1e-8
    keep: Keep = Keep()
    columns: Annotated[tuple[ColumnName, ...], _Alone[0], _Alone[1]] | None = None
    limit: Limit = Limit()
    figures: FigureOptions = FigureOptions()
    boundaries: dict[str, Annotated[tuple[Finite, ...], _Alone[0], _Alone[1]]] = Field(default_factory=dict)
    data: DataFiles | None = None
    free: dict[str, FreeRange] | None = None
    expect: tuple[Expectation, ...] = ()

    @model_validator(mode="after")
    def _free_of_data(self) -> Self:
        if self.free is not None and self.data is None:
            raise ValueError("free: needs data: the measurements that numbers are fitted to")
        return self


def column_in_si(name: str, unit: str) -> tuple[str, float]:
    """Return the column in SI units of a measured one, and what its numbers in this unit are multiplied by.

    Raises ValueError for a column without a unit, and for a unit that is not one of the column.
    """
    column, wanted = MEASURED.get(name, (column_of(name), None))
    if wanted is None and name.startswith("scene.dimensional."):
        wanted = unit_of(column.rpartition(".")[2])
    if wanted is None:
        raise ValueError(f"has no unit; {', '.join(MEASURED)} and scene.dimensional.<path> may have one")
    factor = in_units(f"1 {unit}", wanted)
    if isinstance(factor, Unfit):
        raise ValueError(factor.what)
    return column, float(factor)


def range_in_numbers(
    name: str, given: FreeRange, laws: Iterable[type[FrictionLaw]], in_si: bool
) -> tuple[FreeRange | None, str | None]:
    """Return the range of a number with texts as numbers, and what is wrong with it; None if nothing is."""
    ends = {
        end: number_of(name, value, laws, in_si) for end, value in (("from", given.low), ("to", given.high))
    }
    spacing = {"spacing": given.spacing} if given.spacing else {}
    read, what, _ = checked_value(StudyKeys, "free", {name: ends | spacing})
    return (None if read is None else read[name]), what


NOT_KEPT, USUAL_LIMIT = Keep(), Limit()
"""Counts that a study keeps, and the cost of a point, where it does not say."""
