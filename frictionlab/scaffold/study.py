"""A first study file to begin from: complete, commented, and one that runs as it is."""

from __future__ import annotations

from pathlib import Path

from frictionlab.runner.errors import FolderError, not_written
from frictionlab.runner.files import write_whole

TEMPLATE = Path(__file__).with_suffix(".yaml")
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
