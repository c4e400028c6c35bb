"""The shape of a curve of mean friction: where it ends, how it bends."""
