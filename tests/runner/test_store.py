"""Solved chunks are found again by what they compute, and by nothing else."""

from __future__ import annotations

import json
import os
import time
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from fig_4b import COULOMB, LAW, SCENE, over_speeds
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner import store as code_digest
from frictionlab.runner.engine import solve_each
from frictionlab.runner.files import unfinished
from frictionlab.runner.packing import kept_of
from frictionlab.runner.pieces import Cut, Piece, Task
from frictionlab.runner.store import Keys, Store
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.parts import MethodChoice

pytestmark = deep("seconds of runs")

study = partial(over_speeds, {"start": 1, "stop": 30, "num": 300})
few = partial(over_speeds, [5.0, 30.0, 40.0, 60.0])


def counts(folder: Path) -> tuple[int, int]:
    """Points computed and found by the last run in a folder."""
    last = json.loads((folder / "provenance.json").read_text())["runs"][-1]
    return last["computed"], last["found"]


def of_law(table: pd.DataFrame, label: str) -> pd.DataFrame:
    """The rows of a law, without its name."""
    return table[table["law"] == label].reset_index(drop=True).drop(columns="law")


def test_a_chunk_is_found_by_another_study_with_other_labels_and_order(tmp_path: Path) -> None:
    first = fl.run(study(), out=tmp_path / "a")
    laws = [COULOMB | {"mu": 0.3}, COULOMB | {"label": "the same"}, COULOMB | {"label": "twin"}]
    other = fl.run(study(laws=laws, title="another", expect=[]), out=tmp_path / "b")
    alone = fl.run(study(laws=laws[1:]))

    assert counts(tmp_path / "a") == (300, 0)
    assert counts(tmp_path / "b") == (300, 600)
    assert alone.computed == 300
    for table, label in ((other.table, "the same"), (other.table, "twin"), (alone.table, "twin")):
        assert_frame_equal(of_law(table, label), of_law(first.table, "coulomb"), check_exact=True)


def test_kept_orbits_are_found_with_their_chunk_and_go_when_none_are_kept(tmp_path: Path) -> None:
    first = fl.run(few(keep={"orbit": 5}), out=tmp_path / "a")
    again = fl.run(few(keep={"orbit": 5}, title="again"), out=tmp_path / "b")

    assert again.computed == 0
    assert_frame_equal(again.orbits, first.orbits, check_exact=True)
    fl.run(few(), out=tmp_path / "a")
    assert fl.load(tmp_path / "a").orbits is None


EXACT = fl.Exact()


def piece(
    law: Any = LAW, method: Any = EXACT, scene: fl.Scene = SCENE, end: float = 2.0, **changes: Any
) -> Piece:
    """Two points of a curve."""
    scenes, rows = Scenes(scene, np.array([1.0, end])), np.arange(2)
    curve = StudyCurve("coulomb", "coulomb", law, MethodChoice.of(method), scenes, range(2))
    return Piece(**{"cuts": (Cut(curve, rows, rows),), "rows": rows, "task": Task(1e-8)} | changes)


def key(given: Piece, code: str = "") -> str:
    return Keys({"coulomb": code} if code else {}).of(given)


CHANGES: dict[str, dict[str, Any]] = {
    "law": {"law": fl.Coulomb(mu=0.4000001)},
    "kind of law": {"law": fl.Stribeck(mu_kinetic=0.4, mu_static=0.4)},
    "method": {"method": fl.Shooting()},
    "speeds": {"end": np.nextafter(2.0, 3.0)},
    "scene": {"scene": SCENE.with_(damping_ratio=0.2)},
    "start": {"scene": SCENE.with_(initial=fl.Initial())},
    "tolerance": {"task": Task(1e-9)},
    "orbits": {"task": Task(1e-8, samples=3, harmonics=2)},
    "columns": {"task": Task(1e-8, columns=frozenset({"mean_friction"}))},
}


@pytest.mark.parametrize("what", CHANGES)
def test_whatever_changes_the_numbers_changes_the_key(what: str) -> None:
    assert not key(piece(**CHANGES[what])).startswith("?")
    assert key(piece(**CHANGES[what])) != key(piece())


def test_other_code_changes_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    plain = key(piece())
    assert key(piece(), "edited") != plain
    monkeypatch.setattr(code_digest, "own_code", lambda: "edited")
    assert key(piece()) != plain


