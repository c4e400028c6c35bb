"""The drawing of the house: who may import whom, and what comes in from outside where."""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import frictionlab
from frictionlab import registry

HOUSE = Path(frictionlab.__file__).parent
PROJECT = HOUSE.parent

# Rooms, from the ground up. A module belongs to the room that names it, or else to the room of its package.
ROOMS = {
    "numbers": ["quantities"],
    "law interface": ["laws.base", "laws.bristle", "laws.fall", "laws.memory", "laws.stribeck_bristle"],
    "laws": ["laws"],
    "scene": ["scene", "dimensional"],
    "faults": ["faults"],
    "kernel": ["kernel", "kernel_parts"],
    "theory": ["theory"],
    "shape": ["shape", "course", "monotone"],
    "method interface": ["methods.base"],
    "orbit": ["orbit"],
    "steppers": ["methods.steppers"],
    "methods": ["methods"],
    "bibliography": ["bibliography"],
    "registry": ["registry", "doors", "trial"],
    "columns": ["columns"],
    "study": ["study"],
    "run": [
        *("runner", "chunks", "collecting", "solving", "gathering", "derived", "table", "output", "expect"),
        *("curve_table", "curve_ends", "bristle_hold"),
        *(
            "progress",
            "state",
            "plan",
            "failures",
            "summary",
            "sentences",
            "batch",
            "yaml_text",
            "saved",
            "new_study",
            "new_law",
        ),
    ],
    "charts": ["charts", "families", "symbols"],
    "peers": ["peers"],
    "bench": ["bench"],
    "bench chart": ["bench.chart"],
    "report": ["report"],
    "listing": ["listing"],
    "testing": ["testing"],
    "command line": ["cli"],
}

# room -> the rooms it may import. Modules of one room may import each other, but no law imports another law.
ARROWS = {
    "numbers": [],
    "law interface": ["numbers"],
    "laws": ["law interface"],
    "scene": ["numbers"],
    "faults": ["law interface"],
    "kernel": ["law interface", "faults"],
    "theory": ["scene"],
    "shape": [],
    "method interface": ["law interface", "numbers", "scene"],
    "orbit": ["kernel", "scene", "method interface"],
    "steppers": ["kernel"],
    "methods": ["steppers", "method interface", "scene", "orbit", "theory", "kernel", "law interface"],
    "bibliography": [],
    "registry": ["law interface", "method interface", "bibliography", "faults"],
    "columns": [],
    "study": ["scene", "registry", "columns", "numbers", "law interface", "method interface", "faults"],
    "run": [
        *("study", "registry", "orbit", "theory", "shape", "columns", "scene", "faults"),
        *("law interface", "method interface"),
    ],
    "charts": ["theory", "columns"],
    "peers": ["law interface", "method interface", "scene", "numbers", "kernel"],
    "bench": [
        *("peers", "run", "study", "methods", "kernel", "columns", "scene"),
        *("law interface", "method interface"),
    ],
    "bench chart": ["bench", "charts", "run"],
    "report": ["charts", "run", "study", "registry", "columns", "scene", "bibliography"],
    "listing": ["registry", "law interface", "method interface", "bibliography", "run", "faults"],
    "testing": [
        *("listing", "registry", "methods", "laws", "kernel", "scene", "faults"),
        *("law interface", "method interface"),
    ],
    "command line": [
        *("report", "charts", "bench chart", "bench", "run", "study", "registry", "listing", "testing"),
        *("law interface", "method interface", "bibliography", "faults"),
    ],
}

# what is not Python's own -> the rooms that may bring it in
OUTSIDE = {
    "pydantic": [
        "numbers",
        "laws",
        "law interface",
        "scene",
        "method interface",
        "methods",
        "registry",
        "study",
        "peers",
        "testing",
    ],
    "numpy": [
        "kernel",
        "theory",
        "shape",
        "method interface",
        "orbit",
        "steppers",
        "methods",
        "study",
        "run",
        "charts",
        "peers",
        "bench",
        "testing",
    ],
    "hypothesis": ["testing"],
    "numba": ["kernel", "peers"],  # the peers' integrators are called with numba's C functions
    "llvmlite": ["kernel"],
    "ruamel": ["study", "run"],
    "pandas": ["run", "charts", "report", "command line"],
    "pyarrow": ["run"],
    "matplotlib": ["charts", "bench chart"],
    "scipy": ["peers"],
    "heyoka": ["peers"],
    "numbalsoda": ["peers"],
    "jinja2": ["report"],
    "markupsafe": ["report"],
    "click": ["command line"],
}

LAWS_MAY_USE = {"__future__", "math", "cmath", "typing", "pydantic"}
FILES = {"os", "io", "pathlib", "shutil", "tempfile"}
BELOW_FILES = [
    "numbers",
    "law interface",
    "laws",
    "scene",
    "theory",
    "shape",
    "orbit",
    "steppers",
    "methods",
    "registry",
]


def _module(path: Path) -> str:
    return ".".join(path.relative_to(HOUSE).with_suffix("").parts).removesuffix(".__init__")


MODULES = {
    _module(path): path for path in sorted(HOUSE.rglob("*.py")) if path.parent != HOUSE or path.stem[0] != "_"
}


