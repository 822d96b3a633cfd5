"""Seeded fuzzing of every reader of files; `python -m tests.fuzzing --help` describes the long runs."""
