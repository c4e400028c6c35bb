"""Campaigns of random scenes, which are run by hand: each can be begun."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from profiles import deep


@deep("imports of all methods")
def test_every_campaign_is_found_with_its_drawer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(Path(__file__).parent), *sys.path])
    from drawers import kinds

    found = {name: kinds.campaign_of(name) for name in kinds.KINDS}

    assert all(callable(campaign.draw) for campaign in found.values())
