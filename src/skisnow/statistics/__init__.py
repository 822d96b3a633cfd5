"""Least squares with intervals, bounded fits, nested F tests, resampling. Knows no snow."""

from .bounded import non_negative_fits
from .clusters import ClusterIntervals, cluster_intervals
from .combined_uncertainty import expanded_factor, percentile_interval, resampling_counts, welch_satterthwaite
from .f_tests import Anova, NestedTest, nested_f_test, one_way_anova, tests_per_group
from .linear import LinearFit, VarianceShares, linear_fit, polynomial_fit, variance_shares
from .nonlinear import NonlinearFit, nonlinear_fit
from .regress import Regress, RegressStatistics, regress

__all__ = [
    "Anova",
    "ClusterIntervals",
    "LinearFit",
    "NestedTest",
    "NonlinearFit",
    "Regress",
    "RegressStatistics",
    "VarianceShares",
    "cluster_intervals",
    "expanded_factor",
    "linear_fit",
    "nested_f_test",
    "non_negative_fits",
    "nonlinear_fit",
    "one_way_anova",
    "percentile_interval",
    "polynomial_fit",
    "regress",
    "resampling_counts",
    "tests_per_group",
    "variance_shares",
    "welch_satterthwaite",
]
