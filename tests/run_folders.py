"""Folders of runs as they are found: of an earlier version, with other numbers put in, or of a run cut short."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import frictionlab as fl
from frictionlab.runner import engine, study_run


def without_stamps(folder: Path) -> None:
    """Leave lengths and checksum out of the account: what is put in its files is then taken as theirs."""
    account = json.loads((folder / "provenance.json").read_text())
    account |= {"files": {}, "table": ""}
    (folder / "provenance.json").write_text(json.dumps(account))


def interrupted_after_one_piece(study: Any, out: Path) -> fl.Run:
    """Return what came of a run that is interrupted once one of its pieces is solved."""

    def collect_one(sent: Any, left: Any, *others: Any) -> None:
        collect(sent, list(left)[:1], *others)
        raise KeyboardInterrupt

    collect = engine.Sent.collect
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(engine.Sent, "collect", collect_one)
        with pytest.raises(study_run.Interrupted) as caught:
            fl.run(study, out=out)
    return caught.value.run
