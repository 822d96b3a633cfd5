"""The gallery's examples as the builder of its pages runs them."""

import importlib.util
import sys
from pathlib import Path
from typing import Any

from tests.present import present

ROOT = Path(__file__).resolve().parents[2]


def builder() -> Any:
    """The module ``docs/write_gallery.py``."""
    if "write_gallery" not in sys.modules:
        spec = present(importlib.util.spec_from_file_location("write_gallery", ROOT / "docs" / "write_gallery.py"))
        module = importlib.util.module_from_spec(spec)
        sys.modules["write_gallery"] = module
        present(spec.loader).exec_module(module)
    return sys.modules["write_gallery"]
