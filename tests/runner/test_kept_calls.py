"""An interrupted run goes on from the calls that it had made, to the table of one that went through."""

from __future__ import annotations

import hashlib
import os
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab.methods import under_way
from frictionlab.methods.periodic.problem import Transient
from frictionlab.runner.api import Interrupted
from frictionlab.runner.chunks import KeptCalls

pytestmark = deep("seconds of runs")

LUGRE = {"kind": "lugre", "mu_kinetic": 0.3, "mu_static": 0.4, "stribeck_speed": 0.1, "stiffness": 100}
STICKING = {"kind": "coulomb", "mu": 0.3, "mu_static": 0.4}
DRIVEN = {"damping_ratio": 0.05, "normal_load": 1, "drive": {"unbalance": 0.5, "frequency": 1.5}}
STUDIES = {
    "driven": {"scene": DRIVEN, "laws": [LUGRE]},
    "undriven": {"scene": {"damping_ratio": 0.05, "normal_load": 1}, "laws": [STICKING]},
    "march": {"scene": DRIVEN, "laws": [LUGRE], "methods": [{"kind": "march", "steps": 1000}]},
}


def study(name: str) -> dict[str, Any]:
    speeds = {"sweep": {"scene.belt_speed": [0.02, 0.05, 0.3]}, "columns": ["all"]}
    return {"schema": 1, **STUDIES[name], **speeds}


class Disk:
    """Every call that is kept, and an interrupt at one of them."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.calls: list[str] = []
        self.last = 10**6
        keep = KeptCalls.keep

        def keep_until(kept: KeptCalls, digest: str, found: Any) -> None:
            if len(self.calls) >= self.last:
                raise KeyboardInterrupt
            self.calls.append(digest)
            keep(kept, digest, found)

        monkeypatch.setattr(under_way, "WORTH_KEEPING", -1.0)
        monkeypatch.setattr(KeptCalls, "keep", keep_until)

    def whole(self, given: dict[str, Any], out: Path) -> tuple[list[str], Any]:
        """The calls of a run that goes through, and its table."""
        self.calls, self.last = [], 10**6
        return self.calls, fl.run(given, out=out).table

    def interrupted(self, given: dict[str, Any], out: Path, last: int) -> None:
        """A run that ends at the call after so many."""
        self.calls, self.last = [], last
        with pytest.raises(Interrupted):
            fl.run(given, out=out)


@pytest.mark.parametrize("name", STUDIES)
def test_an_interrupted_run_makes_no_call_again_and_comes_to_the_same_numbers(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = Disk(monkeypatch)
    calls, table = disk.whole(study(name), tmp_path / "a" / "whole")
    half = max(1, len(calls) // 2)
    disk.interrupted(study(name), tmp_path / "b" / "cut", half)
    made = disk.calls
    left, again = disk.whole(study(name), tmp_path / "b" / "cut")

    assert len(made) == half < len(calls)
    assert made + left == calls
    assert_frame_equal(again.drop(columns="seconds"), table.drop(columns="seconds"), check_exact=True)
    assert not list(tmp_path.glob("*/.cache/*/*.calls"))


def test_a_damaged_call_is_made_again(tmp_path: Path) -> None:
    kept = KeptCalls(tmp_path / "ab" / "c.calls")
    found = Transient(2, np.array([0.1, 0.2]), np.eye(2), np.array([0.0, 1.0]), 0.5), 0.5
    kept.keep("d", found)
    back = kept.found("d")
    path = tmp_path / "ab" / "c.calls" / "d.call"
    path.write_bytes(path.read_bytes()[:-1])

    assert type(back[0]) is Transient
    np.testing.assert_equal(back, found)
    assert kept.found("d") is None
    assert kept.found("e") is None


def test_a_call_that_would_run_something_is_not_read(tmp_path: Path) -> None:
    class Runs:
        def __reduce__(self) -> Any:
            return os.mkdir, (str(tmp_path / "made"),)

    content = pickle.dumps((Runs(), 1.0))
    folder = tmp_path / "ab" / "c.calls"
    folder.mkdir(parents=True)
    (folder / "d.call").write_bytes(hashlib.sha256(content).digest() + content)

    assert KeptCalls(folder).found("d") is None
    assert not (tmp_path / "made").exists()
