"""Methods and peers that a bench list names, a solver for each setting, and the references they are held against."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextvars import ContextVar
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeVar

import numpy as np
import pandas as pd
from pydantic import BeforeValidator, Field, model_validator

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.equations import ScipyBristle, ScipySteps
from frictionlab.bench.peers.heyoka_taylor import Heyoka
from frictionlab.bench.peers.scipy_events import ScipyEvents
from frictionlab.methods.base import Method
from frictionlab.study.parts import method_choice
from frictionlab.values.notes import Notes, dotted
from frictionlab.values.quantities import Positive, Record
from frictionlab.values.validation import build_record

PEERS: dict[str, type[Peer]] = {peer.name: peer for peer in (ScipySteps, ScipyEvents, ScipyBristle, Heyoka)}
"""Other libraries by the names that a list gives them."""
REFERENCE_COLUMNS = ["belt_speed", "mean_friction"]
LIST_FOLDER = ContextVar("LIST_FOLDER", default=Path())
"""Folder of the list that is read: files of reference values are relative to it."""
AtLeastOne = Annotated[int, Field(strict=True, ge=1)]
FILLED: Any = Field(min_length=1)
_RecordT = TypeVar("_RecordT", bound=Record)


def one_of(known: Mapping[str, Any]) -> Any:
    """Return the validator that reads a name as what it stands for."""

    def named(name: Any) -> Any:
        if not isinstance(name, str) or name not in known:
            raise ValueError(f"must be one of {', '.join(map(repr, known))}")
        return known[name]

    return BeforeValidator(named)


class BenchSetting(NamedTuple):
    """A solver, the tolerance it is asked for, and the quantity that is varied with its value, '' where none is."""

    quantity: str
    value: float
    tolerance: float
    solver: Method | Peer

    def __str__(self) -> str:
        """``tolerance 1e-06``, or ``as is`` where nothing is varied."""
        return f"{self.quantity} {self.value:g}" if self.quantity else "as is"


class Contender(NamedTuple):
    """A method or peer under one label, with its settings; points: of a curve, None for all."""

    label: str
    kind: str
    settings: tuple[BenchSetting, ...]
    points: int | None

    @property
    def side(self) -> str:
        """``peer`` for another library, else ``method``."""
        return "peer" if isinstance(self.settings[0].solver, Peer) else "method"

    def missing(self) -> str | None:
        """Say how to install a peer that is not there."""
        solver = self.settings[0].solver
        return solver.missing() if isinstance(solver, Peer) else None


class ReferenceSource(NamedTuple):
    """A source of reference values: a method or peer at a tolerance, or means by belt speed, known to an error.

    kind: of the method or peer, '' for values. tolerance: asked of the solver, or the error of the values.
    """

    label: str
    kind: str
    tolerance: float
    solver: Method | Peer | None = None
    values: Mapping[float, float] | None = None

    def value(self, speed: float) -> float:
        """Mean at this belt speed, give or take its last digits; NaN where there is none."""
        near = (mean for at, mean in (self.values or {}).items() if math.isclose(at, speed, rel_tol=1e-12))
        return next(near, math.nan)


def built(kind: type[_RecordT], given: Any) -> _RecordT:
    """Make a record of the keys given. Raises ValueError with the first mistake, ``path: what is wrong``."""
    notes = Notes()
    made = build_record(kind, mapping(given), (), notes)
    refuse(notes)
    assert made is not None
    return made


def mapping(given: Any) -> dict[str, Any]:
    """Return the value if it is a mapping. Raises ValueError if it is none."""
    if not isinstance(given, dict):
        raise ValueError("must be a mapping")
    return given


def refuse(notes: Notes) -> None:
    """Raise ValueError with the first mistake that is noted."""
    for note in notes.all:
        raise ValueError(": ".join(filter(None, (dotted(note.path), note.what, note.hint))))


class _Asked(Record):
    """Settings of a method or peer beside its own parameters."""

    tolerance: Positive = 1e-8
    points: AtLeastOne | None = None


class _ValuesOfFile(Record):
    """Reference values from a file, relative to the list, and how well they are known."""

    values: str
    error: Positive
    label: str = ""


def _contender(given: Any, peers: bool) -> Contender:
    """Read a method or peer of which one value may be a list, which is run through."""
    told: dict[str, Any] = {"kind": given} if isinstance(given, str) else mapping(given)
    varied = [key for key, value in told.items() if isinstance(value, list) and key not in ("kind", "points")]
    if len(varied) > 1:
        raise ValueError(f"{varied[1]}: only one value may be a list, and {varied[0]} is one")
    quantity = varied[0] if varied else ""
    if varied and not told[quantity]:
        raise ValueError(f"{quantity}: the list is empty; give at least one, such as [1.0e-6]")
    cases = [(value, told | {quantity: value}) for value in told[quantity]] if varied else [(np.nan, told)]
    settings = tuple(_setting(quantity, value, case, peers) for value, case in cases)
    kind = str(told["kind"])
    return Contender(str(told.get("label", kind)), kind, settings, told.get("points"))


def _setting(quantity: str, value: float, told: dict[str, Any], peers: bool) -> BenchSetting:
    asked = {key: told[key] for key in _Asked.model_fields if key in told}
    own = {key: told[key] for key in told if key not in asked}
    return BenchSetting(quantity, value, built(_Asked, asked).tolerance, _solver(own, peers))


def _solver(told: dict[str, Any], peers: bool) -> Method | Peer:
    """Make a method of these parameters, or a peer."""
    notes = Notes()
    if not peers:
        if told.get("kind") == "auto":
            raise ValueError("kind: auto only chooses: name the methods it chooses from")
        choice = method_choice(told, (), notes)
        refuse(notes)
        assert choice is not None
        return choice.method
    name = notes.one_of(told.get("kind"), ("kind",), PEERS)
    notes.text(told.get("label", ""), ("label",))
    refuse(notes)
    return built(PEERS[str(name)], {key: told[key] for key in told if key not in ("kind", "label")})


def _reference(given: Any) -> ReferenceSource:
    """Read a table of values, or a method or peer with the tolerance it is to be solved to."""
    if "values" in mapping(given):
        known = built(_ValuesOfFile, given)
        return ReferenceSource(known.label or known.values, "", known.error, values=_table(known.values))
    made = _contender(given, peers=given.get("kind") in PEERS)
    if "tolerance" not in given or made.points or len(made.settings) > 1:
        raise ValueError("tolerance: give the one that the reference is solved to, and no points")
    (setting,) = made.settings
    closely, solver = setting.tolerance, setting.solver
    return ReferenceSource(f"{made.label} at {closely:g}", made.kind, closely, solver)


def _table(file: str) -> dict[float, float]:
    """Mean friction by belt speed."""
    try:
        table = pd.read_csv(LIST_FOLDER.get() / file, dtype=str)[REFERENCE_COLUMNS].astype(float)
    except (OSError, KeyError, ValueError) as problem:
        what = f"must be a CSV file of numbers with the columns {' and '.join(REFERENCE_COLUMNS)}"
        raise ValueError(f"values: {what}: {problem}") from None
    return dict(table.to_numpy().tolist())


AMethod = Annotated[Any, BeforeValidator(lambda given: _contender(given, peers=False))]
APeer = Annotated[Any, BeforeValidator(lambda given: _contender(given, peers=True))]
AReference = Annotated[Any, BeforeValidator(_reference)]


class Measured(Record):
    """Methods and peers that are measured, and their references, of a list or of one of its blocks."""

    references: tuple[AReference, ...] = ()
    methods: Annotated[tuple[AMethod, ...], FILLED] = ()
    peers: Annotated[tuple[APeer, ...], FILLED] = ()

    @model_validator(mode="after")
    def _labels_differ(self) -> Measured:
        labels = [each.label for each in self.contenders]
        if same := [label for label in labels if labels.count(label) > 1]:
            raise ValueError(f"'{same[0]}' is there twice; give each its own label")
        return self

    @property
    def contenders(self) -> tuple[Contender, ...]:
        """Methods, then peers."""
        return (*self.methods, *self.peers)
