"""Time steppers, one per file."""
