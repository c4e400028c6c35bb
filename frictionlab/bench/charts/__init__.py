"""The charts of bench results; no word of what is drawn is decided here."""
