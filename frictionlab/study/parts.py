"""The laws, methods and expectations of a study, each as the study gives it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from frictionlab import registry
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import REDUCED_MODELS, Method
from frictionlab.mistakes.notes import number_text
from frictionlab.quantities import Written
from frictionlab.scene.waveforms import Form
from frictionlab.study.axes import STATIC, GridValue

SCHEMA = 1
LIMIT_KEY = "seconds_per_point"


@dataclass(frozen=True)
class LawChoice:
    """A law of the study under its label; parameters as given, with the law's defaults."""

    label: str
    kind: str
    parameters: dict[str, Any]
    law_class: type[FrictionLaw] = field(compare=False, repr=False)

    def law(self, values: Mapping[str, GridValue] | None = None) -> FrictionLaw:
        """The law, with some parameters replaced by these values."""
        return self.law_class.model_validate(self.parameters | dict(values or {}))

    def under_friction(self, coefficients: tuple[GridValue, ...]) -> dict[str, tuple[GridValue, ...]]:
        """The parameters of the law that has these friction coefficients, ``mu_static`` in the ratio it has."""
        name = coefficient_of(self.law_class)
        given, static = self.parameters[name], self.parameters.get(STATIC)
        if static is None:
            return {name: coefficients}
        numbers = [each for each in coefficients if isinstance(each, float)]
        ratio = static / given
        return {
            name: coefficients,
            STATIC: tuple(static if mu == given else mu * ratio for mu in numbers),
        }

    @property
    def in_words(self) -> str:
        """What figures call it: the label that the study gives it, else the law's own words."""
        return self.label if self.label != self.kind else self.law_class.in_words or self.label

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        label = {} if self.label == self.kind else {"label": self.label}
        return {"kind": self.kind, **natural(self.parameters), **label}


def plain_values(law: FrictionLaw) -> dict[str, Any]:
    """The parameters of a law as a study gives them; texts with units stay such."""
    written = {name: value for name, value in law if isinstance(value, Written)}
    return law.model_dump(exclude_none=True, mode="json") | written


def coefficient_of(law: type[FrictionLaw]) -> str:
    """The name of the parameter that is the friction coefficient of sliding: mu or mu_kinetic; '' without one."""
    return next((name for name in ("mu", "mu_kinetic") if name in law.model_fields), "")


@dataclass(frozen=True)
class MethodChoice:
    """A method of the study under its label; its class is imported when ``method`` is first used."""

    label: str
    name: str
    parameters: dict[str, Any]

    @classmethod
    def of(cls, method: Method) -> MethodChoice:
        """The choice of a method that is there already."""
        choice = cls(method.name, method.name, {})
        vars(choice)["method"] = method
        return choice

    @cached_property
    def method(self) -> Method:
        """The method with its parameters."""
        return registry.method_class(self.name).model_validate(self.parameters)

    @property
    def is_reduced(self) -> bool:
        """Whether it solves a simpler model: its errors are then the distance to the full answers."""
        return self.name in REDUCED_MODELS

    @property
    def in_words(self) -> str:
        """What figures call it: the label that the study gives it, else the method's own words."""
        try:
            words = registry.method_class(self.name).in_words
        except (KeyError, registry.BrokenPlugin):  # of a run made where it could be used
            words = ""
        return self.label if self.label != self.name else words or self.label

    def resolved(self) -> str | dict[str, Any]:
        """The entry of a study file: the name alone if it has neither parameters nor a label."""
        if self.label == self.name and not self.parameters:
            return self.name
        label = {} if self.label == self.name else {"label": self.label}
        return {"kind": self.name, **natural(self.parameters), **label}


WhereValue = str | float | list[str | float] | dict[str, float]
"""What an input must be: a value, one of several, or a number within a range, ``{"from": 5, "to": 20}``."""


@dataclass(frozen=True)
class Expectation:
    """A claim of a study about its table; exactly one of the six comparisons is set.

    where: input column -> value, selects the rows. equals (needs within), below, above: of ``column``, a result or
    a measure of curves; of it less, or over, that of the row with the inputs ``minus`` or ``over`` and equal others.
    status: of those rows. max_difference: two method labels whose mean_friction differs by under ``below``.
    shape: of the curves those rows make, by ``measure``.
    """

    where: dict[str, WhereValue]
    minus: dict[str, WhereValue] | None = None
    over: dict[str, WhereValue] | None = None
    column: str | None = None
    equals: float | None = None
    below: float | None = None
    above: float | None = None
    within: float | None = None
    status: str | None = None
    max_difference: tuple[str, str] | None = None
    shape: str | None = None
    measure: str | None = None
    because: str = ""

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        said = {
            name: natural(value) for name, value in vars(self).items() if value is not None and value != ""
        }
        if self.max_difference:
            said["max_difference"] = list(self.max_difference)
        return said


def natural(value: Any) -> Any:
    """The value with whole floats as integers, as a person would write them (and -0.0 as 0), texts as they were."""
    if isinstance(value, Written):
        return value
    if isinstance(value, dict):
        return {key: natural(item) for key, item in value.items()}
    if isinstance(value, Form):
        return natural(value.plain())
    if isinstance(value, list):
        return [natural(item) for item in value]
    if isinstance(value, float) and "." not in (text := number_text(value)) and "e" not in text:
        return int(text)
    return value
