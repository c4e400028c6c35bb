"""A template for a new law: a working package with a test and a study.

A first study file to begin from: complete, commented, and one that runs as it is.
"""

from __future__ import annotations

import keyword
import re
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

from frictionlab.runner.files import FolderError, not_written, write_whole
from frictionlab.study import registry
from frictionlab.study.registry import law_name

MemoryChoice = Literal["none", "bristle"]
LAW_TEMPLATES = Path(__file__).with_name("templates")
_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z][a-z0-9]*)*")


class BadName(ValueError):
    """A name that cannot be that of a law, a module and a package; the message says why."""


def new_law(path: Path, memory: MemoryChoice) -> Path:
    """Write the folder of a law, named by the last part of the path; returns the path.

    memory: ``none`` for friction determined by the slip velocity alone, ``bristle`` for a contact that deflects.
    Existing files and folders are never replaced, parent folders not created. Raises BadName, FolderError, SaveError.
    """
    name = path.name
    check_name(name)
    try:
        path.mkdir()
        (path / "tests").mkdir()
        for file, text in _files(name, memory).items():
            (path / file).write_text(text, encoding="utf-8")
    except OSError as problem:
        raise not_written(path, problem) from problem
    return path


def check_name(name: str) -> None:
    """Raises BadName for what cannot be a law, a module and a class as well."""
    if not _NAME.fullmatch(name):
        told = law_name(name)
        hint = f"; did you mean '{told}'?" if told != name and _NAME.fullmatch(told) else ""
        raise BadName(
            f"'{name}' cannot name a law: use small letters, digits and hyphens, such as my-law{hint}"
        )
    if law_name(_class(name)) != name:
        raise BadName(f"'{name}' cannot name a law: give every part of it two letters or more")
    if name in registry.law_names():
        raise BadName(f"a law '{name}' is installed already; choose another name")
    module = _module(name)
    if keyword.iskeyword(module) or module in sys.stdlib_module_names or find_spec(module) is not None:
        raise BadName(f"Python has a module or word '{module}' already; choose another name")


def _files(name: str, memory: MemoryChoice) -> dict[str, str]:
    """Every file of the folder, by name."""
    kind = "sliding" if memory == "none" else "bristle"
    sources = {
        "pyproject.toml": "pyproject.toml.txt",
        f"{_module(name)}.py": f"{kind}.py.txt",
        f"tests/test_{_module(name)}.py": "test.py.txt",
        "study.yaml": f"{kind}_study.yaml",
        "README.md": "README.md.txt",
    }
    return {file: _fill_template(LAW_TEMPLATES / source, name) for file, source in sources.items()}


def _fill_template(template: Path, name: str) -> str:
    text = template.read_text(encoding="utf-8")
    return text.replace("my-law", name).replace("my_law", _module(name)).replace("MyLaw", _class(name))


def _module(name: str) -> str:
    return name.replace("-", "_")


def _class(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("-"))


TEMPLATE = LAW_TEMPLATES / "study.yaml"
ENDINGS = (".yaml", ".yml")
SCHEMA_FILE = "frictionlab.schema.json"
"""Beside a study, whose first line names it to editors."""


def new_study(path: Path, template: Path = TEMPLATE) -> Path:
    """Write the file, with .yaml added where the name has no such ending; where it is. template: what it says.

    Never replaces a file and makes no folder. Raises FolderError, SaveError.
    """
    if path.is_dir():
        raise FolderError(f"{path} is a folder: name the file too, as in {path / 'NAME.yaml'}")
    file = path if path.suffix in ENDINGS else path.with_name(f"{path.name}.yaml")
    text = template.read_text(encoding="utf-8")
    try:
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except OSError as problem:
        raise not_written(file, problem) from problem
    return file


def put_schema_beside(study: Path, schema: str) -> Path | None:
    """Write the JSON Schema for editors beside a study; where it is, None where another one is there already.

    Raises SaveError.
    """
    file = study.with_name(SCHEMA_FILE)
    if file.exists():
        return file if file.read_bytes() == schema.encode() else None
    write_whole(file, schema.encode())
    return file
