"""The checks every law must pass, by subject."""
