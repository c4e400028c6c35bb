"""CITATION.cff says of the package what pyproject.toml does."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

PROJECT = Path(__file__).parent.parent


def test_the_citation_is_that_of_the_package() -> None:
    cited: dict[str, Any] = YAML(typ="safe").load((PROJECT / "CITATION.cff").read_text())
    package = tomllib.loads((PROJECT / "pyproject.toml").read_text())["project"]

    assert cited.keys() >= {"cff-version", "message", "title", "authors"}  # what the format requires
    assert (
        cited["title"]
        == f"{package['name']}: {package['description'][:1].lower()}{package['description'][1:-1]}"
    )
    assert [cited["version"], cited["license"]] == [package["version"], package["license"]]
    assert [author["name"] for author in cited["authors"]] == [
        author["name"] for author in package["authors"]
    ]
    assert cited["keywords"] == package["keywords"]