def _room(module: str) -> str:
    while module:
        for room, members in ROOMS.items():
            if module in members:
                return room
        module = module.rpartition(".")[0]
    return ""


def _imports(path: Path) -> Iterator[str]:
    """Every module a file imports, inside functions too, by its full name."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute here"
            assert node.module is not None
            yield from (_target(node.module, alias.name) for alias in node.names)


def _target(package: str, name: str) -> str:
    """The submodule a ``from package import name`` loads, if it is one, else the package."""
    inner = f"{package}.{name}".removeprefix("frictionlab.")
    return f"frictionlab.{inner}" if inner in MODULES else package


def _inside(path: Path) -> list[str]:
    return [name.removeprefix("frictionlab.") for name in _imports(path) if name.startswith("frictionlab.")]


def _outside(path: Path) -> set[str]:
    return {name.partition(".")[0] for name in _imports(path)} - {"frictionlab"}


@pytest.mark.parametrize("module", MODULES)
def test_every_module_has_a_room(module: str) -> None:
    assert _room(module), f"{module}: draw it in ROOMS"


def test_every_arrow_leads_to_a_room() -> None:
    assert set(ARROWS) == set(ROOMS)
    assert {room for rooms in [*ARROWS.values(), *OUTSIDE.values()] for room in rooms} <= set(ROOMS)


@pytest.mark.parametrize("module", MODULES)
def test_imports_follow_the_drawn_arrows(module: str) -> None:
    room = _room(module)
    stray = [name for name in _inside(MODULES[module]) if _room(name) not in (room, *ARROWS.get(room, []))]

    assert not stray, f"{module} ({room}) imports {', '.join(stray)}"


def test_arrows_point_one_way() -> None:
    above = {room: set(rooms) for room, rooms in ARROWS.items()}
    for _ in ROOMS:
        above = {room: rooms.union(*(above[other] for other in rooms)) for room, rooms in above.items()}

    assert [room for room, rooms in above.items() if room in rooms] == []


@pytest.mark.parametrize("module", [name for name in MODULES if _room(name) == "laws"])
def test_a_law_knows_the_law_interface_and_mathematics_alone(module: str) -> None:
    assert {_room(name) for name in _inside(MODULES[module])} <= {"law interface"}
    assert _outside(MODULES[module]) <= LAWS_MAY_USE


@pytest.mark.parametrize("module", MODULES)
def test_what_comes_from_outside_comes_in_where_it_is_drawn(module: str) -> None:
    foreign = _outside(MODULES[module]) - sys.stdlib_module_names
    stray = [name for name in foreign if _room(module) not in OUTSIDE.get(name, [])]

    assert not stray, f"{module} ({_room(module)}) imports {', '.join(stray)}"


@pytest.mark.parametrize("module", [name for name in MODULES if _room(name) in BELOW_FILES])
def test_nothing_below_the_study_touches_files(module: str) -> None:
    assert not _outside(MODULES[module]) & FILES


def test_importing_the_package_brings_in_nothing_heavy() -> None:
    assert list(_inside(HOUSE / "__init__.py")) == []
    assert _outside(HOUSE / "__init__.py") <= sys.stdlib_module_names


@pytest.mark.parametrize("name", frictionlab.__all__)
def test_every_public_name_can_be_imported_and_is_listed(name: str) -> None:
    assert getattr(frictionlab, name) is not None
    assert name in dir(frictionlab)


def test_a_name_that_is_not_public_is_refused_by_name() -> None:
    with pytest.raises(AttributeError, match=r"frictionlab.*'no_such_name'"):
        frictionlab.no_such_name  # noqa: B018


@pytest.mark.parametrize("module", MODULES)
def test_every_module_can_be_imported(module: str) -> None:
    importlib.import_module(f"frictionlab.{module}")


@pytest.mark.parametrize("name", registry.law_names())
def test_every_law_behind_an_entry_point_loads(name: str) -> None:
    law = registry.law_class(name)

    assert law.__name__.lower() == {"dupont": "elasto-plastic"}.get(name, name).replace("-", "")


@pytest.mark.parametrize("name", registry.method_names())
def test_every_method_behind_an_entry_point_loads_under_its_own_name(name: str) -> None:
    method = registry.method_class(name)()

    assert method.name == name


def test_there_are_laws_and_methods_behind_the_entry_points() -> None:
    assert "coulomb" in registry.law_names()
    assert {"auto", "exact", "shooting"} <= set(registry.method_names())


WRITTEN = [
    path
    for pattern in (
        "frictionlab/**/*.py",
        "tests/**/*.py",
        "tests/**/*.md",
        "plugins/**/*.py",
        "plugins/**/*.md",
        "plugins/**/*.yaml",
        "studies/*.yaml",
        "docs/**/*.md",
        "*.md",
    )
    for path in PROJECT.glob(pattern)
]


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: str(path.relative_to(PROJECT)))
def test_nothing_speaks_of_places_outside_the_project(path: Path) -> None:
    text = path.read_text()

    assert [place for place in ("../" + "shared", "/" + "work/", "/" + "tmp/venv") if place in text] == []
