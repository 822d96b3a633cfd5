"""PNGs of drawings with few colours: a third of the bytes. Scales of colours keep theirs within a few levels."""

from __future__ import annotations

from pathlib import Path
from typing import IO

from PIL import Image

COLOURS = 256


def write_fewer_colours(path: Path, drawn: Path | IO[bytes] | None = None, *, colours: int = COLOURS) -> None:
    """Write a picture with so many colours, `drawn` or that which stands at the path."""
    with Image.open(drawn or path) as picture:
        fewer = picture.convert("RGB").quantize(colours, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    fewer.save(path, optimize=True)
