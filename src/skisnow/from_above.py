"""The one way in which an object reaches what is done with it above, in an upper package or file, such as `run.plot()`.

Nothing is imported before it is called, so that the lower one works without the upper. A test lists all such places.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


def from_above(package: str, name: str) -> Any:
    """A function of an upper package, by name.

    Parameters
    ----------
    package
        The module inside the package, such as "report.run_folder".
    name
        The function.

    >>> from_above("json_number", "json_number")(2)
    2.0
    """
    return getattr(import_module(f"{__package__}.{package}"), name)
