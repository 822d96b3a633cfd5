"""Least squares with intervals, bounded fits, nested F tests, resampling. Knows no snow."""
