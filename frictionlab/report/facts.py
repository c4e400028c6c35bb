"""Facts for sentences and tables of a page: a run, and what is read from its tables once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import pandas as pd
from markupsafe import Markup

from frictionlab.report.sources import Cited, sources
from frictionlab.report.tables import Cell, settings
from frictionlab.runner.pairs import Difference, method_pairs
from frictionlab.runner.results import Results
from frictionlab.runner.table import swept_inputs
from frictionlab.values.columns import belt_speed, shown_column
from frictionlab.values.units import as_shown

if TYPE_CHECKING:
    from frictionlab.charts.figures import FigureData


class CurveRows(NamedTuple):
    """Rows of one law and method that differ in belt speed alone.

    where: what else was swept, and its value. table, places: where the rows are; no curve of many holds them itself.
    """

    law: str
    method: str
    where: Mapping[str, Any]
    table: pd.DataFrame
    places: list[int]

    @property
    def rows(self) -> pd.DataFrame:
        """Return all of them."""
        return self.table.iloc[self.places]

    @property
    def row(self) -> pd.Series:
        """Return the first of them."""
        return self.table.iloc[self.places[0]]

    def measure(self, name: str) -> tuple[Any, Any]:
        """A number of the first of them with its error, in the units in which it is shown; text with 0."""
        column, error = (shown_column(self.table.columns, each) for each in (name, f"{name}_error"))
        return self.row[column], self.row.get(error, 0.0)

    @property
    def of(self) -> tuple[str, ...]:
        """Return the law and the values, which curves by other methods have, too."""
        return self.law, *map(str, self.where.values())

    @property
    def name(self) -> Markup:
        """Name what tells the curve from the others of its law and method."""
        return settings(self.where)


@dataclass(frozen=True, eq=False)
class Facts:
    """A run, and what is read from its tables once. drawn: what its figures were drawn of."""

    saved: Results
    drawn: FigureData | None = None

    @cached_property
    def table(self) -> pd.DataFrame:
        """Return the result table, in the units in which it is shown, laws and methods in words."""
        return self._shown(self.saved.shown)

    def _shown(self, table: pd.DataFrame) -> pd.DataFrame:
        return as_shown(table, self.saved.study.units, self.saved.study.in_words)

    @property
    def speed(self) -> str:
        """Return the column of the belt speed, in the units given."""
        return belt_speed(self.table.columns)

    @cached_property
    def swept(self) -> list[str]:
        """List what is swept besides belt speed."""
        return swept_inputs(self.table)

    def where(self, row: pd.Series) -> dict[str, Any]:
        """Tell where a point is: its belt speed, and what else is swept."""
        return {name: row[name] for name in (self.speed, *self.swept)}

    @cached_property
    def figures(self) -> FigureData:
        """Return the data of the figures of its table."""
        from frictionlab.charts.figures import FigureData  # with matplotlib, which takes a second

        return self.drawn or FigureData.of(self.saved.study, self.saved.shown)

    @cached_property
    def reduced(self) -> frozenset[str]:
        """Return its methods that solve a simpler model, in words."""
        study = self.saved.study
        return frozenset(study.in_words["method"][each.label] for each in study.methods if each.is_reduced)

    @cached_property
    def method_pairs(self) -> list[Difference]:
        """Every two methods, law by law; reduced models first."""
        return method_pairs(self.table, self.reduced)

    @cached_property
    def cited(self) -> list[Cited]:
        """List the sources it draws on."""
        return sources(self.saved)

    @cached_property
    def curves(self) -> list[CurveRows]:
        """Return the curves of the result table, in its order."""
        return self.curves_of(self.table)

    def curves_of(self, table: pd.DataFrame) -> list[CurveRows]:
        """Return those of a table of this run, told apart by what is swept."""
        table = self._shown(table)
        told = [name for name in self.swept if name in table]
        groups = table.groupby(["law", "method", *told], sort=False, dropna=False).indices
        found = [
            CurveRows(
                str(law), str(method), dict(zip(told, values, strict=True)), table, sorted(places.tolist())
            )
            for (law, method, *values), places in groups.items()
        ]
        return sorted(found, key=lambda curve: curve.places[0])


def whose(curves: Sequence[CurveRows]) -> dict[Cell, Callable[[CurveRows], Cell]]:
    """Columns of a table of curves: law, method where there are several, and what tells one from the others."""
    several = len({curve.method for curve in curves}) > 1
    return {
        "law": lambda curve: curve.law,
        "method": lambda curve: curve.method if several else "",
        "curve": lambda curve: curve.name,
    }
