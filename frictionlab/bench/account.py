"""What a folder of bench results holds, when, where and with what it was measured: its file ``bench.json``."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

from frictionlab import __version__
from frictionlab.bench.peers.listing import PEERS
from frictionlab.bench.sections import SectionResult, file_stem
from frictionlab.runner.files import write_whole
from frictionlab.runner.machine import cores, machine_and_versions

PRINTED = ("numpy", "numba", "scipy")
"""Packages in the small print of a chart, besides the peers."""


@cache
def circumstances() -> dict[str, Any]:
    """Machine, date and versions, of the peers, too."""
    packages = [*PRINTED, *(peer.package for peer in PEERS.values())]
    found = machine_and_versions(dict.fromkeys(packages))
    day = datetime.now(UTC).strftime("%Y-%m-%d")
    return {"frictionlab": __version__, "date": day, "cores": cores(), **found}


def small_print() -> str:
    """Machine, date and versions in a line."""
    return print_of(circumstances())


def print_of(told: Mapping[str, Any]) -> str:
    """Machine, date and versions of an entry in a line."""
    versions = {"frictionlab": told["frictionlab"], "Python": told["python"], **told["packages"]}
    packages = ", ".join(f"{name} {number}" for name, number in versions.items())
    return f"{told['processor']}, {told['cores']} cores; {told['date']}; {packages}"


ACCOUNT = "bench.json"
ENTRY_KEYS = {
    *("kind", "name", "title", "notes", "missing", "summary", "tables", "pictures"),
    *("frictionlab", "date", "cores", "python", "platform", "processor", "packages"),
}
"""What the page asks of an entry; one without them is another version's."""


def entry_of(measured: SectionResult, tables: Sequence[Path], pictures: Sequence[Any]) -> dict[str, Any]:
    """The entry of a curve or section: its files, and what is said of it."""
    return {
        "kind": measured.kind,
        "name": measured.name,
        "title": measured.title,
        "notes": measured.notes,
        "missing": dict(measured.left_out or {}),
        "summary": measured.summary(),
        "tables": [path.name for path in tables if path.suffix == ".csv"],
        "pictures": [picture._asdict() for picture in pictures],
        **circumstances(),
    }


def read_account(folder: Path) -> dict[str, dict[str, Any]]:
    """The entries of a folder by the stem of their files; none where it has no account that can be read."""
    try:
        found = json.loads((folder / ACCOUNT).read_text(encoding="utf-8"))
        entries = {str(stem): dict(entry) for stem, entry in found["parts"].items()}
        return {stem: entry for stem, entry in entries.items() if entry.keys() >= ENTRY_KEYS}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def add_to_account(folder: Path, entries: Sequence[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Put entries into the account of a folder, in place of older ones of the same name; all of them.

    Raises SaveError.
    """
    parts = read_account(folder) | {file_stem(entry["name"]): entry for entry in entries}
    write_whole(folder / ACCOUNT, (json.dumps({"parts": parts}, indent=1) + "\n").encode())
    return parts
