"""What the structure of a checkout measures: python tests/structure.py [CHECKOUT] [--list].

Files, lines, rooms (folders), floors and arrows between rooms, family questions, long functions, comments in kernels
and public names with two homes. Reads source as text; a checkout of any commit will do.
"""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

FAMILIES = {"SlidingLaw", "BristleLaw", "MemoryLaw", "CompliantLaw", "DampedLaw"}
KERNEL_MARKS = {"inner", "fast", "njit", "by_dimension", "by_law"}
LONG, MANY = 40, 6


class Tree:
    """The modules of a package by name, parsed."""

    def __init__(self, checkout: Path) -> None:
        self.house = checkout / "frictionlab"
        self.paths = {
            self._name(path): path
            for path in sorted(self.house.rglob("*.py"))
            if path != self.house / "__init__.py"
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

    def is_package(self, module: str) -> bool:
        """Whether a module is a folder."""
        return self.paths[module].name == "__init__.py"


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


def functions(tree: Tree) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Every function of the package with its module."""
    for module, parsed in tree.trees.items():
        for node in ast.walk(parsed):
            if isinstance(node, ast.FunctionDef):
                yield module, node


def arguments(function: ast.FunctionDef) -> int:
    """How many arguments a function takes, ``self`` and ``cls`` left out."""
    names = [a.arg for a in (*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs)]
    return len([name for name in names if name not in ("self", "cls")])


def family_questions(tree: Tree) -> list[str]:
    """Lines outside compile/ and testing/ that ask ``isinstance`` of a law family."""
    found = []
    for module, parsed in tree.trees.items():
        if room(module) in ("compile", "testing", "kernel"):
            continue
        for node in ast.walk(parsed):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("isinstance", "issubclass"):
                names = {name.id for name in ast.walk(node) if isinstance(name, ast.Name)}
                if names & FAMILIES:
                    found.append(f"{module}:{node.lineno}")
    return found


def kernels(tree: Tree) -> list[str]:
    """Modules that hold compiled functions."""
    found = []
    for module, parsed in tree.trees.items():
        marks = {
            name.id
            for node in ast.walk(parsed)
            if isinstance(node, ast.FunctionDef)
            for mark in node.decorator_list
            for name in ast.walk(mark)
            if isinstance(name, ast.Name)
        }
        if marks & KERNEL_MARKS and room(module) not in ("compile", "kernel"):
            found.append(module)
    return found


def comments(tree: Tree, modules: list[str]) -> float:
    """Full-line comments per 100 lines of these modules."""
    lines = [line.strip() for module in modules for line in tree.paths[module].read_text().splitlines()]
    return 100.0 * sum(line.startswith("#") for line in lines) / max(len(lines), 1)


def public_doubles(tree: Tree) -> dict[str, list[str]]:
    """Public classes and functions of one name that are defined in two or more modules."""
    homes: dict[str, list[str]] = defaultdict(list)
    for module, parsed in tree.trees.items():
        for node in parsed.body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                homes[node.name].append(module)
    return {name: modules for name, modules in sorted(homes.items()) if len(modules) > 1}


def measured(tree: Tree) -> dict[str, object]:
    """Every number of the structure by what it counts."""
    top, methods = arrows(tree), arrows(tree, "methods")
    lines = [path.read_text().count("\n") for path in tree.paths.values()]
    every = list(functions(tree))
    return {
        "files": len(tree.paths),
        "lines of source": sum(lines),
        "rooms": len({room(module) for module in tree.paths}),
        "floors": 1 + max(floors(top).values()),
        "arrows": sum(map(len, top.values())),
        "rooms in methods": len({room_of_method(m) for m in tree.paths if m.startswith("methods.")}),
        "floors in methods": 1 + max(floors(methods).values()),
        "arrows in methods": sum(map(len, methods.values())),
        "isinstance on law families outside compile and testing": len(family_questions(tree)),
        f"functions over {LONG} lines": sum((f.end_lineno or 0) - f.lineno + 1 > LONG for _, f in every),
        f"functions over {MANY} arguments": sum(arguments(f) > MANY for _, f in every),
        "full-line comments per 100 lines of kernels": round(comments(tree, kernels(tree)), 1),
        "public names with two homes": len(public_doubles(tree)),
    }


if __name__ == "__main__":
    given = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    checkout = Path(given[0]) if given else Path(__file__).parents[1]
    tree = Tree(checkout)
    for what, number in measured(tree).items():
        print(f"{what:58} {number}")
    if "--list" in sys.argv:
        print("\n".join(family_questions(tree)))
        for module, function in functions(tree):
            lines, many = (function.end_lineno or 0) - function.lineno + 1, arguments(function)
            if lines > LONG or many > MANY:
                print(f"{module}:{function.lineno} {function.name}: {lines} lines, {many} arguments")
        print("\n".join(f"{name}: {', '.join(homes)}" for name, homes in public_doubles(tree).items()))
