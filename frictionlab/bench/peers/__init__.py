"""Other people's integrators on our scenes, driven as a skilled user would: what our methods are timed beside."""

from __future__ import annotations
