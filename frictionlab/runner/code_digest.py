"""What finds the numbers of a run, as a digest: where it changes, a point that failed may succeed, and a chunk that
was kept is solved anew."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Collection
from functools import cache
from importlib.metadata import version
from pathlib import Path

import frictionlab
from frictionlab import registry
from frictionlab.study import Study

SOLVERS = ("numpy", "numba", "llvmlite", "scipy")
BESIDE = {"bench", "charts", "cli", "mistakes", "report", "scaffold", "shape", "study", "testing"}
"""Rooms of frictionlab that no number of a point hangs on: what a study means is in its scenes and laws."""


def code_digest(study: Study) -> str:
    """SHA-256 of frictionlab, of the laws and methods of other packages in a study, and of the versions they use."""
    outside = [registry.method_code(name) for name in sorted({choice.name for choice in study.methods})]
    return hashlib.sha256(repr((solving_code(), sorted(study.code.items()), outside)).encode()).hexdigest()


def solving_code() -> str:
    """SHA-256 of frictionlab and of the versions it uses."""
    told = own_code(), platform.python_version(), [version(name) for name in SOLVERS]
    return hashlib.sha256(repr(told).encode()).hexdigest()


@cache
def own_code(beside: Collection[str] = tuple(sorted(BESIDE))) -> str:
    """SHA-256 of the source files of frictionlab, but for rooms beside: of those that numbers hang on."""
    home, digest = Path(frictionlab.__file__).parent, hashlib.sha256()
    for file in sorted(home.rglob("*.py")):
        if file.relative_to(home).parts[0] in beside:
            continue
        digest.update(file.relative_to(home).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()
