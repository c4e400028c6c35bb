"""The drawing of the house: who may import whom, and what comes in from outside where."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from profiles import deep

import frictionlab
from frictionlab import registry
from frictionlab.methods.base import REDUCED_MODELS, ReducedModel

HOUSE = Path(frictionlab.__file__).parent
PROJECT = HOUSE.parent

# The rooms are the folders of the package, and those of its methods, from the ground up; a file beside the folders is
# one too. room -> the rooms it may import. Modules of one room may import each other, but no law another law.
ARROWS = {
    room: below.split()
    for room, below in {
        "printable": "",
        "mistakes": "printable",
        "quantities": "mistakes",
        "columns": "",
        "units": "columns mistakes quantities",
        "laws": "quantities units",
        "faults": "laws",
        "compile": "faults laws",
        "scene": "mistakes quantities units",
        "numerics": "compile quantities",
        "dynamics": "compile laws numerics quantities scene",
        "orbit": "columns compile dynamics laws quantities scene",
        "theory": "laws quantities scene",
        "shape": "laws quantities",
        "methods.words": "",
        "methods.base": "laws orbit quantities scene",
        "methods.under_way": "compile laws",
        "methods.periodic": (
            "compile dynamics laws methods.under_way numerics orbit quantities scene theory methods.words"
        ),
        "methods.prescribed": (
            "compile dynamics laws orbit quantities scene theory methods.base methods.periodic "
            "methods.under_way methods.words"
        ),
        "methods.shooting": (
            "compile dynamics laws orbit quantities scene theory methods.base methods.periodic "
            "methods.prescribed methods.under_way methods.words"
        ),
        "methods.refusals": "laws methods.shooting scene",
        "methods.exact": (
            "compile laws orbit quantities scene theory methods.base methods.prescribed methods.refusals "
            "methods.words"
        ),
        "methods.relay_locus": (
            "compile laws numerics orbit quantities scene theory methods.base methods.words"
        ),
        "methods.march": (
            "compile dynamics laws numerics orbit quantities scene theory methods.base methods.periodic "
            "methods.prescribed methods.refusals methods.shooting methods.under_way"
        ),
        "methods.reduced": (
            "compile dynamics laws numerics orbit quantities scene theory methods.base methods.exact "
            "methods.prescribed methods.refusals methods.shooting methods.words"
        ),
        "methods.auto": (
            "laws methods.base methods.exact methods.relay_locus methods.shooting orbit scene methods.words"
        ),
        "onsets": "laws methods.base methods.periodic orbit quantities scene theory",
        "registry": "faults laws methods.base mistakes",
        "study": "columns laws methods.base mistakes printable quantities registry scene units",
        "results": "columns laws methods.base orbit quantities registry scene shape study printable theory units",
        "runner": (
            "columns compile faults laws methods.base methods.under_way mistakes onsets orbit printable "
            "quantities registry results scene shape study theory units"
        ),
        "sensitivity": "laws methods.base methods.periodic mistakes quantities results runner scene study",
        "charts": "columns printable scene study theory units",
        "response": (
            "charts laws methods.prescribed orbit quantities results runner scene sensitivity theory"
        ),
        "report": "charts columns printable quantities registry results runner scene study units methods.words",
        "fitting": (
            "charts columns compile dynamics faults laws mistakes printable quantities "
            "report runner scene study theory"
        ),
        "notebook": "charts columns report results runner scene study units",
        "explore": "charts columns report results runner units",
        "scaffold": "registry runner",
        "bench": (
            "charts columns compile laws mistakes quantities runner scene study methods.base "
            "methods.exact methods.march methods.shooting numerics report results theory"
        ),
        "testing": "compile dynamics faults laws registry scene methods.march methods.shooting",
        "least_model": (
            "charts columns laws mistakes printable quantities registry results runner scene shape study "
            "methods.reduced theory units"
        ),
        "cli": (
            "bench charts columns explore faults fitting least_model printable registry report results "
            "runner scaffold study testing units methods.words"
        ),
    }.items()
}
ROOMS = list(ARROWS)

# what is not Python's own -> the rooms that may bring it in
OUTSIDE = {
    package: rooms.split()
    for package, rooms in {
        "pydantic": "mistakes quantities laws scene methods registry study bench testing",
        "numpy": (
            "quantities compile theory shape orbit numerics dynamics methods study onsets results runner "
            "scene charts notebook bench testing least_model sensitivity fitting response laws.arrays"
        ),
        "hypothesis": "testing",
        "numba": "compile bench.peers",  # the peers' integrators are called with numba's C functions
        "llvmlite": "compile",
        "filelock": "compile",
        "pint": "units.text",
        "flint": "methods.exact.proof",
        "ruamel": "study runner",
        "pandas": "results runner charts report notebook explore cli least_model sensitivity fitting units",
        "xarray": "notebook",
        "pyarrow": "results runner",
        "tqdm": "runner",  # inside a function: it is used by long runs in a notebook alone
        "matplotlib": "charts notebook.comparison bench.charts bench.pictures",  # of comparison the type of a figure
        # inside functions alone: nothing imports it before it is needed
        "distributed": "runner",
        "scipy": "theory numerics methods.reduced onsets fitting bench.peers",
        "heyoka": "bench.peers",
        "numbalsoda": "bench.peers",
        "jinja2": "report",
        "markupsafe": "report",
        "click": "cli",
    }.items()
}

LAWS_MAY_USE = {"__future__", "math", "cmath", "typing", "pydantic"}
FILES = {"os", "io", "pathlib", "shutil", "tempfile"}
BELOW_FILES = ["quantities", "laws", "scene", "theory", "shape", "orbit", "dynamics", "numerics", "methods"]


def _module(path: Path) -> str:
    return ".".join(path.relative_to(HOUSE).with_suffix("").parts).removesuffix(".__init__")


MODULES = {
    _module(path): path for path in sorted(HOUSE.rglob("*.py")) if path.parent != HOUSE or path.stem[0] != "_"
}


def _room(module: str) -> str:
    """The folder a module lies in, below ``methods`` the one inside it; a file beside the folders is its own."""
    first, _, rest = module.partition(".")
    return f"methods.{rest.partition('.')[0]}" if first == "methods" and rest else first


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
    assert {_room(module) for module in MODULES} == {*ROOMS, "methods"}


def test_few_files_lie_beside_the_folders() -> None:
    assert len(list(HOUSE.glob("*.py"))) <= 6


def test_every_arrow_leads_down() -> None:
    for above, below in ARROWS.items():
        assert [room for room in below if ROOMS.index(room) >= ROOMS.index(above)] == [], above


@deep("reads all sources")
def test_no_files_import_each_other_in_a_circle() -> None:
    graph = {module: {*_inside(path)} - {module} for module, path in MODULES.items()}

    assert len(list(TopologicalSorter(graph).static_order())) >= len(
        graph
    )  # else CycleError, with the circle


@deep("reads all sources")
def test_every_arrow_is_used() -> None:
    used: dict[str, set[str]] = {room: set() for room in ROOMS}
    for module, path in MODULES.items():
        if module != "methods":
            used[_room(module)] |= {_room(name) for name in _inside(path)}

    assert {room: set(below) - used[room] for room, below in ARROWS.items()} == {
        room: set() for room in ROOMS
    }


def test_imports_follow_the_drawn_arrows() -> None:
    stray = [
        f"{module} ({_room(module)}) imports {name}"
        for module, path in MODULES.items()
        for name in _inside(path)
        if _room(name) not in (_room(module), *ARROWS.get(_room(module), []))
    ]

    assert stray == []


LAW_INTERFACE = {
    *("laws.base", "laws.labelled", "laws.memory", "laws.arrays"),
    *("laws.compliant", "laws.decay", "laws.stribeck_bristle"),
}


def test_a_law_knows_the_law_interface_and_mathematics_alone() -> None:
    laws = [name for name in MODULES if _room(name) == "laws" and name not in {"laws", *LAW_INTERFACE}]
    for module in laws:
        assert {name for name in _inside(MODULES[module]) if name != "quantities"} <= LAW_INTERFACE, module
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
    """But for the receptance of a body, which a scene names by its file."""
    below = [name for name in MODULES if _lies_in(name, BELOW_FILES) and name != "scene.receptance_table"]

    assert [module for module in below if _outside(MODULES[module]) & FILES] == []


def test_importing_the_package_brings_in_nothing_heavy() -> None:
    assert list(_inside(HOUSE / "__init__.py")) == []
    assert _outside(HOUSE / "__init__.py") <= sys.stdlib_module_names
    code = "import sys; before = {*sys.modules}; import frictionlab; print(*{*sys.modules} - before)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert {"importlib.metadata", "numpy", "scipy", "pydantic"}.isdisjoint(loaded.split())


HEAVY = "hypothesis", "matplotlib", "pandas", "pint", "pyarrow"


@deep("processes")
def test_tables_figures_and_drawn_examples_are_imported_where_they_are_needed() -> None:
    """A fresh interpreter: a steady state needs no table, a study no figure, and neither needs hypothesis."""
    steps = {
        "import frictionlab as fl": "",
        "scene = fl.Scene(slip=fl.Slip(velocity_amplitude=2, frequency=1), belt_speed=1)": "",
        "fl.steady_state(scene, fl.Coulomb(mu=0.4))": "",
        "import frictionlab.cli, frictionlab.study": "",
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
