"""What `import skisnow` offers, and what the contact as a room of its own adds to it: nothing."""

from __future__ import annotations

import subprocess
import sys

import skisnow

LOOK = """
import sys
import skisnow
before = list(skisnow.__all__)
assert "skisnow.compiled" not in sys.modules
import skisnow.contact
assert skisnow.__all__ == before
assert not set(skisnow.contact.__all__) & set(before)
"""


def test_the_contact_leaves_the_public_names_as_they_are() -> None:
    subprocess.run([sys.executable, "-c", LOOK], check=True)


def test_every_public_name_is_there() -> None:
    assert [name for name in skisnow.__all__ if not hasattr(skisnow, name)] == []
    assert skisnow.__all__ == sorted(set(skisnow.__all__))
