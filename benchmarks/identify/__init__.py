"""How long an identification takes, beside a plain least-squares program: ``python -m benchmarks identify``."""
