"""Laws from outside that are broken: each is told with its package, what is wrong and what to do; others go on."""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from profiles import deep, some

from frictionlab import cli
from frictionlab.study import registry
from frictionlab.study.written import yaml_text

HEAD = "from typing import ClassVar\n\nimport frictionlab as fl\n\n\n"
GOOD = f'''{HEAD}class Good(fl.SlidingLaw):
    """Friction of one strength. Source: Amontons (1699)."""

    mu: fl.Positive

    def sliding_friction(self, speed):
        return self.mu
'''
SLIP = {"slip": {"velocity_amplitude": 2, "frequency": 1}, "belt_speed": 1}
SCENE = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5, "drive": {"unbalance": 10, "frequency": 1}}

Brings = Callable[..., Path]


@pytest.fixture
def brings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Brings]:
    """Installs a package: a module and the entry point that leads to it."""
    monkeypatch.chdir(tmp_path)
    site = tmp_path / "site"
    monkeypatch.syspath_prepend(str(site))

    def bring(
        text: str, value: str = "some_law:Good", name: str = "some", package: str = "somebodys"
    ) -> Path:
        home = site / f"{package}-1.2.dist-info"
        home.mkdir(parents=True)
        (home / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.2\n")
        (home / "entry_points.txt").write_text(f"[frictionlab.laws]\n{name} = {value}\n")
        if text:
            (site / "some_law.py").write_text(text)
        _forget()
        return site

    yield bring
    sys.modules.pop("some_law", None)
    _forget()


def _forget() -> None:
    importlib.invalidate_caches()
    registry._entry_points.cache_clear()
    registry._load.cache_clear()


def study(kind: str, scene: object = SLIP) -> str:
    given = {"schema": 1, "scene": scene, "laws": [{"kind": kind, "mu": 0.4}]}
    Path(f"{kind}.yaml").write_text(yaml_text(given))
    return f"{kind}.yaml"


def good(changes: dict[str, str]) -> str:
    text = GOOD
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    return text


RETURN, DEF, MU = "return self.mu", "def sliding_friction(self, speed)", "    mu: fl.Positive\n"
BRISTLE = f"{HEAD}class Good(fl.BristleLaw):\n    def sliding_friction(self, speed):\n        return 0.4\n"
BROKEN = {
    "syntax error": (
        {RETURN: "return self.mu +"},
        "cannot be loaded: SyntaxError: invalid syntax\n  {file}:12: return self.mu +",
    ),
    "missing dependency": (
        {HEAD: f"import not_there.at_all\n{HEAD}"},
        "needs 'not_there', which is not installed\n  {file}:1: import not_there.at_all\n"
        "install it, or remove the import: pip install not_there",
    ),
    "error at import": (
        {HEAD: f"{HEAD}LIMIT = 1 / 0\n\n\n"},
        "cannot be loaded: ZeroDivisionError: division by zero\n  {file}:6: LIMIT = 1 / 0",
    ),
    "exit at import": (
        {HEAD: f"raise SystemExit(3)\n{HEAD}"},
        "cannot be loaded: SystemExit: 3\n  {file}:1: raise SystemExit(3)",
    ),
    "misspelt name of ours": (
        {"fl.Positive": "fl.Postive"},
        "AttributeError: module 'frictionlab' has no attribute 'Postive'\n  {file}:9: mu: fl.Postive",
    ),
    "undefined type": (
        {"fl.Positive": "'Undefined'"},
        "`Good` is not fully defined; you should define `Undefined`, then call `Good.model_rebuild()`.\ncorrect",
    ),
    "missing method": (
        {GOOD: BRISTLE},
        "class Good does not define friction(self, v, z, dz), rate(self, v, z)",
    ),
    "wrong signature": (
        {DEF: "def sliding_friction(self, speed, load)"},
        "sliding_friction(self, speed, load) must take (self, speed)\n  {file}:11: def",
    ),
    "static method": (
        {f"    {DEF}": "    @staticmethod\n    def sliding_friction(speed)", RETURN: "return 0.4"},
        "sliding_friction must be an ordinary method, sliding_friction(self, speed), not a staticmethod",
    ),
    "returns nothing": (
        {RETURN: "self.mu"},
        "sliding_friction(speed=1.0) returns None, which is no number: is its return missing?\n  {file}:11: def",
    ),
    "returns a word": (
        {RETURN: "return 'fast'"},
        "sliding_friction(speed=1.0) returns 'fast', which is no number\n  {file}:11: def",
    ),
    "returns a number for a yes": (
        {RETURN: "return self.mu\n\n    def monotone(self):\n        return 1.0"},
        "monotone() returns 1.0, which is no True or False\n  {file}:14: def monotone(self):",
    ),
    "a parameter without a type": (
        {MU: "    mu = 0.4\n"},
        "mu = 0.4 has no type: write mu: fl.Positive = 0.4\n  {file}:",
    ),
    "raises in a method": (
        {RETURN: "return self.muu"},
        "sliding_friction(speed=1.0) raises AttributeError: 'Good' object has no attribute 'muu'\n  {file}:12:",
    ),
    "calls itself": (
        {RETURN: "return self.sliding_friction(speed)"},
        "sliding_friction(speed=1.0) raises RecursionError: maximum recursion depth exceeded",
    ),
    "raises in a property": (
        {f"    {DEF}": f"    @property\n    def half(self):\n        return self.moo / 2\n\n    {DEF}"},
        "its properties raises AttributeError: 'Good' object has no attribute 'moo'\n  {file}:13: return",
    ),
    "mutable default": (
        {MU: f"{MU}    table: list[float] = [1.0]\n"},
        "parameter 'table' has a mutable default, a list; a law consists of its parameters only",
    ),
    "mutable attribute": (
        {MU: f"{MU}    seen: ClassVar[list[float]] = []\n"},
        "its attribute seen = [] is mutable; a law consists of its",
    ),
    "private state": (
        {MU: f"{MU}    _last: float = 0.0\n"},
        "it has a private state, _last; a law consists of its parameters",
    ),
    "raises on construction": (
        {f"    {DEF}": f"    def model_post_init(self, _):\n        raise KeyError('mu')\n\n    {DEF}"},
        "Good(mu=1) raises KeyError: 'mu'\n  {file}:12: raise KeyError('mu')",
    ),
    "refuses its defaults": (
        {
            MU: "    mu: fl.Positive = 1.0\n\n    def model_post_init(self, _):\n        assert 0, 'too small'\n"
        },
        "its own defaults are refused: Assertion failed, too small",
    ),
    "not a class": ({GOOD: "Good = 3\n"}, "is not a class but 3; its entry point must name the class itself"),
    "not a law": (
        {"fl.SlidingLaw": "fl.Drive", f"\n{MU}": ""},
        "class Good is not derived from frictionlab.SlidingLaw, BristleLaw or MemoryLaw",
    ),
    "broken citation": ({MU: f"{MU}    bibtex: ClassVar[str] = '@article{{x, year = '\n"}, "its bibtex: "),
    "citation that is no text": (
        {MU: f"{MU}    bibtex = property(lambda self: 1)\n"},
        "its bibtex: must be one text of BibTeX entries, not a property",
    ),
}


@some(3, "packages of every kind")
@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_law_is_told_with_its_package_and_the_remedy_and_others_go_on(
    case: str, brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    changes, words = BROKEN[case]
    site = brings(good(changes))
    told = words.format(file=site / "some_law.py")

    assert cli.main(["laws"]) == 4
    said = capsys.readouterr()
    assert "coulomb" in said.out
    assert "some " not in said.out
    assert said.err.startswith("law 'some' of package somebodys 1.2 (some_law:Good): ")
    assert told in said.err
    assert "pip install not_there" in said.err or "correct it, or: pip uninstall somebodys" in said.err
    assert "Traceback" not in said.err

    assert cli.main(["run", study("some")]) == 4
    assert told in capsys.readouterr().err
    assert cli.main(["laws", "some"]) == 4
    assert cli.main(["check", study("coulomb")]) == 0
    assert cli.main(["schema"]) == 0
    assert '"some"' not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("nowhere:Good", "does not exist: No module named 'nowhere'"),
        ("some_law.deeper:Good", "does not exist: No module named 'some_law.deeper'"),
        ("some_law:Bad", "does not exist: module 'some_law' has no attribute 'Bad'"),
    ],
)
def test_an_entry_point_to_nothing_says_what_is_missing(
    value: str, words: str, brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    brings(GOOD, value)

    assert cli.main(["run", study("some")]) == 4
    said = capsys.readouterr().err
    assert f"law 'some' of package somebodys 1.2 ({value}): {words}" in said
    assert "pip uninstall somebodys" in said


def test_a_package_with_a_sound_law_is_in_the_list_the_schema_and_studies(
    brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    brings(GOOD)

    assert cli.main(["laws", "--json"]) == 0
    assert "some" in [record["name"] for record in json.loads(capsys.readouterr().out)]
    assert cli.main(["schema"]) == 0
    assert '"some"' in capsys.readouterr().out
    assert cli.main(["run", study("some"), "-o", "out"]) == 0
    account = json.loads(Path("out/provenance.json").read_text())
    assert list(account["code"]) == ["some"]


@deep("seconds of runs")
def test_an_edited_package_is_noticed_and_a_removed_one_leaves_the_report(
    brings: Brings, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    site = brings(GOOD)
    assert cli.main(["run", study("some"), "-o", "out"]) == 0

    (site / "some_law.py").write_text(good({RETURN: "return 2 * self.mu"}))
    sys.modules.pop("some_law")
    _forget()
    assert cli.main(["run", "some.yaml", "-o", "out"]) == 2
    assert "the code of law 'some' was edited since" in capsys.readouterr().err

    monkeypatch.setattr(sys, "path", [path for path in sys.path if path != str(site)])
    _forget()
    assert cli.main(["report", "out"]) == 0
    assert cli.main(["run", "some.yaml", "-o", "out"]) == 2
    assert "install the package that provides it, or list its file under plugins" in capsys.readouterr().err


def test_two_packages_that_bring_one_name_are_both_told(
    brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    brings(f"{GOOD}\n\nclass Other(Good):\n    pass\n")
    brings("", "some_law:Other", package="anothers")

    assert cli.main(["run", study("some")]) == 4
    said = capsys.readouterr().err
    assert "law 'some' is defined by " in said
    assert "somebodys 1.2 (some_law:Good)" in said
    assert "anothers 1.2 (some_law:Other)" in said
    assert "rename one of them, or uninstall it" in said


def test_nobody_takes_the_place_of_a_law_of_frictionlab(
    brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    brings(GOOD, name="coulomb")

    assert registry.law_class("coulomb").__module__ == "frictionlab.laws.coulomb"
    assert cli.main(["run", study("coulomb"), "-o", "out"]) == 0
    capsys.readouterr()
    assert cli.main(["laws"]) == 4
    said = capsys.readouterr()
    assert "coulomb" in said.out
    assert "somebodys 1.2 (some_law:Good)" in said.err
    assert "that of frictionlab is used; rename the others" in said.err


@deep("seconds of runs")
def test_a_law_that_numba_cannot_compile_fails_its_points_with_the_authors_line(
    brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    site = brings(
        good({RETURN: "return self.half(speed)\n\n    def half(self, speed):\n        return self.mu"})
    )
    Path("both.yaml").write_text(
        yaml_text(
            {"schema": 1, "scene": SCENE, "laws": [{"kind": kind, "mu": 0.4} for kind in ("some", "coulomb")]}
        )
    )

    assert cli.main(["run", "both.yaml", "-o", "out"]) == 4
    said = capsys.readouterr()
    line = f"{site / 'some_law.py'}:12: return self.half(speed)"
    words = (
        "cannot be compiled by numba: a method cannot call the law's own method 'half': make that a function"
    )
    assert (
        f"broken plugin: law Good (some_law) {words} of the module; {line}; In its methods use only float"
        in said.out
    )
    assert "1 ok, 1 failed" in said.out or "1 failed, 1 ok" in said.out
    assert "Traceback" not in said.err


def test_a_law_that_fails_with_the_parameters_given_is_told_before_the_run(
    brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    site = brings(good({RETURN: "return self.mu if self.mu > 0.5 else None"}))

    assert cli.main(["laws"]) == 0
    assert cli.main(["run", study("some")]) == 4
    assert (
        f"sliding_friction(speed=1.0) returns None, which is no number: is its return missing?\n  {site}"
        in (capsys.readouterr().err)
    )


@deep("more kernels to compile")
def test_an_error_only_some_speeds_meet_fails_those_points(
    brings: Brings, capsys: pytest.CaptureFixture[str]
) -> None:
    brings(good({RETURN: "return self.mu if speed < 2.9 else self.mu / (speed - speed)"}))
    path = Path(study("some"))
    path.write_text(path.read_text() + "sweep: {scene.belt_speed: [0.1, 1]}\n")

    assert cli.main(["run", str(path), "-o", "out"]) == 4
    said = capsys.readouterr()
    assert "broken plugin: a law of" in said.out
    assert "ZeroDivisionError: float division by zero" in said.out
    assert "1 ok, 1 failed" in said.out
    assert "Traceback" not in said.err


FILES = {
    "one.py": (
        {RETURN: "return self.mu +"},
        "file {file}: cannot be loaded: SyntaxError: invalid syntax\n  {file}:12: ",
    ),
    "two.py": (
        {RETURN: "self.mu"},
        "law 'good' (class Good) of file {file}: sliding_friction(speed=1.0) returns None",
    ),
    "three.py": (
        {GOOD: "x = 1\n"},
        "file {file}: defines no law: give it a class derived from frictionlab.SlidingLaw",
    ),
    "four.py": (
        {GOOD: GOOD + GOOD.replace("Good", "GOOD")},
        "file {file}: its classes Good and GOOD are both the law 'good'; rename one",
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_a_law_in_a_file_is_told_with_its_file(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    changes, words = FILES[name]
    file = tmp_path / name
    file.write_text(good(changes))

    assert cli.main(["laws", "--law", str(file)]) == 4
    said = capsys.readouterr()
    assert words.format(file=file) in said.err
    assert said.err.rstrip().endswith("correct the file")
    assert ("coulomb" in said.out) == said.err.startswith("law")


@pytest.fixture
def listed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Writes a law file ``good.py``, listed by ``good.yaml``."""
    monkeypatch.chdir(tmp_path)
    path = Path(study("good"))
    path.write_text(f"plugins: [good.py]\n{path.read_text()}")
    return lambda text: Path("good.py").write_text(text) and None


@deep("processes")
def test_what_a_plugin_prints_never_mixes_with_the_result(listed: Callable[[str], None]) -> None:
    shouts = "print('loud'); import os; os.write(1, b'loud'); os.system('echo loud')"
    listed(good({HEAD: f"{HEAD}{shouts}\n", RETURN: f"{shouts}; {RETURN}"}))
    command = "import sys; from frictionlab.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", command, "check", "good.yaml", "--json"],
        capture_output=True,
        text=True,
        timeout=60,
    )

    assert done.returncode == 0, done.stderr
    assert [record["law"] for record in json.loads(done.stdout)] == ["good"]
    assert done.stderr.count("loud") > 5


@pytest.mark.parametrize("command", ["run", "check"])
def test_no_plugins_refuses_a_study_that_lists_some_before_any_of_their_code_runs(
    command: str, capsys: pytest.CaptureFixture[str], listed: Callable[[str], None]
) -> None:
    listed(good({HEAD: f"{HEAD}open('marks', 'w').close()  # {command}\n"}))

    assert cli.main([command, "good.yaml", "--no-plugins"]) == 2
    assert capsys.readouterr().err.startswith(
        "good.yaml:1:1: plugins: names Python code, which --no-plugins does not run; read it, then leave out"
    )
    assert cli.main([command, ".", "--no-plugins"]) == 2
    assert not Path("marks").exists()
    assert not Path("runs").exists()
    study("good")
    assert cli.main(["check", "good.yaml", "--no-plugins", "--law", "good.py"]) == 0
    assert Path("marks").exists()
