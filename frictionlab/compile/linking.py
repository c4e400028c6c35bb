"""Code that only other kernels call: kept as it is until the entry that calls it is compiled, and compiled there.

numba by itself optimises every function together with all it calls and makes machine code of it at every level of
calls, though only entries are ever run: half the time of compiling a bristle law. Small parts are still optimised
by themselves: what is inlined from them is then small, and the entry runs some 15 % faster.
"""

from __future__ import annotations

from typing import Any

import numba.core.codegen
import numba.core.compiler

_Library: Any = numba.core.codegen.JITCodeLibrary  # internals of numba, untyped
_Compiler: Any = numba.core.compiler.Compiler
SMALL = 10
"""Of a part [functions it holds]: up to here it is optimised by itself."""


class _Part(_Library):  # type: ignore[misc]
    """A function and all it calls, to be linked into an entry; it has no address, and needs no environment."""

    def _optimize_final_module(self) -> None:
        if sum(1 for _ in self.get_defined_functions()) <= SMALL:
            super()._optimize_final_module()

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """No address: machine code is made of the entry alone."""
        return 0

    @property
    def codegen(self) -> Any:
        """Itself, to be asked for ``set_env`` in place of the machine code's owner."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Nothing to set: only code that calls Python reads its environment."""


class _OfParts(_Compiler):  # type: ignore[misc]
    """numba's compiler of functions, their code gathered in parts."""

    def __init__(self, typing: Any, target: Any, library: Any, *others: Any) -> None:
        super().__init__(typing, target, library or _Part(target.codegen(), "part"), *others)


def _known() -> bool:
    inherited = ("_optimize_final_module", "_finalize_final_module", "_finalize_dynamic_globals")
    return all(hasattr(_Library, name) for name in (*inherited, "get_pointer_to_function"))


PARTS: dict[str, Any] = {"pipeline_class": _OfParts} if _known() else {}
"""How numba is told so; empty where its library of code is not the one of numba 0.60 to 0.68."""
