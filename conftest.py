"""Profiles of the tests, and the plugins of this checkout seen without installing them.

The default profile draws the same examples on every machine and in every run. ``HYPOTHESIS_PROFILE=deep`` draws fresh
ones by the hundred, and runs every test. Plugins enter by the door they use when installed.
"""

from __future__ import annotations

import contextlib
import gc
import os
import signal
import sys
import tempfile
import tomllib
from importlib import import_module
from pathlib import Path

import hypothesis
import pytest
from profiles import DEEP, by_default

# A shell that runs the tests in the background has them ignore interrupts, and every command that they start too.
signal.signal(signal.SIGINT, signal.default_int_handler)
# The tests ask so much of every kernel that it is compiled in the end: Python would only run it before that.
os.environ.setdefault("FRICTIONLAB_COMPILE", "always")
hypothesis.settings.register_profile("default", max_examples=10, deadline=None, derandomize=True)
hypothesis.settings.register_profile(
    "deep", max_examples=500, deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE") or "default")
# Newer hypothesis also draws numbers that it reads in whichever modules are loaded: no test may depend on those.
with contextlib.suppress(ImportError):
    import_module("hypothesis.internal.conjecture.providers").is_local_module_file = lambda path: False

FOLDERS = sorted(path.parent for path in Path(__file__).parent.glob("plugins/*/pyproject.toml"))
DOORS = tempfile.TemporaryDirectory(prefix="frictionlab-doors-")


def _open_door(folder: Path) -> None:
    """Write what ``pip install --editable`` would: the entry points beside the name of the package."""
    project = tomllib.loads((folder / "pyproject.toml").read_text())["project"]
    about = Path(DOORS.name) / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    )
    lines = [
        f"[{group}]\n" + "".join(f"{name} = {target}\n" for name, target in doors.items())
        for group, doors in project["entry-points"].items()
    ]
    (about / "entry_points.txt").write_text("\n".join(lines))


for _folder in FOLDERS:
    _open_door(_folder)
sys.path[:0] = [DOORS.name, *map(str, FOLDERS)]


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out of the default run what only the deep profile runs."""
    kept = items if DEEP else by_default(items)
    own = set(kept)
    config.hook.pytest_deselected(items=[item for item in items if item not in own])
    items[:] = kept


def pytest_collection_finish() -> None:
    """Keep searches for garbage from all that collecting the tests has made."""
    gc.collect()
    gc.freeze()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the machine where a test failed: processors round differently."""
    if terminalreporter.stats.get("failed") or terminalreporter.stats.get("error"):
        from processor import this_machine

        terminalreporter.write_line(f"Please report it with this line: {this_machine()}")


@pytest.fixture
def without_kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of kernels of a test: nothing compiled."""
    from frictionlab.compile import cache, call, law_addresses

    monkeypatch.setenv("FRICTIONLAB_CACHE", str(tmp_path / "kernels"))
    monkeypatch.setattr(call, "_ready", set())
    monkeypatch.setattr(call, "_spent", {})
    monkeypatch.setattr(call._choice, "always_compile", False)
    monkeypatch.delenv("FRICTIONLAB_COMPILE", raising=False)
    cache._entry.cache_clear()
    law_addresses.by_address.cache_clear()
    return tmp_path / "kernels"
