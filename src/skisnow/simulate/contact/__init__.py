"""Snow against the base of a ski."""
