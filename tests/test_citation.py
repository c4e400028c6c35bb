"""CITATION.cff and the conda recipe say of the package what pyproject.toml does."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from frictionlab.report.sources import itself

PROJECT = Path(__file__).parent.parent
PACKAGE: dict[str, Any] = tomllib.loads((PROJECT / "pyproject.toml").read_text())["project"]


def test_the_conda_recipe_is_that_of_the_package() -> None:
    recipe: dict[str, Any] = YAML(typ="safe").load((PROJECT / "conda" / "recipe.yaml").read_text())
    needed = [f"python{PACKAGE['requires-python']}", *PACKAGE["dependencies"]]
    named = [each.replace("matplotlib>", "matplotlib-base>").replace(">=", " >=") for each in needed]
    (script,) = PACKAGE["scripts"].items()

    assert recipe["context"]["version"] == PACKAGE["version"]
    assert recipe["requirements"]["run"] == named
    assert recipe["build"]["python"]["entry_points"] == [" = ".join(script)]
    assert [recipe["about"]["summary"], recipe["about"]["license"]] == [
        PACKAGE["description"],
        PACKAGE["license"],
    ]


def test_the_citation_is_that_of_the_package() -> None:
    cited: dict[str, Any] = YAML(typ="safe").load((PROJECT / "CITATION.cff").read_text())

    assert cited.keys() >= {"cff-version", "message", "title", "authors"}  # what the format requires
    assert (
        cited["title"]
        == f"{PACKAGE['name']}: {PACKAGE['description'][:1].lower()}{PACKAGE['description'][1:-1]}"
    )
    assert f"title = {{{cited['title']}}}" in itself(PACKAGE["version"]).bibtex
    assert f"year = {{{cited['date-released'].year}}}" in itself(PACKAGE["version"]).bibtex
    assert "year" not in itself("0.0.0").fields
    assert [cited["version"], cited["license"]] == [PACKAGE["version"], PACKAGE["license"]]
    assert [author["name"] for author in cited["authors"]] == [
        author["name"] for author in PACKAGE["authors"]
    ]
    assert cited["keywords"] == PACKAGE["keywords"]
