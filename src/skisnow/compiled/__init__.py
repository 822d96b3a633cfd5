"""The compiled core, which must be built from the C++ sources in the same checkout."""

from __future__ import annotations

from pathlib import Path

from .sources import fingerprint

SOURCES = Path(__file__).parents[2] / "core"
"""Only in a checkout, not in an installed package."""
REMEDY = "build it with `pip install -e .` in the checkout, as `make test` does"

try:
    from . import _core as core
except ImportError as error:
    raise ImportError(f"the compiled core of skisnow cannot be loaded ({error}): {REMEDY}") from error


def require_current(built_from: str, sources: Path) -> None:
    """Refuse a core that was built from other sources than those that lie here."""
    if any(sources.rglob("*.cpp")) and fingerprint(sources) != built_from:
        raise ImportError(f"the compiled core of skisnow is older than its sources in {sources}: {REMEDY}")


require_current(core.SOURCE_HASH, SOURCES)

__all__ = ["core"]
