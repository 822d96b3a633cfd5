"""The open benchmark set for contact with deforming snow: cases as files, and what runs and scores programs on them.

Nothing here but one entry knows skisnow; a program enters with files alone.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

VERSION: Final = "v1"
CASES: Final = Path(__file__).parent / VERSION
"""Folders of the cases of this version."""
