"""Solved chunks are found again by what they compute, and by nothing else."""

from __future__ import annotations

import json
import os
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner import store as code_digest
from frictionlab.runner.engine import solve_each
from frictionlab.runner.files import begun
from frictionlab.runner.packing import kept_of
from frictionlab.runner.pieces import Cut, Piece, Task
from frictionlab.runner.store import Keys, Store
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.parts import MethodChoice

pytestmark = deep("seconds of runs")

SCENE: dict[str, Any] = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5}
SCENE |= {"drive": {"unbalance": 10, "frequency": 1}}


def study(**changes: Any) -> dict[str, Any]:
    given = {"schema": 1, "scene": SCENE, "laws": [{"kind": "coulomb", "mu": 0.4}], "methods": ["exact"]}
    return given | {"sweep": {"scene.belt_speed": {"start": 1, "stop": 30, "num": 300}}} | changes


def counts(folder: Path) -> tuple[int, int]:
    """Points computed and found by the last run in a folder."""
    last = json.loads((folder / "provenance.json").read_text())["runs"][-1]
    return last["computed"], last["found"]


def test_a_chunk_is_found_by_another_study_with_other_labels_and_order(tmp_path: Path) -> None:
    first = fl.run(study(), out=tmp_path / "a")
    laws = [{"kind": "coulomb", "mu": 0.3}, {"kind": "coulomb", "mu": 0.4, "label": "the same"}]
    other = fl.run(study(laws=laws, title="another", expect=[]), out=tmp_path / "b")

    assert counts(tmp_path / "a") == (300, 0)
    assert counts(tmp_path / "b") == (300, 300)
    both = other.table[other.table["law"] == "the same"].reset_index(drop=True)
    assert_frame_equal(both.drop(columns="law"), first.table.drop(columns="law"), check_exact=True)


def test_kept_orbits_are_found_with_their_chunk(tmp_path: Path) -> None:
    speeds = {"sweep": {"scene.belt_speed": [1.0, 5.0, 9.0]}, "keep": {"orbit": 5}}
    first = fl.run(study(**speeds), out=tmp_path / "a")
    again = fl.run(study(**speeds, title="again"), out=tmp_path / "b")

    assert again.computed == 0
    assert first.orbits is not None
    assert again.orbits is not None
    assert_frame_equal(again.orbits, first.orbits, check_exact=True)


def test_a_run_that_keeps_no_orbits_leaves_none_of_an_earlier_one(tmp_path: Path) -> None:
    speeds = {"sweep": {"scene.belt_speed": [1.0, 5.0, 9.0]}}
    for keep in ({"keep": {"orbit": 5}}, {}):
        fl.run(study(**speeds, **keep), out=tmp_path / "a")

    assert fl.load(tmp_path / "a").orbits is None


def test_cases_that_compute_the_same_are_solved_once() -> None:
    laws = [{"kind": "coulomb", "mu": 0.4}, {"kind": "coulomb", "mu": 0.4, "label": "twin"}]
    done = fl.run(study(laws=laws))

    halves = [done.table[done.table["law"] == law] for law in ("coulomb", "twin")]
    one, other = (half.drop(columns="law").reset_index(drop=True) for half in halves)
    assert done.computed == 300
    assert_frame_equal(one, other, check_exact=True)


COULOMB, EXACT = fl.Coulomb(mu=0.4), fl.Exact()


def piece(
    law: FrictionLaw = COULOMB, method: Method = EXACT, scenes: Scenes | None = None, **changes: Any
) -> Piece:
    """Two points of a curve."""
    given = scenes or Scenes(fl.Scene.model_validate(SCENE), np.array([1.0, 2.0]))
    curve = StudyCurve("coulomb", "coulomb", law, MethodChoice.of(method), given, range(2))
    rows = np.arange(2)
    own = {"cuts": (Cut(curve, rows, rows),), "rows": rows, "task": Task(1e-8)} | changes
    return Piece(**own)


def key(given: Piece, code: str = "") -> str:
    return Keys({"coulomb": code} if code else {}).of(given)


