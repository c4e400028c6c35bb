"""What the campaigns draw, and what they compare it with."""
