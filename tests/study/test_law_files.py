"""Laws from one Python file: in a study, on the command line, in the folder of a run and in its report."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.report.page import write_report
from frictionlab.runner.files import FolderError
from frictionlab.runner.saved import read_run as read_saved
from frictionlab.study import registry
from frictionlab.study.load import load_study, read_back
from frictionlab.study.registry import read_law_file
from frictionlab.study.written import yaml_text
from frictionlab.values.notes import StudyError

LAW = '''"""A law for tests."""

from __future__ import annotations

import frictionlab as fl
from frictionlab.laws.base import Positive

SHARE = 1.0


def told(mu: float) -> float:
    return SHARE * mu


class MyLaw(fl.SlidingLaw):
    """Friction of one strength, as Coulomb's is.

    mu [-], > 0: friction coefficient.
    Source: Amontons (1699).
    """

    mu: Positive

    def sliding_friction(self, speed: float) -> float:
        return told(self.mu)

    def steepest_fall(self) -> float:
        return 0.0
'''
SCENE = {"slip": {"velocity_amplitude": 2, "frequency": 1}, "belt_speed": 1}
GIVEN = {"schema": 1, "scene": SCENE, "plugins": ["laws/my_law.py"], "laws": [{"kind": "my-law", "mu": 0.4}]}


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def study(folder: str = ".", law: str = LAW, **changes: Any) -> Path:
    """A study and the file of its law beside it."""
    file = Path(folder) / "laws" / "my_law.py"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(law)
    (Path(folder) / "study.yaml").write_text(yaml_text(GIVEN | changes))
    return Path(folder) / "study.yaml"


def mean(path: Path) -> float:
    return float(fl.run(path).table["mean_friction"].iloc[0])


def said(path: Path) -> list[str]:
    with pytest.raises(StudyError) as problem:
        load_study(path)
    return [str(mistake).partition("\n")[0] for mistake in problem.value.mistakes]


CLOSED = (
    0.4 * (2 / np.pi) * np.arcsin(0.5)
)  # v_b / V = 1/2: the belt outruns the slip 1/2 + asin(1/2)/pi of the time


def test_a_law_of_a_file_beside_the_study_is_a_law_like_any() -> None:
    table = fl.run(study("deep/er")).table

    assert table["law"].tolist() == table["kind"].tolist() == ["my-law"]
    assert table["mean_friction"].iloc[0] == pytest.approx(CLOSED, abs=1e-8)
    assert table["law.mu"].tolist() == [0.4]


@njit
def friction_at(law: Any, speed: float) -> float:
    return law.sliding_friction(speed)


def compiled_strength(path: Path) -> float:
    (law,) = load_study(path).laws
    return float(compiled(friction_at, law.law())(1.0))


EDITS = pytest.mark.parametrize(
    ("old", "new", "share"),
    [
        ("return told(self.mu)", "return 0.5 * told(self.mu)", 0.5),
        ("return SHARE * mu", "return SHARE * mu / 4", 0.25),
        ("SHARE = 1.0", "SHARE = 2.0", 2.0),
    ],
    ids=["method", "helper", "constant"],
)


@EDITS
def test_kernels_compiled_for_a_file_are_not_those_of_the_edited_one(
    old: str, new: str, share: float
) -> None:
    assert compiled_strength(study()) == pytest.approx(0.4)
    assert compiled_strength(study(law=LAW.replace(old, new))) == pytest.approx(share * 0.4)


def test_kernels_of_two_files_of_one_name_do_not_mix() -> None:
    one, two = study("one"), study("two", LAW.replace("SHARE = 1.0", "SHARE = 0.5"))

    assert [compiled_strength(path) for path in (one, two, one)] == pytest.approx([0.4, 0.2, 0.4])


def test_a_study_takes_laws_of_several_files_and_several_laws_of_one() -> None:
    second = LAW.replace("class MyLaw", "class OneLaw") + LAW.partition("\n\n\n")[2].replace(
        "MyLaw", "OtherLaw"
    )
    path = study(
        plugins=["laws/my_law.py", "more.py"],
        laws=[{"kind": k, "mu": 1} for k in ("my-law", "one-law", "other-law")],
    )
    Path("more.py").write_text(second)

    assert [law.law_class.__name__ for law in load_study(path).laws] == ["MyLaw", "OneLaw", "OtherLaw"]


def test_a_run_keeps_a_copy_of_the_file_and_its_study_runs_again_from_the_folder() -> None:
    path = study(sweep={"scene.belt_speed": [0.5, 1]})
    first = fl.run(path, out="out")
    path.with_name("laws").rename("gone")

    assert Path("out/laws/my_law.py").read_text() == LAW
    assert load_study("out/study.yaml") == first.study
    again = fl.run("out/study.yaml").table
    assert again["mean_friction"].tolist() == pytest.approx(first.table["mean_friction"].tolist(), abs=1e-14)
    account = json.loads(Path("out/provenance.json").read_text())
    assert account["code"] == {"my-law": read_law_file(Path("gone/my_law.py")).code}
    assert account["plugins"] == ["laws/my_law.py"]


def test_two_files_of_one_name_are_kept_under_two() -> None:
    path = study(
        plugins=["laws/my_law.py", "other/my_law.py"], laws=[{"kind": k, "mu": 1} for k in ("my-law", "two")]
    )
    Path("other").mkdir()
    Path("other/my_law.py").write_text(LAW.replace("MyLaw", "Two"))
    done = fl.run(path, out="out")

    assert done.study.resolved()["plugins"] == ["laws/my_law.py", "laws/my_law_2.py"]
    assert load_study("out/study.yaml") == done.study


@deep("seconds of runs")
def test_points_of_an_edited_law_are_not_taken_over(capsys: pytest.CaptureFixture[str]) -> None:
    fl.run(study(), out="out")
    assert fl.run(study(), out="out").computed == 0

    edited = study(law=LAW.replace("SHARE = 1.0", "SHARE = 0.5"))
    assert cli.main(["run", str(edited), "-o", "out"]) == 2
    assert "  the code of law 'my-law' was edited since" in capsys.readouterr().err
    assert fl.run(edited, out="out", existing="replace").computed == 1
    assert "SHARE = 0.5" in Path("out/laws/my_law.py").read_text()


def test_a_copy_never_takes_the_place_of_a_file_of_ones_own() -> None:
    path = study("elsewhere")
    Path("laws").mkdir()
    Path("laws/my_law.py").write_text("mine = 1")

    with pytest.raises(FolderError, match=r"laws/my_law\.py is in the way"):
        fl.run(path, out=".")
    assert Path("laws/my_law.py").read_text() == "mine = 1"


@deep("seconds of runs")
def test_a_report_needs_no_law_and_runs_no_code_of_the_folder() -> None:
    path = study(
        law=f"{LAW}\nwith open('marks', 'a') as file:\n    file.write('x')\n",
        sweep={"scene.belt_speed": [0.5, 1]},
    )
    fl.run(path, out="out")
    told = write_report(read_saved(Path("out"))).read_text()

    assert Path("marks").read_text() == "x"
    assert "Friction of one strength, as Coulomb&#39;s is." in told
    assert "Amontons (1699)" in told
    Path("out/laws/my_law.py").unlink()
    assert "my-law" in write_report(read_saved(Path("out"))).read_text()
    assert cli.main(["plot", "out"]) == 0


def test_a_saved_run_of_a_law_with_units_is_that_of_its_study() -> None:
    slip = {"velocity_amplitude": "2 mm/s", "frequency": "1 Hz"}
    path = study(
        law=LAW.replace("mu: Positive", "mu: Positive\n    pace: fl.Speed"),
        scene={"dimensional": {"slip": slip, "belt_speed": "1 mm/s"}},
        laws=[{"kind": "my-law", "mu": "40 %", "pace": "5 mm/s"}],
        sweep={
            "scene.dimensional.belt_speed": ["0.5 mm/s", "1 mm/s"],
            "laws.my-law.pace": ["5 mm/s", "1 um/s"],
        },
    )
    done = fl.run(path, out="out")

    assert cli.main(["plot", "out"]) == cli.main(["report", "out"]) == 0
    assert fl.load("out").study.digest() == done.study.digest()


@pytest.mark.parametrize(
    ("listed", "words"),
    [
        ("laws/my_lwa.py", "plugins[0]: laws/my_lwa.py: no such file"),
        ("laws", "plugins[0]: laws: must be a Python file, *.py"),
        ("odd.py", "plugins[0]: odd.py: is not UTF-8 text (byte 1); save it as UTF-8"),
        ("folder.py", "plugins[0]: folder.py: is a folder"),
    ],
)
def test_a_file_that_cannot_be_read_is_one_mistake_at_its_place(listed: str, words: str) -> None:
    Path("odd.py").write_bytes(b"\xff")
    Path("folder.py").mkdir()

    (mistake,) = said(study(plugins=[listed]))
    assert mistake.startswith("study.yaml:3:")
    assert mistake.endswith(words)


def test_a_name_is_given_once(capsys: pytest.CaptureFixture[str]) -> None:
    taken = study(law=LAW.replace("MyLaw", "Coulomb"))
    assert cli.main(["run", str(taken)]) == 4
    assert (
        "law 'coulomb' (class Coulomb) of file laws/my_law.py: an installed law has the same name; rename the class"
        in (capsys.readouterr().err)
    )

    twice = study(plugins=["laws/my_law.py", "second.py"])
    Path("second.py").write_text(f"{LAW}# another\n")
    with pytest.raises(
        registry.BrokenPlugin, match=r"of file second\.py: laws/my_law\.py has a law of the same name"
    ):
        load_study(twice)


@deep("seconds of runs")
def test_the_command_line_takes_files_of_laws(capsys: pytest.CaptureFixture[str]) -> None:
    path, law = study(), "laws/my_law.py"
    path.write_text(path.read_text().replace("plugins: [laws/my_law.py]\n", ""))

    assert cli.main(["run", str(path)]) == 2
    assert cli.main(["run", str(path), "--law", law, "-o", "out"]) == 0
    assert load_study("out/study.yaml").resolved()["plugins"] == ["laws/my_law.py"]
    assert cli.main(["check", str(path), "--law", law]) == 0
    capsys.readouterr()
    assert cli.main(["laws", "--law", law, "--json"]) == 0
    classes = {record["name"]: record["class"] for record in json.loads(capsys.readouterr().out)}
    assert classes["my-law"].endswith("laws/my_law.py:MyLaw")
    assert classes["dahl"] == "frictionlab.laws.dahl.Dahl"
    assert cli.main(["schema", "--law", law]) == 0
    assert '"my-law"' in capsys.readouterr().out
    assert cli.main(["laws", "my-law", "--law", "no.py"]) == 2
    assert cli.main(["run", str(path), "--law", "no.py"]) == 2
    assert [line for line in capsys.readouterr().err.splitlines() if "no.py" in line] == [
        "--law no.py: no such file",
        f"--law no.py: plugins[0]: {Path('no.py').absolute()}: no such file",
    ]


def test_a_file_may_be_called_as_a_module_of_python_and_is_still_followed() -> None:
    path = study(plugins=["math.py"])
    for share in (0.5, 0.25):
        Path("math.py").write_text(LAW.replace("SHARE = 1.0", f"SHARE = {share}"))
        assert compiled_strength(path) == pytest.approx(share * 0.4)


def test_a_file_that_is_named_twice_is_one() -> None:
    path = study()

    assert cli.main(["run", str(path), "--law", "laws/my_law.py", "-o", "out"]) == 0
    assert load_study("out/study.yaml").resolved()["plugins"] == ["laws/my_law.py"]


def test_a_saved_law_with_a_damaged_parameter_is_told_as_a_mistake(tmp_path: Path) -> None:
    file = tmp_path / "study.yaml"
    scene = "{belt_speed: 1, slip: {velocity_amplitude: 2, frequency: 1}}"
    file.write_text(f'schema: 1\nscene: {scene}\nlaws: [{{kind: steady, "mu:!0.4": null}}]\n')

    with pytest.raises(StudyError, match=r"mu:!0\.4"):
        read_back(file, {"steady": "0" * 64})
