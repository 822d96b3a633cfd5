"""Contents of a replay's page."""

import base64
import re
from pathlib import Path


def held_replay(page: Path, name: str) -> bytes:
    """The bytes of ``run`` or ``ghost``."""
    text = page.read_text(encoding="utf-8")
    (found,) = re.findall(rf'<script type="application/octet-stream" id="{name}">([^<]+)</script>', text)
    return base64.b64decode(found)
