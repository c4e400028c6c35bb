"""A first study file to begin from: complete, commented, and one that runs as it is."""

from __future__ import annotations

from pathlib import Path

from frictionlab.runner.errors import FolderError, not_written

TEMPLATE = Path(__file__).with_suffix(".yaml")
ENDINGS = (".yaml", ".yml")


def new_study(path: Path) -> Path:
    """Write the file, with .yaml added where the name has no such ending; where it is.

    Never replaces a file and makes no folder. Raises FolderError, SaveError.
    """
    if path.is_dir():
        raise FolderError(f"{path} is a folder: name the file too, as in {path / 'NAME.yaml'}")
    file = path if path.suffix in ENDINGS else path.with_name(f"{path.name}.yaml")
    text = TEMPLATE.read_text(encoding="utf-8")
    try:
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except OSError as problem:
        raise not_written(file, problem) from problem
    return file
