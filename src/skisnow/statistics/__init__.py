"""Least squares with intervals, bounded fits, nested F tests, resampling. Knows no snow."""

from .bounded import non_negative_fits
from .combined_uncertainty import expanded_factor, percentile_interval, resampling_counts, welch_satterthwaite
from .f_tests import NestedTest, nested_f_test, tests_per_group
from .linear import ClusterIntervals, LinearFit, VarianceShares, cluster_intervals, linear_fit, variance_shares

__all__ = [
    "ClusterIntervals", "LinearFit", "NestedTest", "VarianceShares",
    "cluster_intervals", "expanded_factor", "linear_fit", "nested_f_test", "non_negative_fits", "percentile_interval",
    "resampling_counts", "tests_per_group", "variance_shares", "welch_satterthwaite",
]  # fmt: skip
