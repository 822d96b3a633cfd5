"""The page on the dynamics and the sources name the same equations."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "methods" / "dynamics.md").read_text("utf-8")
PLAIN = re.sub(r"\$.*?\$", "", re.sub(r"\$\$.*?\$\$", "", PAGE, flags=re.DOTALL), flags=re.DOTALL)
CORE = ROOT / "src" / "core"
FILES = (
    "dynamics/boots.cpp",
    "dynamics/dynamics.cpp",
    "dynamics/moving_boots.cpp",
    "dynamics/statics.cpp",
    "dynamics/steps.cpp",
    "beam/along.cpp",
    "contact/tangent_kernels.hpp",
)
SOURCES = "\n".join((CORE / name).read_text("utf-8") for name in FILES)


def test_marks() -> None:
    """In brackets, without links."""
    in_sources = set(re.findall(r"^// \[([a-z ]+)\]", SOURCES, re.MULTILINE))
    assert {"predict", "static matrix", "observe"} <= in_sources
    assert set(re.findall(r"\[([a-z ]+)\](?!\()", PLAIN)) == in_sources


def test_constants() -> None:
    """Of the error's estimate and of the choice of steps."""
    milne, safety = (re.search(rf"\b{name} = ([\d.]+)", SOURCES) for name in ("MILNE", "SAFETY"))
    assert milne is not None
    assert safety is not None
    assert f"e = {milne[1]}" in PAGE
    assert f"${safety[1]}\\,(\\text{{tolerance}}/e)" in PAGE
    assert "longest * std::exp2(0.25 *" in SOURCES  # four rungs to a factor of two
