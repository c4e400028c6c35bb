"""Studies from files and mappings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from frictionlab.study.law_files import (
    LawReader,
    Plugins,
    add_law_files,
    read_laws,
    refuse_law_files,
    saved_law_reader,
)
from frictionlab.study.reader import read_values
from frictionlab.study.study import Study
from frictionlab.study.yaml_source import Source, read_file, read_mapping


def load_study(
    path: str | PathLike[str],
    overrides: Sequence[str] = (),
    law_files: Sequence[Path] = (),
    plugins: Plugins = "run",
) -> Study:
    """Return the study of this file, with ``path=value`` overrides and more files of laws.

    plugins: ``refuse`` makes the law files that the study itself lists a mistake; ``run`` runs their code.
    Raises StudyError with every mistake, BrokenPlugin for a law that cannot be used.
    """
    file = Path(path)
    source = read_file(file)
    if isinstance(source.tree, dict):
        if plugins == "refuse":
            refuse_law_files(source)
        add_law_files(source, law_files)
    return Study(**read_values(source, overrides, file.parent), path=file)


def read_back(path: Path, codes: Mapping[str, str]) -> Study:
    """Return the study that a run saved; laws of other packages become records without physics. codes: their SHA-256.

    Raises StudyError with every mistake.
    """
    values = read_values(read_file(path), folder=path.parent, bring=saved_law_reader(codes), with_files=False)
    return Study(**values, path=path)


def parse_study(mapping: Mapping[str, Any], overrides: Sequence[str] = (), name: str = "study") -> Study:
    """Return the study of a mapping shaped like a study file; its plugins are relative to the working folder.

    Raises StudyError with every mistake, BrokenPlugin for a law that cannot be used.
    """
    return Study(**read_values(read_mapping(mapping, name), overrides))


def read_study(source: Source, bring: LawReader = read_laws) -> Study:
    """Study of values already read, such as a part of a larger file. Raises StudyError with every mistake."""
    return Study(**read_values(source, bring=bring))
