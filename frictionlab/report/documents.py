"""What laws and methods say of themselves. A method is read, not imported: its kernels may take a while."""

from __future__ import annotations

import ast
import inspect
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec
from pathlib import Path

from frictionlab import registry
from frictionlab.study import LawChoice


def law_text(law: LawChoice) -> str:
    """The docstring of a law."""
    return inspect.getdoc(law.law_class) or ""


def method_text(name: str) -> str:
    """The docstring of a method; nothing for one that is not installed here."""
    doors = entry_points(group=registry.METHODS, name=name)
    return next((_written(door) for door in doors), "")


def _written(door: EntryPoint) -> str:
    """The docstring of the class behind an entry point, as its file has it."""
    try:
        spec = find_spec(door.module)
        source = Path(str(spec.origin if spec else "")).read_text(encoding="utf-8")
        classes = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ClassDef)]
    except (ImportError, OSError, ValueError, SyntaxError):
        return ""
    return next((ast.get_docstring(node) or "" for node in classes if node.name == door.attr), "")
