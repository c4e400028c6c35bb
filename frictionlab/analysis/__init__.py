"""Questions asked of curves: what a scene needs, sensitivities, fits, response of a contact."""

from __future__ import annotations