OTHER = fl.Scene.model_validate(SCENE)
CHANGES: dict[str, dict[str, Any]] = {
    "law": {"law": fl.Coulomb(mu=0.4000001)},
    "kind of law": {"law": fl.Stribeck(mu_kinetic=0.4, mu_static=0.4)},
    "method": {"method": fl.Shooting()},
    "speeds": {"scenes": Scenes(OTHER, np.array([1.0, np.nextafter(2.0, 3.0)]))},
    "scene": {"scenes": Scenes(OTHER.with_(damping_ratio=0.2), np.array([1.0, 2.0]))},
    "start": {"scenes": Scenes(OTHER.with_(initial=fl.Initial()), np.array([1.0, 2.0]))},
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
    scaled = fl.Scene.model_validate({"dimensional": si})
    plain = fl.Scene.model_validate(SCENE | {"drive": {"unbalance": 10.0, "frequency": 1.0}})
    speeds = np.array([1.0, 2.0])

    assert key(piece(rows=np.array([7, 3]))) == key(piece())
    assert scaled.with_().belt_speed == 1.0
    assert key(piece(scenes=Scenes(scaled, speeds))) == key(piece(scenes=Scenes(plain, speeds)))


class Mine(fl.Coulomb):
    """A law from somewhere else."""


class MyMethod(fl.Exact):
    """A method from somewhere else."""


@pytest.mark.parametrize("own", [{"law": Mine(mu=0.4)}, {"method": MyMethod()}])
def test_what_is_made_by_code_that_nobody_knows_is_kept_in_memory_alone(
    own: dict[str, Any], tmp_path: Path
) -> None:
    given, store = piece(**own), Store(tmp_path)
    store.put(key(given), solve_each(given.chunks()).answers)

    assert key(given).startswith("?")
    assert store.get(key(given)) is not None
    assert list(tmp_path.iterdir()) == []


KEY = "ab" + "0" * 62
TASK = Task(1e-8, samples=3, harmonics=2)


def kept_one(folder: Path) -> tuple[Store, Path]:
    store = Store(folder)
    store.put(KEY, solve_each(piece(task=TASK).chunks()).answers)
    (path,) = folder.rglob("*.parquet")
    return store, path


def test_answers_come_back_bit_for_bit(tmp_path: Path) -> None:
    store, _ = kept_one(tmp_path)
    answers, again = solve_each(piece(task=TASK).chunks()).answers, store.get(KEY)

    assert again is not None
    assert again.column_names == answers.column_names == Store(tmp_path).columns(KEY)
    assert repr(again.to_pydict()) == repr(answers.to_pydict())
    assert kept_of(again, "orbits")["row"].tolist() == [0] * 3 + [1] * 3
    assert kept_of(again, "harmonics").equals(kept_of(answers, "harmonics"))


def test_a_damaged_file_is_noticed_or_does_no_harm(tmp_path: Path) -> None:
    """Bits that parquet has no checksum of lie in its account of columns, which is not read but for their places."""
    whole = repr(solve_each(piece(task=TASK).chunks()).answers.to_pydict())
    for at in range(0, 8000, 137):
        store, path = kept_one(tmp_path)
        content = bytearray(path.read_bytes())
        content[at % len(content)] ^= 1
        path.write_bytes(content)
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
    fl.run(study(), out=tmp_path / "a", cache=tmp_path / "kept")
    fl.run(study(tolerance=1e-7), out=tmp_path / "b", cache=tmp_path / "kept")
    files = sorted((tmp_path / "kept").rglob("*.parquet"))
    old = time.time() - 1000.0
    for age, path in enumerate(files):
        os.utime(path, (old + age, old + age))
    room = sum(path.stat().st_size for path in files[1:]) * 1e-9
    Store(tmp_path / "kept", room * 1.0001).trim()

    assert sorted((tmp_path / "kept").rglob("*.parquet")) == files[1:]
    fl.run(study(tolerance=1e-6), out=tmp_path / "c", cache=tmp_path / "kept", cache_gigabytes=0.0)
    assert len(list((tmp_path / "kept").rglob("*.parquet"))) == 2  # those of the run itself


def test_what_a_killed_process_began_to_keep_is_removed(tmp_path: Path) -> None:
    store, path = kept_one(tmp_path)
    begun(path, 999999999).write_bytes(b"half")
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

    done = fl.run(study(), out=tmp_path / "a", cache=tmp_path / "file")

    assert done.counts == {"ok": 300}


def test_onsets_of_a_run_that_is_taken_over_are_its_own(tmp_path: Path) -> None:
    sweep = {"scene.belt_speed": [30, 40, 60]}
    for out, mu in 2 * [("a", 0.4), ("b", 0.2)]:
        done = fl.run(study(laws=[{"kind": "coulomb", "mu": mu}], sweep=sweep), out=tmp_path / out)
        assert set(done.onsets["law.mu"]) == {mu}
    assert done.computed == 0


def in_si(scale: float) -> dict[str, Any]:
    """Scenes that are one without dimensions, at every scale."""
    sizes: dict[str, Any] = {
        "mass": f"{scale} kg",
        "stiffness": f"{10 * scale} kN/m",
        "normal_load": f"{10 * scale**2} N",
    }
    sizes |= {"belt_speed": "1 m/s", "drive": {"amplitude": f"{5 * scale**2} N", "frequency": "12 Hz"}}
    speeds = [f"{scale * speed} m/s" for speed in (0.04, 0.06, 0.1)]
    scene = {"dimensional": sizes | {"damping_ratio": 0.1}}
    return study(scene=scene, sweep={"scene.dimensional.belt_speed": speeds})


ALIKE = {
    "labels": [study(laws=[{"kind": "coulomb", "mu": 0.4, "label": each}]) for each in "ab"],
    "methods": [study(methods=[{"kind": "exact", "label": each}]) for each in "ab"],
    "lengths": [in_si(1.0), in_si(2.0)],
}


@pytest.mark.parametrize("what", ALIKE)
def test_onsets_of_pieces_that_are_found_have_the_labels_and_lengths_of_their_study(
    what: str, tmp_path: Path
) -> None:
    for name, each in zip("ab", ALIKE[what], strict=True):
        given = each if what == "lengths" else each | {"sweep": {"scene.belt_speed": [30, 40, 60]}}
        found = fl.run(given, out=tmp_path / name).onsets

        assert found is not None
        assert len(found)
        assert_frame_equal(found, fl.run(given).onsets, check_exact=True)


@pytest.mark.parametrize("before", [0, 1])
def test_what_somebody_does_with_a_table_is_in_no_onsets(before: int, tmp_path: Path) -> None:
    given = study(sweep={"scene.belt_speed": [30, 40, 60]})
    for _ in range(before):
        fl.run(given, out=tmp_path / "a")
    done = fl.run(given, out=tmp_path / "a")
    done.table["status"] = "failed"

    for each in (done, fl.run(given, out=tmp_path / "b")):
        assert each.onsets is not None
        assert len(each.onsets) == 3


def share_of(share: float) -> FrictionLaw:
    class Share(fl.SlidingLaw):
        mu: float

        def sliding_friction(self, slip_speed: float) -> float:
            return share * self.mu

    return Share(mu=0.4)


def test_laws_of_classes_that_one_function_makes_are_told_apart(tmp_path: Path) -> None:
    scene, sweep = fl.Scene.model_validate(SCENE), {"scene.belt_speed": [5, 25]}
    for share in (1.0, 0.5, 1.0):
        given = fl.Study.of(scene, share_of(share), sweep=sweep)
        found = fl.run(given, out=tmp_path / str(share)).table
        assert_frame_equal(found, fl.run(given).table, check_exact=True)


def test_a_damaged_piece_is_solved_once(tmp_path: Path) -> None:
    fl.run(study(), out=tmp_path / "a")
    for path in (tmp_path / ".cache").rglob("*.parquet"):
        content = bytearray(path.read_bytes())
        content[40] ^= 1  # in a page, not in the account of columns
        path.write_bytes(content)
    fl.run(study(), out=tmp_path / "b")

    assert all(Store(tmp_path / ".cache").get(path.parent.name + path.stem) is not None
               for path in (tmp_path / ".cache").rglob("*.parquet"))  # fmt: skip


def test_two_classes_of_one_name_are_told_apart() -> None:
    def made() -> fl.SlidingLaw:
        class Mine(fl.SlidingLaw):
            mu: fl.Positive

            def sliding_friction(self, speed: float) -> float:
                return self.mu

        return Mine(mu=0.4)

    with pytest.raises(TypeError, match="are two classes named 'Mine'; rename one"):
        fl.compare(fl.Scene.model_validate(SCENE), {"one": made(), "other": made()}, [5, 25])
