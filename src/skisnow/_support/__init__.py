"""Helpers of every package: files, texts, errors, units, processes. They depend on no other package."""
