"""The drawing of the house: who may import whom, and what comes in from outside where."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from profiles import deep

import frictionlab
from frictionlab.methods.base import REDUCED_MODELS, ReducedModel
from frictionlab.study import registry

HOUSE = Path(frictionlab.__file__).parent
PROJECT = HOUSE.parent

# The rooms are the folders of the package, and those of its methods, from the ground up. room -> the rooms it may
# import. Modules of one room may import each other, but no law another law.
ARROWS = {
    room: below.split()
    for room, below in {
        "values": "",
        "laws": "values",
        "scene": "values",
        "compile": "laws",
        "theory": "laws scene values",
        "motion": "compile laws scene values",
        "methods": "compile laws motion scene theory values",
        "tools": "compile motion scene theory",
        "study": "laws methods scene values",
        "curves": "laws methods motion scene theory values",
        "runner": "compile curves laws methods motion scene study theory values",
        "charts": "scene study theory values",
        "testing": "compile laws methods motion scene study",
        "report": "charts methods runner scene study values",
        "analysis": "charts compile curves laws methods motion report runner scene study theory values",
        "bench": "charts compile laws methods motion report runner scene study theory values",
        "cli": "analysis bench charts laws methods report runner study testing values",
    }.items()
}
INSIDE_METHODS = {
    room: below.split()
    for room, below in {
        "words": "",
        "base": "",
        "under_way": "",
        "periodic": "words",
        "prescribed": "base periodic under_way words",
        "shooting": "base periodic prescribed under_way words",
        "exact": "base prescribed shooting words",
        "reduced": "base exact prescribed shooting words",
        "march": "base periodic reduced shooting under_way",
        "auto": "base exact shooting words",
    }.items()
}
ROOMS = list(ARROWS)

# what is not Python's own -> the rooms that may bring it in
OUTSIDE = {
    package: rooms.split()
    for package, rooms in {
        "pydantic": "values laws scene methods study bench testing",
        "numpy": (
            "values laws.base scene compile theory motion methods study curves runner charts testing report "
            "analysis bench"
        ),
        "hypothesis": "testing",
        "numba": "compile bench.peers",  # the peers' integrators are called with numba's C functions
        "llvmlite": "compile",
        "filelock": "compile runner",
        "pint": "values.units",
        "ruamel": "study runner",
        "pandas": "values.units runner charts report analysis bench cli",
        "xarray": "report",
        "pyarrow": "runner",
        "tqdm": "runner",  # inside a function: it is used by long runs alone
        "matplotlib": "charts report.run bench.charts bench.page",  # of run the type of a figure
        # inside functions alone: nothing imports it before it is needed
        "distributed": "runner",
        "scipy": "theory motion methods.reduced curves runner analysis bench.peers",
        "heyoka": "bench.peers",
        "jinja2": "report",
        "markupsafe": "report",
        "click": "cli",
    }.items()
}

LAWS_MAY_USE = {"__future__", "math", "cmath", "typing", "pydantic"}
FILES = {"os", "io", "pathlib", "shutil", "tempfile"}
READ_FILES = {"laws.faults", "scene.receptance", "scene.waveforms", "values.notes"}
"""Files that read what a scene or a study names, and the lines of a law that failed."""
BELOW_FILES = ["values", "laws", "scene", "theory", "motion", "methods", "curves"]


def _module(path: Path) -> str:
    return ".".join(path.relative_to(HOUSE).with_suffix("").parts).removesuffix(".__init__")


MODULES = {
    _module(path): path for path in sorted(HOUSE.rglob("*.py")) if path.parent != HOUSE or path.stem[0] != "_"
}


def _room(module: str) -> str:
    """The folder a module lies in."""
    return module.partition(".")[0]


def _room_of_methods(module: str) -> str:
    """The folder or file inside ``methods`` a module lies in, else ''."""
    first, _, rest = module.partition(".")
    return rest.partition(".")[0] if first == "methods" else ""


def _lies_in(module: str, places: list[str]) -> bool:
    return any(f"{module}.".startswith(f"{place}.") for place in places)


@cache
def _imports(path: Path) -> list[str]:
    """Every module a file imports, inside functions too, by its full name."""
    return list(_imported(ast.parse(path.read_text()), path))


def _imported(parsed: ast.Module, path: Path) -> Iterator[str]:
    for node in ast.walk(parsed):
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


def test_every_folder_is_a_room() -> None:
    assert {_room(module) for module in MODULES} == {*ROOMS}
    assert {_room_of_methods(module) for module in MODULES} == {"", *INSIDE_METHODS}


def test_nothing_lies_beside_the_folders() -> None:
    assert sorted(path.name for path in HOUSE.glob("*.py")) == ["__init__.py", "__main__.py"]


def test_every_arrow_leads_down() -> None:
    for arrows in (ARROWS, INSIDE_METHODS):
        order = list(arrows)
        for above, below in arrows.items():
            assert [room for room in below if order.index(room) >= order.index(above)] == [], above


@deep("reads all sources")
def test_no_files_import_each_other_in_a_circle() -> None:
    graph = {module: {*_inside(path)} - {module} for module, path in MODULES.items()}

    assert len(list(TopologicalSorter(graph).static_order())) >= len(
        graph
    )  # else CycleError, with the circle


def _used(named: Callable[[str], str]) -> dict[str, set[str]]:
    """The rooms that each room imports, by the function that names the room of a module."""
    used: dict[str, set[str]] = defaultdict(set)
    for module, path in MODULES.items():
        room = named(module)
        used[room] |= {named(name) for name in _inside(path)} - {room, ""}
    return {room: used[room] for room in used if room}


def test_imports_are_the_drawn_arrows() -> None:
    assert _used(_room) == {room: set(below) for room, below in ARROWS.items()}
    assert _used(_room_of_methods) == {room: set(below) for room, below in INSIDE_METHODS.items()}


LAW_INTERFACE = {
    *("laws.base", "laws.memory", "laws.faults"),
    *("laws.compliant", "laws.decay", "laws.stribeck_bristle"),
}


def test_a_law_knows_the_law_interface_and_mathematics_alone() -> None:
    laws = [name for name in MODULES if _room(name) == "laws" and name not in {"laws", *LAW_INTERFACE}]
    for module in laws:
        assert {name for name in _inside(MODULES[module]) if name != "values.quantities"} <= LAW_INTERFACE, (
            module
        )
        assert _outside(MODULES[module]) <= LAWS_MAY_USE, module


def test_what_comes_from_outside_comes_in_where_it_is_drawn() -> None:
    stray = [
        f"{module} ({_room(module)}) imports {name}"
        for module, path in MODULES.items()
        for name in _outside(path) - sys.stdlib_module_names
        if not _lies_in(module, OUTSIDE.get(name, []))
    ]

    assert stray == []


def test_drawing_does_not_load_pyplot() -> None:
    assert [module for module, path in MODULES.items() if "matplotlib.pyplot" in _imports(path)] == []


def test_nothing_below_the_study_touches_files() -> None:
    """But for the receptance of a body and a waveform, which a scene names by their files."""
    below = [name for name in MODULES if _lies_in(name, BELOW_FILES) and name not in READ_FILES]

    assert [module for module in below if _outside(MODULES[module]) & FILES] == []


def test_importing_the_package_brings_in_nothing_heavy() -> None:
    assert list(_inside(HOUSE / "__init__.py")) == []
    assert _outside(HOUSE / "__init__.py") <= sys.stdlib_module_names
    code = "import sys; before = {*sys.modules}; import frictionlab; print(*{*sys.modules} - before)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert {"importlib.metadata", "numpy", "scipy", "pydantic"}.isdisjoint(loaded.split())


HEAVY = "hypothesis", "matplotlib", "pandas", "pint", "pyarrow", "tqdm"


@deep("processes")
def test_tables_figures_and_drawn_examples_are_imported_where_they_are_needed() -> None:
    """A fresh interpreter: a steady state needs no table, a study no figure, and neither needs hypothesis."""
    steps = {
        "import frictionlab as fl": "",
        "scene = fl.Scene(slip=fl.Slip(velocity_amplitude=2, frequency=1), belt_speed=1)": "",
        "fl.steady_state(scene, fl.Coulomb(mu=0.4))": "",
        "import frictionlab.cli, frictionlab.study.load": "",
        "fl.run, fl.curve": "pandas pyarrow",
    }
    seen = f"import sys\ndef seen(): print(*(name for name in {HEAVY} if name in sys.modules))\n"
    code = seen + "".join(f"{step}\nseen()\n" for step in steps)
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout

    assert told.splitlines() == list(steps.values())


def test_every_public_name_can_be_imported_and_is_listed() -> None:
    for name in frictionlab.__all__:
        assert getattr(frictionlab, name) is not None
        assert name in dir(frictionlab)


def test_a_name_that_is_not_public_is_refused_by_name() -> None:
    with pytest.raises(AttributeError, match=r"frictionlab.*'no_such_name'"):
        frictionlab.no_such_name  # noqa: B018


def test_every_module_can_be_imported() -> None:
    for module in MODULES:
        importlib.import_module(f"frictionlab.{module}")


def test_every_law_and_method_behind_an_entry_point_loads_under_its_own_name() -> None:
    assert "coulomb" in registry.law_names()
    assert {"auto", "exact", "shooting"} <= set(registry.method_names())
    for name in registry.law_names():
        written = {"dupont": "elasto-plastic"}.get(name, name).replace("-", "")
        assert registry.law_class(name).__name__.lower() == written
    for name in registry.method_names():
        method = registry.method_class(name)
        assert method().name == name
        assert issubclass(method, ReducedModel) == (name in REDUCED_MODELS)


WRITTEN = [
    path
    for pattern in (
        "frictionlab/**/*.py",
        "tests/**/*.py",
        "tests/**/*.md",
        "plugins/**/*.py",
        "plugins/**/*.md",
        "plugins/**/*.yaml",
        "studies/**/*.yaml",
        "docs/**/*.md",
        "*.md",
    )
    for path in PROJECT.glob(pattern)
]


def test_nothing_speaks_of_places_outside_the_project() -> None:
    places = "../" + "shared", "/" + "work/", "/" + "tmp/venv"

    assert [path for path in WRITTEN if any(place in path.read_text() for place in places)] == []
