"""Mutants of a Python file: the same file with one thing in one of its functions changed."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from pathlib import Path
from types import CodeType
from typing import NamedTuple

COMPARED = {
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
COMBINED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult}
JOINED = {ast.And: ast.Or, ast.Or: ast.And}
SWAPPED = {"min": "max", "max": "min"}


class Mutant(NamedTuple):
    """One change: where, what stood there and what stands there now, and the code of the function with it."""

    file: Path
    line: int
    before: str
    after: str
    function: str
    code: CodeType

    def __str__(self) -> str:
        return f"{self.file.parent.name}/{self.file.name}:{self.line} {self.function}: {self.before} -> {self.after}"


def mutants(file: Path) -> Iterator[Mutant]:
    """Every mutant of every function of the file."""
    tree = ast.parse(file.read_text())
    for name, function in _functions(tree, ""):
        for node in _inside(function):
            for changed in _changes(node, function):
                yield _made(file, tree, name, node, changed)


def _functions(tree: ast.AST, prefix: str) -> Iterator[tuple[str, ast.FunctionDef]]:
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.ClassDef):
            yield from _functions(node, f"{prefix}{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            yield f"{prefix}{node.name}", node


def _inside(function: ast.FunctionDef) -> Iterator[ast.expr]:
    """The expressions of the body, but for what is said in errors."""
    waiting: list[ast.AST] = list(function.body)
    while waiting:
        node = waiting.pop(0)
        if not isinstance(node, ast.Raise | ast.JoinedStr):
            waiting.extend(ast.iter_child_nodes(node))
        if isinstance(node, ast.expr):
            yield node


def _changes(node: ast.expr, function: ast.FunctionDef) -> Iterator[ast.expr]:
    match node:
        case ast.Compare(ops=[op]) if type(op) in COMPARED:
            yield _with(node, ops=[COMPARED[type(op)]()])
        case ast.BinOp(op=op) if type(op) in COMBINED:
            yield _with(node, op=COMBINED[type(op)]())
        case ast.BoolOp(op=op):
            yield _with(node, op=JOINED[type(op)]())
        case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
            yield operand
        case ast.Constant(value=bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(value=int(value)):
            yield ast.Constant(value + 1)
        case ast.Constant(value=float(value)):
            yield ast.Constant(1.1 * value or 1.0)
        case ast.Call(func=ast.Name(id="abs"), args=[argument]):
            yield argument
        case ast.Call(func=ast.Name(id=name)) if name in SWAPPED:
            yield _with(node, func=ast.Name(SWAPPED[name], ast.Load()))
        case ast.Call(args=[first, second, *rest]):
            yield _with(node, args=[second, first, *rest])
    if _is_verdict(node, function):
        yield ast.UnaryOp(ast.Not(), node)


def _is_verdict(node: ast.expr, function: ast.FunctionDef) -> bool:
    """Whether the function returns this truth value, and no other change inverts it."""
    returns = isinstance(function.returns, ast.Name) and function.returns.id == "bool"
    returned = any(isinstance(each, ast.Return) and each.value is node for each in ast.walk(function))
    return returns and returned and not isinstance(node, ast.Compare | ast.Constant)


def _with(node: ast.expr, **fields: object) -> ast.expr:
    changed = copy.copy(node)
    for name, value in fields.items():
        setattr(changed, name, value)
    return changed


def _made(file: Path, tree: ast.Module, name: str, node: ast.expr, changed: ast.expr) -> Mutant:
    swap = _Swap(node, changed)
    module = ast.fix_missing_locations(swap.visit(copy.copy(tree)))
    code = _code_of(compile(module, str(file), "exec"), name)
    swap.back()
    return Mutant(file, node.lineno, ast.unparse(node), ast.unparse(changed), name, code)


class _Swap(ast.NodeTransformer):
    """Put one node in the place of another, and back."""

    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old, self.new = old, new
        self.place: tuple[ast.AST, str, int | None] | None = None

    def generic_visit(self, node: ast.AST) -> ast.AST:
        for field, value in ast.iter_fields(node):
            for index, each in enumerate(value) if isinstance(value, list) else [(None, value)]:
                if each is self.old:
                    self.place = node, field, index
                    self._put(ast.copy_location(self.new, self.old))
                    return node
                if isinstance(each, ast.AST) and self.place is None:
                    self.generic_visit(each)
        return node

    def back(self) -> None:
        self._put(self.old)

    def _put(self, node: ast.AST) -> None:
        assert self.place is not None
        parent, field, index = self.place
        if index is None:
            setattr(parent, field, node)
        else:
            getattr(parent, field)[index] = node


def _code_of(code: CodeType, name: str) -> CodeType:
    """The code of the function of this qualified name."""
    inside = [each for each in code.co_consts if isinstance(each, CodeType)]
    found = [each for each in inside if each.co_qualname == name]
    return found[0] if found else next(filter(None, (_found(each, name) for each in inside)))


def _found(code: CodeType, name: str) -> CodeType | None:
    try:
        return _code_of(code, name)
    except StopIteration:
        return None
