"""Reports of measured tracks and of their comparison with runs."""
