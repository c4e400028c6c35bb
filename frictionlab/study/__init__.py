"""The study file: what a person writes, checked as a whole, and the frozen study it becomes."""

from frictionlab.study.mistakes import Mistake, StudyError
from frictionlab.study.reader import load_study, parse_study
from frictionlab.study.record import Case, Expectation, LawChoice, MethodChoice, Study

__all__ = [
    "Case",
    "Expectation",
    "LawChoice",
    "MethodChoice",
    "Mistake",
    "Study",
    "StudyError",
    "load_study",
    "parse_study",
]
