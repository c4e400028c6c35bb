"""Methods of a law that take one slip speed or, called in Python, an array of them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import FunctionType
from typing import Any

import numpy as np

OF_SPEED = "sliding_friction", "sliding_vector"
"""The methods whose one argument is a speed or a slip velocity."""


class OfEach:
    """A method of one number that its law, once made, also takes arrays for; a class has the method itself.

    So compiled code, which asks the class, is what it was.
    """

    def __init__(self, method: FunctionType) -> None:
        self.py_func = method

    def __get__(self, law: Any, kind: type | None = None) -> Callable[..., Any]:
        return self.py_func if law is None else partial(_of_each, self.py_func, law)


def as_written(member: Any) -> Any:
    """A method as its class defines it; anything else as it is."""
    return member.py_func if isinstance(member, OfEach) else member


def _of_each(method: FunctionType, law: Any, given: Any) -> Any:
    if isinstance(given, int | float | complex) or np.ndim(given) == 0:
        return method(law, given)
    numbers = np.asarray(given)
    found = [method(law, number) for number in numbers.ravel().tolist()]
    return np.array(found, dtype=numbers.dtype if numbers.dtype.kind == "c" else float).reshape(numbers.shape)


def accept_arrays(law: type) -> None:
    """Let the methods of a speed that this class defines take arrays."""
    for name in OF_SPEED:
        method = vars(law).get(name)
        if isinstance(method, FunctionType) and not getattr(method, "__isabstractmethod__", False):
            setattr(law, name, OfEach(method))
