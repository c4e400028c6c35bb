"""Numbers with units: texts such as 2 mm/s as numbers in SI units, and numbers as they are shown."""
