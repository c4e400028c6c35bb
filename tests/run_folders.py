"""Folders of runs as they are found: written by an earlier version, or with other numbers put into them."""

from __future__ import annotations

import json
from pathlib import Path


def without_stamps(folder: Path) -> None:
    """Leave lengths and checksum out of the account: what is put in its files is then taken as theirs."""
    account = json.loads((folder / "provenance.json").read_text())
    account |= {"files": {}, "table": ""}
    (folder / "provenance.json").write_text(json.dumps(account))
