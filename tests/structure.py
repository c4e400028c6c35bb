"""The rooms of the package (its folders), which of them import which, and the floors that they stand on."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path


class Tree:
    """The modules of a package by name, parsed."""

    def __init__(self, checkout: Path) -> None:
        self.house = checkout / "frictionlab"
        self.paths = {
            self._name(path): path
            for path in sorted(self.house.rglob("*.py"))
            if path.parent != self.house or path.stem[0] != "_"
        }
        self.trees = {name: ast.parse(path.read_text()) for name, path in self.paths.items()}

    def _name(self, path: Path) -> str:
        return ".".join(path.relative_to(self.house).with_suffix("").parts).removesuffix(".__init__")

    def imports(self, module: str) -> Iterator[str]:
        """The modules of the package that a module imports, inside functions too."""
        for node in ast.walk(self.trees[module]):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("frictionlab"):
                package = node.module.removeprefix("frictionlab").removeprefix(".")
                for alias in node.names:
                    inner = f"{package}.{alias.name}".removeprefix(".")
                    if (inner if inner in self.paths else package) in self.paths:
                        yield inner if inner in self.paths else package


@cache
def tree_of(checkout: Path) -> Tree:
    """The modules of a checkout, parsed once."""
    return Tree(checkout)


def room(module: str) -> str:
    """The first folder of a module, or the file itself beside the folders."""
    return module.partition(".")[0]


def room_of_method(module: str) -> str:
    """The folder (or file) inside ``methods`` a module lies in."""
    return module.removeprefix("methods.").partition(".")[0]


def arrows(tree: Tree, of: str = "") -> dict[str, set[str]]:
    """Which rooms import which, at the top level or inside one folder."""
    drawn: dict[str, set[str]] = defaultdict(set)
    inside = [name for name in tree.paths if name.startswith(of + ".")] if of else list(tree.paths)
    named = room_of_method if of else room
    for module in inside:
        drawn[named(module)] |= {
            named(other)
            for other in tree.imports(module)
            if other in inside and named(other) != named(module)
        }
    return dict(drawn)


def floors(drawn: dict[str, set[str]]) -> dict[str, int]:
    """How far above the ground each room stands: one above the highest room it imports; circles are cut."""
    height: dict[str, int] = {}

    def visit(name: str, above: tuple[str, ...]) -> int:
        if name not in height:
            below = [other for other in drawn.get(name, ()) if other not in (*above, name)]
            height[name] = 1 + max((visit(other, (*above, name)) for other in below), default=-1)
        return height[name]

    for name in drawn:
        visit(name, ())
    return height
