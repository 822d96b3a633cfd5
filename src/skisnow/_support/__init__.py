"""Helpers of every package: files, texts, errors, units, processes; it knows no snow and no ski."""
