"""Numbers with units, columns of tables, mistakes in what is given, and text as it is shown."""

from __future__ import annotations