def test_rows_and_a_scale_change_no_key() -> None:
    si = {"mass_kg": 1.0, "stiffness_N_per_m": 1.0, "damping_N_s_per_m": 0.2, "length_m": 1.0}
    si |= {"normal_load_N": 10.0, "belt_speed_m_per_s": 1.0}
    si["drive"] = {"unbalance_kg_m": 10.0, "frequency_rad_per_s": 1.0}

    assert key(piece(rows=np.array([7, 3]))) == key(piece())
    assert key(piece(scene=fl.Scene(dimensional=si))) == key(piece())


class Mine(fl.Coulomb):
    """A law from somewhere else."""


class MyMethod(fl.Exact):
    """A method from somewhere else."""


@pytest.mark.parametrize("own", [{"law": Mine(mu=0.4)}, {"method": MyMethod()}])
def test_what_unknown_code_made_is_kept_in_memory_alone(own: dict[str, Any], tmp_path: Path) -> None:
    given, store = piece(**own), Store(tmp_path)
    store.put(key(given), solve_each(given.chunks()).answers)

    assert key(given).startswith("?")
    assert store.get(key(given)) is not None
    assert list(tmp_path.iterdir()) == []


KEY = "ab" + "0" * 62
TASK = Task(1e-8, samples=3, harmonics=2)


@cache
def solved() -> pa.Table:
    return solve_each(piece(task=TASK).chunks()).answers


def kept_one(folder: Path) -> tuple[Store, Path]:
    store = Store(folder)
    store.put(KEY, solved())
    (path,) = folder.rglob("*.parquet")
    return store, path


def damage(path: Path, at: int) -> None:
    content = bytearray(path.read_bytes())
    content[at % len(content)] ^= 1
    path.write_bytes(content)


def test_answers_come_back_bit_for_bit(tmp_path: Path) -> None:
    store, _ = kept_one(tmp_path)
    answers, again = solved(), store.get(KEY)

    assert again.column_names == answers.column_names == Store(tmp_path).columns(KEY)
    assert repr(again.to_pydict()) == repr(answers.to_pydict())
    assert kept_of(again, "orbits")["row"].tolist() == [0] * 3 + [1] * 3
    assert kept_of(again, "harmonics").equals(kept_of(answers, "harmonics"))


def test_a_damaged_file_is_noticed_or_does_no_harm(tmp_path: Path) -> None:
    """Bits that parquet has no checksum of lie in its account of columns, which is not read but for their places."""
    whole = repr(solved().to_pydict())
    for at in range(0, 8000, 137):
        store, path = kept_one(tmp_path)
        damage(path, at)
        found = store.get(KEY)
        assert found is None or repr(found.to_pydict()) == whole
        assert path.exists() == (found is not None)
        path.unlink(missing_ok=True)
    store, path = kept_one(tmp_path)
    path.write_bytes(path.read_bytes()[:-1])
    assert Store(tmp_path).columns(KEY) == []
    assert store.get(KEY) is None
    assert store.get("cd" + "0" * 62) is None


def test_a_file_in_the_place_of_another_is_not_taken_for_it(tmp_path: Path) -> None:
    _, path = kept_one(tmp_path)
    path.rename(path.with_stem("1" * 62))

    assert Store(tmp_path).get("ab" + "1" * 62) is None


def test_a_run_solves_what_was_damaged(tmp_path: Path) -> None:
    whole = fl.run(study(), out=tmp_path / "a").table
    damaged, *_ = (tmp_path / ".cache").rglob("*.parquet")
    damaged.write_bytes(b"")
    again = fl.run(study(), out=tmp_path / "b")

    assert again.computed == 150
    assert_frame_equal(again.table, whole, check_exact=True)


