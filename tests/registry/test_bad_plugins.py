"""Law files that are bad in every way known: each ends a command with 4 and its name, and nothing else is harmed."""

from __future__ import annotations

import builtins
import json
import math
import os
import signal
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import frictionlab as fl
from frictionlab import cli
from frictionlab.registry import guard, smoke_test

HEAD = (
    "import math, os, signal, sys, time, builtins, warnings\nimport numpy as np\nimport frictionlab as fl\n"
)
CLASS = """

class Bad(fl.SlidingLaw):
    mu: fl.Positive

    def sliding_friction(self, speed):
        return self.mu
"""
GOOD = HEAD + CLASS
STUDY = """schema: 1
scene: {slip: {velocity_amplitude: 2, frequency: 1}, belt_speed: 1}
plugins: [bad.py]
laws: [{kind: bad, mu: 0.4}]
"""
AWKWARD = "class Awkward(Exception):\n    def __str__(self): "
FOR_ALL = ", which all others use; give yours another name"
NEEDED = ": the program needs it to report results"
NO_END = "is not for plugins: it acts on the whole program"


def loading(*lines: str) -> str:
    """A law file that does this while it is loaded."""
    return HEAD + "\n".join(lines) + "\n" + CLASS


def calling(*lines: str) -> str:
    """A law file that does this when its method is called."""
    return GOOD.replace("return self.mu", "\n        ".join(lines))


def beside(*lines: str) -> str:
    """A law file with more in its class."""
    return GOOD + "\n    " + "\n    ".join(lines) + "\n"


