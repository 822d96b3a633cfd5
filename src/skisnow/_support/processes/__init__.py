"""Many computations at once: worker processes, and rows that are kept as they come."""
