"""The equation of motion, the contact, and the events of a motion."""