CALL = "sliding_friction(speed=1.0)"
BAD = {
    "exits": (loading("sys.exit(0)"), "cannot be loaded: SystemExit: 0\n  bad.py:4: sys.exit(0)"),
    "ends the process": (loading("os._exit(0)"), f"ProcessExit: os._exit {NO_END}\n  bad.py:4: os._exit(0)"),
    "aborts": (loading("os.abort()"), f"ProcessExit: os.abort {NO_END}"),
    "forks": (loading("os.fork()"), f"ProcessExit: os.fork {NO_END}"),
    "becomes another program": (loading("os.execl('/bin/true', 'true')"), f"ProcessExit: os.execv {NO_END}"),
    "error whose text raises": (
        loading(f"{AWKWARD}raise ValueError", "raise Awkward"),
        "cannot be loaded: Awkward: its message raises ValueError\n  bad.py:6: raise Awkward",
    ),
    "error whose text ends the process": (
        loading(f"{AWKWARD}os._exit(0)", "raise Awkward"),
        "cannot be loaded: Awkward: its message raises ProcessExit",
    ),
    "error with a long text": (loading("raise ValueError('x' * 10**7)"), f"ValueError: {'x' * 400}"),
    "error of no kind known": (
        loading("class Own(BaseException): pass", "raise Own('x')"),
        "cannot be loaded: Own: x\n  bad.py:5",
    ),
    "generator exit": (loading("raise GeneratorExit"), "cannot be loaded: GeneratorExit\n  bad.py:4"),
    "closes stdout": (loading("sys.stdout.close()"), f"closes or replaces sys.stdout{NEEDED}"),
    "closes stderr": (loading("sys.stderr.close()"), f"closes or replaces sys.stderr{NEEDED}"),
    "closes a descriptor": (loading("os.close(1)"), f"closes or replaces file descriptor 1{NEEDED}"),
    "replaces stdout": (
        loading("sys.stdout = open(os.devnull, 'w')", "sys.stdout.close()"),
        f"closes or replaces sys.stdout{NEEDED}",
    ),
    "replaces a function of numpy": (loading("np.sin = np.cos"), f"replaces numpy.sin{FOR_ALL}"),
    "replaces a number": (loading("math.exp = math.pi = 3.0"), f"replaces math.exp, math.pi{FOR_ALL}"),
    "replaces a function of Python": (loading("builtins.abs = len"), f"replaces builtins.abs{FOR_ALL}"),
    "replaces a module": (loading("sys.modules['math'] = None"), f"replaces module math{FOR_ALL}"),
    "replaces a law": (
        loading("fl.Coulomb.sliding_friction = lambda self, speed: 0.0"),
        f"replaces frictionlab.laws.coulomb.Coulomb.sliding_friction{FOR_ALL}",
    ),
    "two classes of one name": (
        GOOD + CLASS,
        "class Bad is defined twice, in lines 6 and 13; give one another name",
    ),
    "two classes of one law": (
        GOOD + CLASS.replace("Bad", "BAD"),
        "its classes Bad and BAD are both the law 'bad'; rename one",
    ),
    "syntax error": (
        calling("return self.mu +"),
        "SyntaxError: invalid syntax\n  bad.py:10: return self.mu +",
    ),
    "null byte": (GOOD + "\0", "SyntaxError: source code string cannot contain null bytes"),
    "nested too deep": (loading(f"x = {'(' * 500}{')' * 500}"), "SyntaxError: too many nested parentheses"),
    "missing module": (loading("import not_there.at_all"), "needs 'not_there', which is not installed"),
    "missing name": (loading("from math import nothing"), "ImportError: cannot import name 'nothing'"),
    "misspelt name": (
        GOOD.replace("fl.Positive", "fl.Postive"),
        "AttributeError: module 'frictionlab' has no attribute 'Postive'\n  bad.py:6: class Bad(fl.SlidingLaw):",
    ),
    "endless": (
        loading("while True: pass"),
        "cannot be loaded: does not end: stopped after 0.2 s\n  bad.py:4",
    ),
    "recursion": (loading("def f(): f()", "f()"), "cannot be loaded: RecursionError: "),
    "empty": ("", "defines no law: give it a class derived from frictionlab.SlidingLaw, BristleLaw or"),
    "not a law": (GOOD.replace("fl.SlidingLaw", "object"), "defines no law"),
    "class without methods": (
        HEAD + "class Bad(fl.BristleLaw):\n    pass\n",
        "class Bad does not define friction(self, v, z, dz), rate(self, v, z), sliding_friction(self, speed)",
    ),
    "undefined type": (
        GOOD.replace("fl.Positive", "'Undefined'"),
        "`Bad` is not fully defined; you should define `Undefined`, then call `Bad.model_rebuild()`.\ncorrect",
    ),
    "no return": (calling("self.mu"), f"{CALL} returns None, which is no number: is its return missing?"),
    "returns a word": (
        calling("return 'fast'"),
        f"{CALL} returns 'fast', which is no number\n  bad.py:9: def",
    ),
    "returns an array": (
        calling("return np.array([1.0])"),
        f"{CALL} returns array([1.]), which is no number",
    ),
    "returns a generator": (calling("yield self.mu"), f"{CALL} returns <generator object"),
    "returns what cannot be shown": (
        calling("class O:", "    def __repr__(self): raise ValueError", "return O()"),
        f"{CALL} returns a O that cannot be shown (ValueError), which is no number",
    ),
    "endless in a method": (
        calling("for _ in range(100): time.sleep(0.01)", "return self.mu"),
        f"{CALL} does not return: stopped after 0.2 s",
    ),
    "recursion in a method": (
        calling("return self.sliding_friction(speed)"),
        f"{CALL} raises RecursionError: maximum recursion depth exceeded while calling a Python object\n  bad.py:10",
    ),
    "exits in a method": (calling("sys.exit(0)"), f"{CALL} raises SystemExit: 0\n  bad.py:10: sys.exit(0)"),
    "ends the process in a method": (calling("os._exit(0)"), f"{CALL} raises ProcessExit: os._exit {NO_END}"),
    "replaces in a method": (
        calling("np.sin = np.cos", "return self.mu"),
        f"{CALL} replaces numpy.sin{FOR_ALL}",
    ),
    "closes in a method": (
        calling("sys.stdout.close()", "return self.mu"),
        f"{CALL} closes or replaces sys.stdout{NEEDED}",
    ),
    "error whose text raises in a method": (
        calling(f"{AWKWARD}raise ValueError".replace("\n", "\n        "), "raise Awkward"),
        f"{CALL} raises Awkward: its message raises ValueError\n  bad.py:12: raise Awkward",
    ),
    "wrong arguments": (
        GOOD.replace("self, speed", "self"),
        "sliding_friction(self) must take (self, speed)",
    ),
    "property that exits": (
        beside("@property", "def half(self): sys.exit(1)"),
        "its properties raises SystemExit: 1\n  bad.py:13",
    ),
    "exits when made": (
        beside("def model_post_init(self, _): sys.exit(1)"),
        "Bad(mu=1) raises SystemExit: 1",
    ),
    "bibtex that is no text": (
        beside("bibtex = property(lambda self: 1)"),
        "its bibtex: must be one text of BibTeX entries, not a property",
    ),
}


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.yaml").write_text(STUDY)


