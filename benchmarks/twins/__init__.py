"""Data computed from a known truth, and what identification makes of them: ``python -m benchmarks.twins``."""
