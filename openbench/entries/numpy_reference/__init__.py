"""The cases again in plain NumPy, slow and readable: nothing of any program, lines that stand still, cells on them."""
