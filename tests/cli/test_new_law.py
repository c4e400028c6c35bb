"""A law to begin from: what the folder holds, that it works as it is, and which names it can have."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.study.load import load_study
from frictionlab.study.registry import read_law_file

MEMORIES = ["none", "bristle"]
SLIP = {"slip": {"velocity_amplitude": 2, "frequency": 1}, "belt_speed": 1}


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def law_of(memory: str) -> Path:
    """The file of a new law."""
    assert cli.main(["new", "law", "soft-rubber", "--memory", memory]) == 0
    return Path("soft-rubber/soft_rubber.py")


@pytest.mark.parametrize("memory", MEMORIES)
def test_a_new_law_is_a_package_with_a_law_a_test_and_a_study(
    memory: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = law_of(memory)
    said = capsys.readouterr()
    folder = file.parent

    assert said.out == "soft-rubber\n"
    assert "frictionlab run soft-rubber/study.yaml --law soft-rubber/soft_rubber.py" in said.err
    assert sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()) == [
        "README.md",
        "pyproject.toml",
        "soft_rubber.py",
        "study.yaml",
        "tests/test_soft_rubber.py",
    ]
    made = tomllib.loads((folder / "pyproject.toml").read_text())
    assert made["project"]["name"] == "frictionlab-soft-rubber"
    assert made["project"]["entry-points"]["frictionlab.laws"] == {"soft-rubber": "soft_rubber:SoftRubber"}
    assert made["tool"]["hatch"]["build"]["targets"]["wheel"]["include"] == ["soft_rubber.py"]
    test = (folder / "tests/test_soft_rubber.py").read_text()
    assert "from frictionlab.testing import check_law\nfrom soft_rubber import SoftRubber\n" in test
    assert "check_law(SoftRubber)" in test
    assert not [path for path in folder.rglob("*") if path.is_file() and "my-law" in path.read_text()]


@pytest.mark.parametrize("memory", MEMORIES)
def test_a_new_law_is_sound_and_says_what_it_is(memory: str, capsys: pytest.CaptureFixture[str]) -> None:
    file = law_of(memory)
    capsys.readouterr()

    assert cli.main(["laws", "soft-rubber", "--law", str(file)]) == 0
    told = capsys.readouterr().out
    assert "Source: " in told
    assert "mu: > 0, required" in told
    law = read_law_file(file).laws["soft-rubber"]
    assert all(f"{name} [" in told or f"{name}:" in told for name in law.model_fields)


@pytest.mark.parametrize("memory", MEMORIES)
def test_the_study_of_a_new_law_runs(memory: str) -> None:
    file = law_of(memory)
    study = load_study(file.parent / "study.yaml", law_files=[file])
    slipping = study.resolved() | {"scene": SLIP, "plugins": [str(file)], "expect": []}
    table = fl.run(slipping | {"sweep": {"scene.belt_speed": [1, 40]}}).table

    assert list(table["status"]) == ["ok"] * 4
    far = table.set_index(["law", "scene.belt_speed"])["mean_friction"]
    assert far["soft-rubber", 40] >= far["coulomb", 40] - 1e-8


def refused(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    assert cli.main(["new", "law", name]) == 2
    return capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("SoftRubber", "use small letters, digits and hyphens, such as my-law; did you mean 'soft-rubber'?"),
        ("soft_rubber", "did you mean 'soft-rubber'?"),
        ("9lives", "'9lives' cannot name a law: use small letters, digits and hyphens, such as my-law"),
        ("a-b", "'a-b' cannot name a law: give every part of it two letters or more"),
        ("coulomb", "a law 'coulomb' is installed already; choose another name"),
        ("class", "Python has a module or word 'class' already; choose another name"),
        ("random", "Python has a module or word 'random' already; choose another name"),
        ("numpy", "Python has a module or word 'numpy' already; choose another name"),
        ("nowhere/soft", "nowhere/soft: there is no folder nowhere; make it first, or choose another"),
    ],
)  # fmt: skip
def test_a_name_that_cannot_be_is_refused(name: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert words in refused(name, capsys)
    assert list(Path().iterdir()) == []


def test_nothing_is_ever_replaced(capsys: pytest.CaptureFixture[str]) -> None:
    file = law_of("none")
    file.write_text("mine")

    assert "soft-rubber is there already and stays as it is; choose another name" in refused(
        "soft-rubber", capsys
    )
    assert file.read_text() == "mine"


@deep("the whole battery")
@pytest.mark.parametrize("memory", MEMORIES)
def test_a_new_law_passes_the_test_it_comes_with(memory: str) -> None:
    pytest.importorskip("frictionlab.testing")
    folder = law_of(memory).parent
    done = ran([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"], folder)

    assert done.returncode == 0, done.stdout + done.stderr


def ran(command: list[str], folder: Path) -> Any:
    """A command in this folder, with the frictionlab that is tested here."""
    house = str(Path(fl.__file__).parents[1])
    known = os.pathsep.join([house, *filter(None, [os.environ.get("PYTHONPATH")])])
    return subprocess.run(
        command,
        cwd=folder,
        env=os.environ | {"PYTHONPATH": known},
        capture_output=True,
        text=True,
        timeout=900,
    )
