"""Contents of a replay's page."""

import base64
import json
import math
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np


def held_replay(page: Path, name: str) -> bytes:
    """The bytes of ``run`` or ``ghost``."""
    text = page.read_text(encoding="utf-8")
    (found,) = re.findall(rf'<script type="application/octet-stream" id="{name}">([^<]+)</script>', text)
    return base64.b64decode(found)


def unpacked(content: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Header and arrays of a replay, read as the text of the format says."""
    (length,) = struct.unpack("<I", content[4:8])
    header: dict[str, Any] = json.loads(content[8 : 8 + length])
    arrays = {}
    for name, of in header["arrays"].items():
        kind = {"float32": "<f4", "uint16": "<u2"}[of["type"]]
        numbers = np.frombuffer(content, kind, math.prod(of["shape"]), 8 + length + of["start"]).astype(float)
        arrays[name] = (of.get("lowest", 0.0) + of.get("step", 1.0) * numbers).reshape(of["shape"])
    return header, arrays
