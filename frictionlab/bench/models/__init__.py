"""Speed against accuracy over models: what laws, simpler scenes and methods cost, and how far they are off."""
