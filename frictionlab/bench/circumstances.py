"""Machine, date and versions of what is measured."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from typing import Any

from frictionlab import __version__
from frictionlab.bench.peers.listing import PEERS
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
