"""What finds the numbers of a run, as a digest: where it changes, a point that failed may succeed."""

from __future__ import annotations

import hashlib
import sys
from functools import cache
from importlib.metadata import version
from pathlib import Path

import frictionlab
from frictionlab import registry
from frictionlab.study import Study

SOLVERS = ("numpy", "numba", "llvmlite", "scipy")


def code_digest(study: Study) -> str:
    """SHA-256 of frictionlab, of the laws and methods of other packages in a study, and of the versions they use."""
    outside = [registry.method_code(name) for name in sorted({choice.name for choice in study.methods})]
    told = (own_code(), sys.version, [version(name) for name in SOLVERS], sorted(study.code.items()), outside)
    return hashlib.sha256(repr(told).encode()).hexdigest()


@cache
def own_code() -> str:
    """SHA-256 of the source files of frictionlab."""
    home, digest = Path(frictionlab.__file__).parent, hashlib.sha256()
    for file in sorted(home.rglob("*.py")):
        digest.update(file.relative_to(home).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()
