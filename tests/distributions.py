"""The wheel and the sdist of the project: built, and held against the files of the source."""

from __future__ import annotations

import subprocess
import tarfile
import zipfile
from collections import Counter
from collections.abc import Collection, Mapping
from pathlib import Path, PurePosixPath
from typing import NamedTuple

CACHES = {".pyc", ".pyo", ".nbi", ".nbc"}


class Built(NamedTuple):
    """sdist: None where it cannot be built; again: the wheel built from the source, not from the sdist."""

    wheel: Path
    again: Path | None
    sdist: Path | None
    how: str


def build(project: Path, python: Path, out: Path) -> Built:
    """Build with ``python -m build`` where pip can install it, else the wheel alone with ``pip wheel``.

    python: of an environment for nothing else. Raises CalledProcessError.
    """
    wanted = subprocess.run(
        [python, "-m", "pip", "install", "--quiet", "build", "hatchling"], capture_output=True
    )
    if wanted.returncode != 0:
        _run(python, "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(out), str(project))
        return Built(_only(out, "*.whl"), None, None, "pip wheel; no sdist: pip cannot install build here")
    _run(python, "build", "--no-isolation", "--outdir", str(out), str(project))
    _run(python, "build", "--no-isolation", "--wheel", "--outdir", str(out / "again"), str(project))
    wheel, again = _only(out, "*.whl"), _only(out / "again", "*.whl")
    return Built(wheel, again, _only(out, "*.tar.gz"), "python -m build")


def mistakes(built: Built, project: Path) -> list[str]:
    """What is wrong with what the distributions hold; nothing where all is well."""
    wheel = held(built.wheel)
    found = wrong_in_wheel(wheel, package_files(project / "frictionlab"))
    if built.again is not None and held(built.again) != wheel:
        found.append("the wheel built from the sdist is not the wheel built from the source")
    if built.sdist is not None:
        found += [f"sdist: no {name}" for name in sorted(tracked(project) - held(built.sdist).keys())]
        found += [f"sdist: holds {name}" for name in held(built.sdist) if _is_cache(name)]
    return found


def wrong_in_wheel(wheel: Mapping[str, bytes], files: Mapping[str, bytes]) -> list[str]:
    """The files of the package that a wheel lacks or has changed, and what it holds beside them."""
    about = {name for name in wheel if PurePosixPath(name).parts[0].endswith(".dist-info")}
    found = [f"wheel: no {name}" for name in sorted(files.keys() - wheel.keys())]
    found += [f"wheel: holds {name}" for name in sorted(wheel.keys() - files.keys() - about)]
    both = sorted(files.keys() & wheel.keys())
    return found + [f"wheel: {name} is not that of the source" for name in both if wheel[name] != files[name]]


def listed(names: Collection[str]) -> str:
    """How many files of each kind there are: "412 .py, 4 .js, 1 py.typed"."""
    kinds = Counter(PurePosixPath(name).suffix or PurePosixPath(name).name for name in names)
    return ", ".join(f"{count} {kind}" for kind, count in kinds.most_common())


def held(archive: Path) -> dict[str, bytes]:
    """The files of a wheel or an sdist by their names, without the folder that an sdist lies in."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as opened:
            return {name: opened.read(name) for name in opened.namelist()}
    with tarfile.open(archive) as opened:
        files = {
            member.name.partition("/")[2]: opened.extractfile(member) for member in opened if member.isfile()
        }
        return {name: file.read() for name, file in files.items() if file is not None}


def package_files(package: Path) -> dict[str, bytes]:
    """Every file of the package's folder but caches, named as in a wheel."""
    paths = [path for path in package.rglob("*") if path.is_file()]
    names = {path.relative_to(package.parent).as_posix(): path for path in paths}
    return {name: path.read_bytes() for name, path in names.items() if not _is_cache(name)}


def tracked(project: Path) -> set[str]:
    """The files that git keeps and that are there; none where this is no clone."""
    done = subprocess.run(["git", "ls-files", "-z"], cwd=project, capture_output=True, text=True)
    return {name for name in done.stdout.split("\0") if name and (project / name).is_file()}


def _is_cache(name: str) -> bool:
    return "__pycache__" in name or PurePosixPath(name).suffix in CACHES


def _run(python: Path, *module: str) -> None:
    subprocess.run([python, "-m", *module], check=True, capture_output=True, text=True)


def _only(folder: Path, pattern: str) -> Path:
    (found,) = folder.glob(pattern)
    return found
