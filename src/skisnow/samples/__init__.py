"""Synthetic sample files for every command that the documentation shows."""

from __future__ import annotations

from .folder import write_samples

__all__ = ["write_samples"]
