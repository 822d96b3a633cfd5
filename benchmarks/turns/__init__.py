"""Simulated turns: how fast, and how far off: ``python -m benchmarks turns``."""
