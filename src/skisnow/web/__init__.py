"""The web lab: pages over the library, served to a browser on the same machine. No formula lives here."""

from __future__ import annotations

from .settings import Lab, Limits

__all__ = ["Lab", "Limits"]