def unharmed() -> list[object]:
    """What bad plugins of these tests change."""
    own = [np.sin, math.exp, math.pi, builtins.abs, sys.modules["math"], fl.Coulomb.sliding_friction]
    ends = [getattr(os, name) for name in guard.ENDS]
    state = [os.getcwd(), sys.getrecursionlimit(), signal.getsignal(signal.SIGINT)]
    return [*own, *ends, *state, sys.stdout, sys.stderr, os.fstat(1), os.fstat(2), np.geterr()]


@pytest.mark.parametrize("case", BAD)
def test_a_bad_law_file_ends_the_command_with_4_and_its_name_and_harms_nothing(
    case: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    text, words = BAD[case]
    if case.startswith("endless"):
        monkeypatch.setattr(*((guard, "LOADING") if case == "endless" else (smoke_test, "LIMIT")), 0.2)
    Path("bad.py").write_text(text)
    before = unharmed()

    assert cli.main(["check", "study.yaml"]) == 4
    said = capsys.readouterr()
    assert unharmed() == before
    assert said.out == ""
    assert said.err.startswith(("file bad.py: ", "law 'bad' (class Bad) of file bad.py: "))
    assert words in said.err
    assert said.err.rstrip().endswith(("correct the file", "pip install not_there"))
    assert "Traceback" not in said.err
    assert len(said.err) < 2000


def test_what_a_plugin_sets_for_all_of_python_is_put_back(capsys: pytest.CaptureFixture[str]) -> None:
    lines = "os.chdir('/')", "sys.setrecursionlimit(5000)", "np.seterr(all='raise')"
    Path("bad.py").write_text(
        loading(*lines, "signal.signal(signal.SIGINT, signal.SIG_IGN)", "warnings.simplefilter('error')")
    )
    before, errors = unharmed(), warnings.filters.count(("error", None, Warning, None, 0))

    assert cli.main(["check", "study.yaml"]) == 0
    assert unharmed() == before
    assert warnings.filters.count(("error", None, Warning, None, 0)) == errors
    assert "bad by auto: points 1" in capsys.readouterr().out


def test_what_a_plugin_prints_never_mixes_with_the_result() -> None:
    shouts = "print('loud'); os.write(1, b'loud'); os.system('echo loud'); sys.stdout.flush()"
    Path("bad.py").write_text(loading(shouts).replace("return", f"{shouts}; return"))
    command = "import sys; from frictionlab.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", command, "check", "study.yaml", "--json"],
        capture_output=True,
        text=True,
        timeout=60,
    )

    assert done.returncode == 0, done.stderr
    assert [record["law"] for record in json.loads(done.stdout)] == ["bad"]
    assert done.stderr.count("loud") > 6


@pytest.mark.parametrize("command", ["run", "check"])
def test_no_plugins_refuses_a_study_that_lists_some_before_any_of_their_code_runs(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("bad.py").write_text(loading(f"open('marks', 'w').close()  # {command}"))

    assert cli.main([command, "study.yaml", "--no-plugins"]) == 2
    assert capsys.readouterr().err.startswith(
        "study.yaml:3:1: plugins: names Python code, which --no-plugins does not run; read it, then leave out"
    )
    assert cli.main([command, ".", "--no-plugins"]) == 2
    assert not Path("marks").exists()
    assert not Path("runs").exists()
    Path("study.yaml").write_text(STUDY.replace("plugins: [bad.py]\n", ""))
    assert cli.main(["check", "study.yaml", "--no-plugins", "--law", "bad.py"]) == 0
    assert Path("marks").exists()


def test_a_law_file_that_is_no_text_is_a_mistake_of_the_study(capsys: pytest.CaptureFixture[str]) -> None:
    Path("bad.py").write_bytes(f"# -*- coding: latin-1 -*-\n# \xe9\n{GOOD}".encode("latin-1"))

    assert cli.main(["check", "study.yaml"]) == 2
    assert "study.yaml:3:11: plugins[0]: bad.py: is not UTF-8 text (byte 29)" in capsys.readouterr().err
