"""Elastic against hypoplastic snow over all that is unknown of two published runs: a Sobol design of pairs of runs."""
