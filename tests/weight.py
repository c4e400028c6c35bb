"""Lines of code in each room of the package, beside its limit: python tests/weight.py.

A line of code is neither blank nor comment, docstring or import: words and white space are free.
"""

from __future__ import annotations

import ast
import io
import tokenize
from collections import Counter
from pathlib import Path

PROJECT = Path(__file__).parents[1]
THIN = {
    *(tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE),
    *(tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER),
}


def code_lines(text: str) -> int:
    """Number of lines of a source text that are code."""
    beside: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import | ast.ImportFrom) or _is_text(node):
            beside |= {*range(node.lineno, (node.end_lineno or node.lineno) + 1)}
    code: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in THIN:
            code |= {*range(token.start[0], token.end[0] + 1)}
    return len(code - beside)


def _is_text(node: ast.AST) -> bool:
    """Check for a text that stands by itself: a docstring."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


def lines_of_rooms() -> Counter[str]:
    """Lines of code in each room of the package, in the files beside them, in the tests and in the plugins."""
    counted: Counter[str] = Counter()
    for path in (PROJECT / "frictionlab").rglob("*.py"):
        room = path.relative_to(PROJECT / "frictionlab").parts[0]
        counted["beside the rooms" if room.endswith(".py") else room] += code_lines(path.read_text())
    for folder in ("tests", "plugins"):
        counted[folder] = sum(code_lines(path.read_text()) for path in (PROJECT / folder).rglob("*.py"))
    return counted


def files_of_package() -> list[Path]:
    """Source files of the package."""
    return sorted((PROJECT / "frictionlab").rglob("*.py"))


if __name__ == "__main__":
    from test_weight import LIMITS

    for room, lines in sorted(lines_of_rooms().items(), key=lambda pair: -pair[1]):
        print(f"{room:18s} {lines:6d}  at most {LIMITS[room]:6d}")
    print(f"{len(files_of_package())} files")
