"""Web lab: pages over the library, served to a browser. It contains no formula."""

from __future__ import annotations

from .settings import Lab, Limits

__all__ = ["Lab", "Limits"]
