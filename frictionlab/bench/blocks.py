"""Blocks of a bench list, a study each, and who is measured on them."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from pydantic import model_validator

from frictionlab.bench.contenders import Measured
from frictionlab.study.load import parse_study
from frictionlab.study.study import Study
from frictionlab.values.columns import BELT_SPEEDS
from frictionlab.values.notes import StudyError

OF_A_STUDY = ("scene", "laws", "sweep")


class BenchBlock(Measured):
    """A study, whose keys are checked by the reader of studies, and who is measured on it."""

    name: str
    title: str = ""
    scene: Any = None
    laws: Any = None
    sweep: Any = None

    @cached_property
    def study(self) -> Study:
        """Return the scene, laws and sweep as the study they are."""
        return self.study_of()

    def study_of(self, **changed: Any) -> Study:
        """Read the study with some of its keys changed. Raises ValueError with the first mistake in it."""
        given = {key: getattr(self, key) for key in OF_A_STUDY if key in self.model_fields_set}
        try:
            return parse_study({"schema": 1} | given | changed)
        except StudyError as problem:
            told = problem.mistakes[0]
            raise ValueError(": ".join(filter(None, (told.path, told.what, told.hint)))) from None

    @model_validator(mode="after")
    def _is_a_study(self) -> BenchBlock:
        """Read the study now, so that the mistakes in it are those of the list."""
        _ = self.study
        return self


class OwnBlock(BenchBlock):
    """A study that takes nothing from the rest of its list: who is measured and against whom is its own."""

    sweep: Any

    @model_validator(mode="after")
    def _has_solvers(self) -> OwnBlock:
        if not self.contenders:
            raise ValueError("no methods and no peers: there is nothing to measure")
        if any(each.values is not None for each in self.references):
            raise ValueError("references: give methods: a table of values knows one curve of one model alone")
        return self


def refuse_other_sweeps(study: Study) -> None:
    """Raise ValueError where something else than the belt speed is swept."""
    if not study.sweep.keys() <= {*BELT_SPEEDS}:
        raise ValueError("sweep: a bench curve sweeps the belt speed alone")
