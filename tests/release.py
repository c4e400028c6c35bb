"""Build the wheel and the sdist, and try the wheel in fresh environments: .venv/bin/python tests/release.py.

What the two hold is held against the source. Then, for each Python at hand and for the oldest dependencies that
pyproject.toml allows, the wheel is installed into an environment outside the repository, commands of the README run
there, and a part of the tests runs against the installed package. What is not at hand is skipped, and said.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tarfile
import tempfile
import time
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from distributions import Built, build, held, listed, mistakes
from interpreters import interpreter

PROJECT = Path(__file__).parents[1]
VERSIONS = "3.11", "3.12", "3.13", "3.14"
OLDEST = "oldest"
"""The environment of the lowest version of each dependency, with the lowest Python."""
EXTRAS = ("xarray",)
TESTS = (
    "tests/test_readme.py",
    "tests/report/test_explorer.py",
    "tests/report/test_page_solver.py",
    "tests/methods/exact/test_exact.py",
    "tests/report/test_compared_laws.py",
    "tests/runner/test_csv_text.py",
    "tests/runner/test_expectations.py",
    "tests/runner/test_in_si.py",
    "tests/runner/test_shape_points.py",
    "tests/scene",
    "tests/study/test_study.py",
    "tests/theory",
)
STUDY = "studies/paper/fig4_strong_friction.yaml"
COMMANDS = (
    ["laws"],
    ["methods"],
    ["schema"],
    ["check", STUDY],
    ["run", STUDY, "-o", "run"],
    ["report", "run"],
    ["explore", "run", "-o", "run.html"],
    ["explore", "-o", "explorer.html"],
)
IMPORTED = "import frictionlab; print(frictionlab.__file__, frictionlab.__version__)"
LIBRARIES = "numba", "numpy", "pandas", "pydantic"
SHOWN = "import importlib.metadata as m, sys; print(*(f'{n} {m.version(n)}' for n in sys.argv[1:]))"


class Failed(Exception):
    """A step that failed, with the last lines of what it printed."""


class Tried(NamedTuple):
    """What came of one environment; seconds of its steps by their names."""

    name: str
    seconds: dict[str, float]
    outcome: str
    passed: bool


class Environment:
    """A fresh environment in a folder, outside the repository and with kernels of its own."""

    def __init__(self, folder: Path, python: Path) -> None:
        subprocess.run([python, "-m", "venv", folder / "venv"], check=True, capture_output=True)
        scripts = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
        self.python, self.command = scripts / "python", scripts / "frictionlab"
        kept = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
        self._surroundings = kept | {"FRICTIONLAB_CACHE": str(folder / "kernels"), "HYPOTHESIS_PROFILE": ""}

    def run(self, *command: str | Path, within: Path) -> str:
        """What a command prints. Raises Failed."""
        done = subprocess.run(
            command, cwd=within, env=self._surroundings, capture_output=True, text=True, encoding="utf-8"
        )
        if done.returncode != 0:
            last = "\n".join((done.stdout + done.stderr).strip().splitlines()[-30:])
            raise Failed(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{last}")
        return done.stdout

    def install(self, *wanted: str, within: Path) -> None:
        """Install with pip, from the source that it is set up with. Raises Failed."""
        self.run(self.python, "-m", "pip", "install", "--quiet", "--no-compile", *wanted, within=within)


def main() -> int:
    """Build, list, try; 0 where all that could be tried passed."""
    options = _options()
    with tempfile.TemporaryDirectory(prefix="frictionlab-release-") as made:
        folder = Path(made)
        built, found = _build(folder)
        tried = [
            _tried(name, folder, built, () if options.quick else TESTS)
            for name in options.only or (*VERSIONS, OLDEST)
        ]
    _show(tried)
    return 0 if not found and all(one.passed for one in tried) else 1


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    choices = [*VERSIONS, OLDEST]
    parser.add_argument(
        "--only", action="append", choices=choices, help="This environment alone; may be repeated."
    )
    parser.add_argument("--quick", action="store_true", help="Install and run commands; leave out the tests.")
    return parser.parse_args()


def _build(folder: Path) -> tuple[Built, list[str]]:
    """The distributions and what is wrong with them, which is printed."""
    began = time.perf_counter()
    builder = Environment(folder / "builder", Path(sys.executable))
    built = build(PROJECT, builder.python, folder / "dist")
    found = mistakes(built, PROJECT)
    print(f"built with {built.how} in {time.perf_counter() - began:.0f} s")
    for file in (built.wheel, built.sdist):
        if file is not None:
            names = [name for name in held(file) if ".dist-info/" not in name]
            print(f"{file.name}: {file.stat().st_size / 1e6:.2f} MB, {len(names)} files: {listed(names)}")
    print("\n".join(found) or "both hold what the source holds", flush=True)
    return built, found


def _tried(name: str, folder: Path, built: Built, tests: Sequence[str]) -> Tried:
    """Try one environment and tell the steps as they end."""
    version = VERSIONS[0] if name == OLDEST else name
    python = interpreter(version)
    if python is None:
        return Tried(name, {}, f"skipped: no Python {version} on this machine", passed=True)
    seconds: dict[str, float] = {}
    try:
        outcome = _steps(name, Environment(folder / name, python), folder, built, seconds, tests)
    except Failed as failed:
        print(f"{name}: {failed}", flush=True)
        return Tried(name, seconds, f"failed: {str(failed).splitlines()[0]}", passed=False)
    print(f"{name}: {outcome}", flush=True)
    return Tried(name, seconds, outcome, passed=True)


def _steps(
    name: str,
    environment: Environment,
    folder: Path,
    built: Built,
    seconds: dict[str, float],
    tests: Sequence[str],
) -> str:
    """Install, import, run commands, run tests; the versions and what the tests say."""
    source, bounds = _unpacked(folder / name / "source", built), _bounds(folder, name)
    clock = _Clock(name, seconds)
    environment.install(str(built.wheel), *bounds, within=source)
    clock.ends("install")
    where, version = environment.run(environment.python, "-c", IMPORTED, within=source).split()
    if not Path(where).is_relative_to(folder / name) or version != project()["version"]:
        raise Failed(f"{where} {version} is imported, not the wheel")
    for command in COMMANDS:
        environment.run(environment.command, *command, within=source)
    clock.ends("commands")
    versions = environment.run(environment.python, "-c", SHOWN, *LIBRARIES, within=source).strip()
    if not tests:
        return f"passed, without tests; {versions}"
    environment.install(f"{built.wheel}[{','.join(EXTRAS)}]", "pytest", *of_plugins(), *bounds, within=source)
    # Warnings of old libraries about newer ones are none of ours.
    setting = ["-o", "addopts=", *(["-o", "filterwarnings="] if name == OLDEST else [])]
    said = environment.run(environment.python, "-m", "pytest", "-q", *setting, *tests, within=source)
    clock.ends("tests")
    return f"{said.strip().splitlines()[-1].strip('= ')}; {versions}"


class _Clock:
    """Notes the seconds of steps and tells them."""

    def __init__(self, name: str, seconds: dict[str, float]) -> None:
        self._name, self._seconds, self._began = name, seconds, time.perf_counter()

    def ends(self, step: str) -> None:
        now = time.perf_counter()
        self._seconds[step], self._began = now - self._began, now
        print(f"{self._name}: {step} {self._seconds[step]:.0f} s", flush=True)


def _unpacked(folder: Path, built: Built) -> Path:
    """The source but for the package, so that what is imported is what is installed."""
    folder.mkdir(parents=True)
    if built.sdist is None:
        for name in ("README.md", "pyproject.toml", "conftest.py", "plugins", "studies", "tests", "docs"):
            (folder / name).symlink_to(PROJECT / name)
        return folder
    with tarfile.open(built.sdist) as opened:
        opened.extractall(folder, filter="data")
    (inside,) = folder.iterdir()
    (inside / "frictionlab").rename(folder / "not-imported")
    return inside


def _bounds(folder: Path, name: str) -> list[str]:
    """What pip is told besides: the lowest versions for the oldest dependencies."""
    if name != OLDEST:
        return []
    file = folder / "oldest.txt"
    file.write_text("\n".join(lowest()) + "\n", encoding="utf-8")
    return ["--constraint", str(file)]


def lowest() -> list[str]:
    """The lower bound of each dependency, of extras and plugins too, as the only version: "numpy==2.0"."""
    about = project()
    extras = about["optional-dependencies"]
    wanted = [*about["dependencies"], *(one for extra in EXTRAS for one in extras[extra]), *of_plugins()]
    return [one.replace(">=", "==") for one in wanted]


def of_plugins() -> list[str]:
    """Return what the plugins need beside frictionlab: tests load them from the source."""
    abouts = (tomllib.loads(file.read_text()) for file in PROJECT.glob("plugins/*/pyproject.toml"))
    return sorted({one for about in abouts for one in about["project"]["dependencies"]} - {"frictionlab"})


def project() -> dict[str, Any]:
    """The section project of pyproject.toml."""
    told: dict[str, Any] = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return told


def _show(tried: list[Tried]) -> None:
    steps = ["install", "commands", "tests"]
    print(f"\n{'Python':8}" + "".join(f"{step + ' s':>12}" for step in steps) + "  outcome")
    for one in tried:
        cells = "".join(f"{one.seconds[step]:12.0f}" if step in one.seconds else " " * 12 for step in steps)
        print(f"{one.name:8}{cells}  {one.outcome}")


if __name__ == "__main__":
    sys.exit(main())
