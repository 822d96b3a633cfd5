"""Finite elements of a flexible ski: bending, torsion, and the banded systems they make."""
