"""Lets the tests of a checkout see the plugins without installing them, by the door they enter when installed.

The battery of checks that each plugin's law must pass takes minutes: it is in the deep profile.
"""

from __future__ import annotations

import os
import sys
import tempfile
import tomllib
from pathlib import Path

FOLDERS = sorted(path.parent for path in Path(__file__).parent.glob("plugins/*/pyproject.toml"))
collect_ignore_glob = (
    [] if os.environ.get("HYPOTHESIS_PROFILE") == "deep" else ["plugins/*/test_*_conforms.py"]
)
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
