"""Coulomb friction along the belt, leg by leg in closed form."""