def test_those_used_longest_ago_are_removed_above_the_limit(tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    for tolerance in (1e-8, 1e-7):
        fl.run(study(tolerance=tolerance), cache=kept)
    files = sorted(kept.rglob("*.parquet"))
    for age, path in enumerate(files):
        os.utime(path, 2 * (time.time() - 1000.0 + age,))
    Store(kept, sum(path.stat().st_size for path in files[1:]) * 1.0001e-9).trim()

    assert sorted(kept.rglob("*.parquet")) == files[1:]
    fl.run(study(tolerance=1e-6), cache=kept, cache_gigabytes=0.0)
    assert len(list(kept.rglob("*.parquet"))) == 2  # those of the run itself


def test_what_a_killed_process_began_to_keep_is_removed(tmp_path: Path) -> None:
    store, path = kept_one(tmp_path)
    unfinished(path, 999999999).write_bytes(b"half")
    store.trim()

    assert list(path.parent.iterdir()) == [path]


def test_a_killed_run_goes_on_from_its_chunks(tmp_path: Path) -> None:
    def dies(done: int, total: int, *_how: Any) -> None:
        if done:
            raise MemoryError

    with ThreadPoolExecutor(1) as pool, pytest.raises(MemoryError):
        fl.run(study(), out=tmp_path / "a", executor=pool, progress=dies)
    assert not (tmp_path / "a" / "results.parquet").exists()
    again = fl.run(study(), out=tmp_path / "a")

    assert (again.computed, counts(tmp_path / "a")) == (150, (150, 150))


def test_a_cache_that_cannot_be_written_costs_nothing_but_itself(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")

    assert fl.run(study(), out=tmp_path / "a", cache=tmp_path / "file").counts == {"ok": 300}


def test_onsets_of_a_run_that_is_taken_over_are_its_own(tmp_path: Path) -> None:
    for out, mu in 2 * [("a", 0.4), ("b", 0.2)]:
        done = fl.run(few(laws=[COULOMB | {"mu": mu}]), out=tmp_path / out)
        assert set(done.onsets["law.mu"]) == {mu}
    assert done.computed == 0


def in_si(scale: float) -> dict[str, Any]:
    """Scenes that are one without dimensions, at every scale."""
    sizes: dict[str, Any] = {"mass": f"{scale} kg", "stiffness": f"{10 * scale} kN/m", "damping_ratio": 0.1}
    sizes |= {"normal_load": f"{10 * scale**2} N", "belt_speed": "1 m/s"}
    sizes["drive"] = {"amplitude": f"{5 * scale**2} N", "frequency": "12 Hz"}
    speeds = [f"{scale * speed} m/s" for speed in (0.04, 0.06, 0.1)]
    return study(scene={"dimensional": sizes}, sweep={"scene.dimensional.belt_speed": speeds})


ALIKE = {
    "labels": [few(laws=[COULOMB | {"label": each}]) for each in "ab"],
    "methods": [few(methods=[{"kind": "exact", "label": each}]) for each in "ab"],
    "lengths": [in_si(1.0), in_si(2.0)],
}


@pytest.mark.parametrize("what", ALIKE)
def test_onsets_of_found_pieces_have_the_labels_and_lengths_of_their_study(what: str, tmp_path: Path) -> None:
    for name, given in zip("ab", ALIKE[what], strict=True):
        found = fl.run(given, out=tmp_path / name).onsets

        assert len(found)
        assert_frame_equal(found, fl.run(given).onsets, check_exact=True)


@pytest.mark.parametrize("before", [0, 1])
def test_what_somebody_does_with_a_table_is_in_no_onsets(before: int, tmp_path: Path) -> None:
    for _ in range(before + 1):
        done = fl.run(few(), out=tmp_path / "a")
    done.table["status"] = "failed"

    for each in (done, fl.run(few(), out=tmp_path / "b")):
        assert len(each.onsets) == 3


def share_of(share: float) -> FrictionLaw:
    class Share(fl.SlidingLaw):
        mu: float

        def sliding_friction(self, slip_speed: float) -> float:
            return share * self.mu

    return Share(mu=0.4)


def test_laws_of_classes_that_one_function_makes_are_told_apart(tmp_path: Path) -> None:
    for share in (1.0, 0.5, 1.0):
        given = fl.Study.of(SCENE, share_of(share), sweep={"scene.belt_speed": [5, 25]})
        found = fl.run(given, out=tmp_path / str(share)).table
        assert_frame_equal(found, fl.run(given).table, check_exact=True)


def test_a_damaged_piece_is_solved_once(tmp_path: Path) -> None:
    fl.run(study(), out=tmp_path / "a")
    files = list((tmp_path / ".cache").rglob("*.parquet"))
    for path in files:
        damage(path, 40)  # in a page, not in the account of columns
    fl.run(study(), out=tmp_path / "b")

    assert all(Store(tmp_path / ".cache").get(path.parent.name + path.stem) is not None for path in files)


def test_two_classes_of_one_name_are_told_apart() -> None:
    with pytest.raises(TypeError, match="are two classes named 'Share'; rename one"):
        fl.compare(SCENE, {"one": share_of(1.0), "other": share_of(1.0)}, [5, 25])
