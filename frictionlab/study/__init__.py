"""The study file: what a person writes, checked as a whole, and the frozen study it becomes."""

from __future__ import annotations

from frictionlab.mistakes.notes import Mistake, StudyError
from frictionlab.study.axes import GridValue
from frictionlab.study.law_files import Plugins, laws_of_files
from frictionlab.study.reader import load_study, parse_study, read_back
from frictionlab.study.study import (
    Expectation,
    LawChoice,
    MethodChoice,
    Study,
    StudyCase,
    StudyCurve,
)

__all__ = [
    "Expectation",
    "GridValue",
    "LawChoice",
    "MethodChoice",
    "Mistake",
    "Plugins",
    "Study",
    "StudyCase",
    "StudyCurve",
    "StudyError",
    "laws_of_files",
    "load_study",
    "parse_study",
    "read_back",
]
