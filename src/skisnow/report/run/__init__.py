"""Report of a simulated run."""
