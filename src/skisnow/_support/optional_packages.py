"""Packages that only some work needs (an extra each): loaded when that work is asked for."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import ParameterError


def needed(module: str, *, extra: str, what: str, instead: str = "") -> Any:
    """The module of a package that an extra installs.

    Parameters
    ----------
    module
        What is imported.
    extra
        The name of the extra in ``pyproject.toml``.
    what
        What cannot be done without it, as the beginning of a sentence.
    instead
        What else can be done, as the end of that sentence.

    Raises
    ------
    ParameterError
        It is not installed, or cannot be loaded.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise ParameterError(
            f"{what} needs {module}, which cannot be loaded ({error}): pip install 'skisnow[{extra}]'{instead}"
        ) from error
