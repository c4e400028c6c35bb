"""Fixtures of the tests of the runner: methods that do as told."""

from __future__ import annotations

import pytest
from fake_methods import Another, Fake, Trouble, register


@pytest.fixture
def fakes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Studies may name the fake methods."""
    register(monkeypatch, fake=Fake, another=Another)


@pytest.fixture
def trouble(monkeypatch: pytest.MonkeyPatch) -> Trouble:
    """Gives the fakes trouble at these belt speeds."""
    return lambda troubles: monkeypatch.setattr(Fake, "troubles", troubles)
