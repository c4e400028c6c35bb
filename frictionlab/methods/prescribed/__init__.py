"""Mean friction of a prescribed slip."""
