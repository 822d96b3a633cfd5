"""Packages that only some work needs (an extra each): loaded when they are needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import ParameterError
from .messages import Message, joined


def needed(module: str, *, extra: str, what: Message, instead: Message | None = None) -> Any:
    """The module of a package that an extra installs.

    Parameters
    ----------
    module
        What is imported.
    extra
        The name of the extra in ``pyproject.toml``.
    what
        Work that is impossible without it, a noun phrase.
    instead
        Another way, a whole sentence.

    Raises
    ------
    ParameterError
        It is not installed, or cannot be loaded.
    """
    try:
        return import_module(module)
    except ImportError as error:
        problem = Message(
            "{what} needs {module}, which cannot be loaded ({error}). Install it: pip install 'skisnow[{extra}]'.",
            what=what,
            module=module,
            error=error,
            extra=extra,
        )
        raise ParameterError(joined([problem, instead]) if instead else problem, code="package_missing") from error
