"""What laws and methods say of themselves. A method is read, not imported: its kernels may take a while."""

from __future__ import annotations

import ast
import inspect
from functools import cache
from importlib.metadata import entry_points
from importlib.util import find_spec
from pathlib import Path

from frictionlab import registry
from frictionlab.study import LawChoice


def law_text(law: LawChoice) -> str:
    """The docstring of a law."""
    return inspect.getdoc(law.law_class) or ""


def method_text(name: str) -> str:
    """The docstring of a method; nothing for one that is not installed here."""
    written = _written(name)
    return (ast.get_docstring(written) or "") if written else ""


def method_bibtex(name: str) -> str:
    """The ``bibtex`` of a method; nothing for one that is not installed here."""
    written = _written(name)
    given = [node for node in written.body if _sets_bibtex(node)] if written else []
    if not given:
        return ""
    value = getattr(given[0], "value", None)
    return str(value.value) if isinstance(value, ast.Constant) else registry.method_class(name).bibtex


def _sets_bibtex(node: ast.stmt) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return any(isinstance(target, ast.Name) and target.id == "bibtex" for target in targets)


@cache
def _written(name: str) -> ast.ClassDef | None:
    """The class of a method as its file has it: reading it is quicker than importing what it needs."""
    for door in entry_points(group=registry.METHODS, name=name):
        try:
            spec = find_spec(door.module)
            source = Path(str(spec.origin if spec else "")).read_text(encoding="utf-8")
            classes = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ClassDef)]
        except (ImportError, OSError, ValueError, SyntaxError):
            return None
        return next((node for node in classes if node.name == door.attr), None)
    return None
