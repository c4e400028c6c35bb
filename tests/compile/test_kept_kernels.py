"""Kept kernels never decide a result: what is damaged is compiled afresh, and one line on stderr says so."""

from __future__ import annotations

import hashlib
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path

import numba
import pytest
from profiles import deep

from frictionlab.compile import cache, kept
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit


@njit
def difference(a, b):
    return a - b


@njit
def total(a, b):
    return a + b


def first_call(kernel=difference) -> float:
    """What a process that has loaded nothing yet would answer."""
    cache._entry.cache_clear()
    kept._warned.clear()
    return compiled(kernel)(5.0, 2.0)


def kernels(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.kernel"))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Kernels are kept here."""
    monkeypatch.setenv("FRICTIONLAB_CACHE", str(tmp_path / "kernels"))
    return tmp_path / "kernels"


@pytest.fixture
def file(folder: Path, capfd: pytest.CaptureFixture[str]) -> Path:
    """One kept kernel."""
    assert first_call() == 3.0
    assert capfd.readouterr().err == ""
    (only,) = kernels(folder)
    return only


def truncated(content: bytes) -> bytes:
    return content[: len(content) // 2]


def empty(content: bytes) -> bytes:
    return b""


def flipped(share: float) -> Callable[[bytes], bytes]:
    def flip(content: bytes) -> bytes:
        at = int(share * len(content))
        return content[:at] + bytes([content[at] ^ 4]) + content[at + 1 :]

    return flip


def garbage(content: bytes) -> bytes:
    return bytes(range(256)) * 20


def longer(content: bytes) -> bytes:
    return content + b"\0"


def signed(payload: bytes) -> Callable[[bytes], bytes]:
    return lambda content: hashlib.sha256(payload).digest() + payload


DAMAGES = {
    "truncated": truncated,
    "empty": empty,
    "a bit of its checksum flipped": flipped(0.0),
    "a bit of its code flipped": flipped(0.5),
    "its last bit flipped": flipped(0.9999),
    "garbage": garbage,
    "a byte too long": longer,
    "sound, but no pickle": signed(b"no pickle"),
    "sound, but of other content": signed(pickle.dumps(("float64; float64", ()))),
    "sound, but of a module that is gone": signed(b"cfrictionlab_numbers_gone\nNumbers\n."),
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_kernel_is_dropped_compiled_afresh_and_kept_again(file, capfd, damage):
    whole = file.read_bytes()
    file.write_bytes(damage(whole))

    assert first_call() == 3.0

    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith(f"kernel cache: {file} ")
    assert line.endswith("; its kernel is compiled afresh")
    written = file.read_bytes()
    assert hashlib.sha256(written[kept.CHECKSUM :]).digest() == written[: kept.CHECKSUM]
    assert first_call() == 3.0
    assert capfd.readouterr().err == ""


def test_a_kernel_under_the_name_of_another_is_not_run(folder, file, capfd):
    assert compiled(total)(5.0, 2.0) == 7.0
    (other,) = set(kernels(folder)) - {file}
    assert compiled(difference)(5, 2) == 3
    (of_integers,) = set(kernels(folder)) - {file, other}
    file.write_bytes(of_integers.read_bytes())

    assert first_call() == 3.0

    assert "it is that of another kernel" in capfd.readouterr().err


def test_a_cache_removed_while_a_program_runs_is_written_anew(folder, file, capfd):
    file.unlink()
    folder.rmdir()

    assert first_call() == 3.0
    assert first_call(total) == 7.0

    assert capfd.readouterr().err == ""
    assert len(kernels(folder)) == 2


def a_file_in_the_way(folder: Path) -> Path:
    folder.write_text("not a folder")
    return folder / "below"


def system_files(folder: Path) -> Path:
    return Path("/proc/kernels")  # nobody may write here


@pytest.mark.parametrize("place", [a_file_in_the_way, system_files])
def test_without_a_folder_to_write_to_kernels_serve_this_process(folder, monkeypatch, capfd, place):
    monkeypatch.setenv("FRICTIONLAB_CACHE", str(place(folder)))

    assert (first_call(), compiled(total)(5.0, 2.0)) == (3.0, 7.0)

    lines = [line for line in capfd.readouterr().err.splitlines() if "cannot be kept in" in line]
    assert len(lines) == 1  # for any number of kernels
    assert lines[0].endswith("every run compiles its own")


def test_without_a_home_kernels_serve_this_process(monkeypatch, capfd):
    def no_home() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("FRICTIONLAB_CACHE", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", no_home)

    assert first_call() == 3.0
    assert capfd.readouterr().err == ""


@contextmanager
def largest_file(size: int):
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_on_a_full_disk_nothing_half_written_is_left(folder, capfd):
    with largest_file(1000):
        answer = first_call()

    assert answer == 3.0
    assert "kernels cannot be kept in" in capfd.readouterr().err
    assert list(folder.iterdir()) == []


def test_an_entry_that_another_compiles_is_waited_for_and_read(folder, monkeypatch):
    """The other ends without keeping anything at first: then the one that waits compiles it."""
    entry = compiled(difference).entry
    kinds, names = (numba.float64, numba.float64), []
    monkeypatch.setattr(kept, "compiled_here", names)
    with entry._cache.compiled_once(kinds, entry.targetctx.codegen()):
        waiting = threading.Thread(target=first_call)
        waiting.start()
        waiting.join(0.3)
        assert waiting.is_alive()
        assert names == []
    waiting.join()
    assert len(names) == 1

    with entry._cache.compiled_once(kinds, entry.targetctx.codegen()):  # it is kept: nobody waits
        assert first_call() == 3.0
    assert len(names) == 1
    assert [file.suffix for file in folder.iterdir()] == [".kernel"]


def test_what_a_killed_process_did_not_finish_is_removed_by_a_later_one(folder, file):
    left, fresh = folder / "left.tmp", folder / "fresh.tmp"
    left.touch()
    fresh.touch()  # another process writes it at this moment
    os.utime(left, (0.0, 0.0))

    assert first_call(total) == 7.0

    assert fresh.exists()
    assert not left.exists()


INTERPRETED = """
import frictionlab as fl
scene = fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=1, drive=fl.Drive(amplitude=2, frequency=1))
for law in (fl.Coulomb(mu=0.4), fl.LuGre(mu_kinetic=0.4, stiffness=5.0)):
    state = fl.steady_state(scene, law, tolerance=1e-4)
    print(state.status, repr(state.mean_friction), repr(state.energy_friction))
"""


@deep("seconds of Python")
def test_where_numba_compiles_nothing_python_finds_the_same_numbers():
    def answers(disabled: str) -> list[list[str]]:
        environment = {**os.environ, "NUMBA_DISABLE_JIT": disabled}
        command = [sys.executable, "-W", "error", "-c", INTERPRETED]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        return [line.split() for line in done.stdout.splitlines()]

    for slow, quick in zip(answers("1"), answers("0"), strict=True):
        assert slow[0] == quick[0] == "ok"
        assert [float(text) for text in slow[1:]] == pytest.approx(
            [float(text) for text in quick[1:]], rel=1e-11
        )
