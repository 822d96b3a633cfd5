"""The solver before the compiled core, kept to judge it: machine code by Numba, linearly implicit steps."""
