"""What `import skisnow` offers, and what the contact as a room of its own adds to it: nothing."""

from __future__ import annotations

import subprocess
import sys

import skisnow

LOOK = """
import sys
import skisnow
before = list(skisnow.__all__)
loaded = "skisnow.compiled" in sys.modules
import skisnow.contact
print(loaded, skisnow.__all__ == before, set(skisnow.contact.__all__) & set(before))
"""


def test_the_contact_leaves_the_public_names_as_they_are() -> None:
    """And `import skisnow` alone does not load the compiled core."""
    told = subprocess.run([sys.executable, "-c", LOOK], check=True, capture_output=True, text=True).stdout
    assert told == "False True set()\n"


def test_every_public_name_is_there() -> None:
    assert [name for name in skisnow.__all__ if not hasattr(skisnow, name)] == []
    assert skisnow.__all__ == sorted(set(skisnow.__all__))
