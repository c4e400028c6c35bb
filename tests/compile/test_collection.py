"""Python's search for garbage rests while numba compiles, and goes on afterwards."""

import gc

import numba
import numba.extending
import pytest
from numba.core.errors import TypingError

from frictionlab.compile.cache import pause_collection

pause_collection()


def seen_while_compiling(fails: bool = False) -> list[bool]:
    """Whether the collector was on while a function was compiled, and in a function that it calls."""
    found: list[bool] = []

    def asked(x):
        return x

    def resolve(x):
        found.append(gc.isenabled())
        return None if fails else lambda x: 2.0 * x

    numba.extending.overload(asked)(resolve)
    inner = numba.njit(lambda x: asked(x))
    numba.njit(lambda x: inner(x) + inner(2.0 * x))(1.0)
    return found


def test_nothing_is_collected_while_a_function_is_compiled():
    found = seen_while_compiling()

    assert found
    assert not any(found)
    assert gc.isenabled()


def test_the_collector_is_on_again_after_a_function_that_cannot_be_compiled():
    with pytest.raises(TypingError):
        seen_while_compiling(fails=True)

    assert gc.isenabled()
