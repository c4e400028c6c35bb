"""Python interpreters of this machine by version: on PATH, and those of pyenv, uv and the py launcher."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ASK = "import ensurepip, sys, venv; print('%d.%d' % sys.version_info[:2], sys.executable)"
"""An interpreter that cannot make environments is of no use here."""


def interpreter(version: str) -> Path | None:
    """The first interpreter of a version, "3.12" say, that answers and can make environments."""
    for command in _candidates(version):
        done = subprocess.run([*command, "-c", ASK], capture_output=True, text=True)
        told, _, where = done.stdout.strip().partition(" ")
        if done.returncode == 0 and told == version:
            return Path(where)
    return None


def _candidates(version: str) -> Iterator[list[str]]:
    """Commands that may be this interpreter; each is asked which version it is."""
    yield [sys.executable]
    versions = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv") / "versions"
    for folder in sorted(versions.glob(f"{version}.*"), reverse=True):
        yield [str(folder / "bin" / "python")]
    for name in (f"python{version}", "python3", "python"):
        if found := shutil.which(name):
            yield [found]
    if launcher := shutil.which("py"):
        yield [launcher, f"-{version}"]
    if uv := shutil.which("uv"):
        done = subprocess.run(
            [uv, "python", "find", version, "--no-python-downloads"], capture_output=True, text=True
        )
        if done.returncode == 0:
            yield [done.stdout.strip()]
