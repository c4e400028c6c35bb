"""Belt speeds at which the kind of a steady motion changes."""
