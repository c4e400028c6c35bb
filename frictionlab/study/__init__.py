"""The study file: what a person writes, checked as a whole, and the frozen study it becomes."""

from __future__ import annotations

from frictionlab.mistakes.notes import Mistake, StudyError
from frictionlab.study.axes import GridValue
from frictionlab.study.grid import StudyCase, StudyCurve
from frictionlab.study.law_files import Plugins, laws_of_files
from frictionlab.study.load import load_study, parse_study, read_back
from frictionlab.study.parts import Expectation, LawChoice, MethodChoice, WhereValue
from frictionlab.study.study import Study

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
    "WhereValue",
    "laws_of_files",
    "load_study",
    "parse_study",
    "read_back",
]
