"""What had another name before; the former name stays for one release."""

from __future__ import annotations

import functools
import sys
import warnings
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Given = ParamSpec("Given")
Answer = TypeVar("Answer")


def warn_of_former_name(former: str, name: str, *, stacklevel: int = 2) -> None:
    """Say that something has another name now; `stacklevel` counts from the caller as for `warnings.warn`."""
    warnings.warn(
        f"{former} is called {name} now; the former name goes with the next release",
        DeprecationWarning,
        stacklevel=stacklevel + 1,
    )


def formerly(former: str, function: Callable[Given, Answer]) -> Callable[Given, Answer]:
    """The function under its former name, which warns when it is called.

    >>> import warnings
    >>> twice = formerly("doubled", lambda number: 2 * number)
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     twice(4)
    8
    >>> print(caught[0].message)
    doubled is called <lambda> now; the former name goes with the next release
    """

    @functools.wraps(function)
    def called(*args: Given.args, **named: Given.kwargs) -> Answer:
        warn_of_former_name(former, function.__name__)
        return function(*args, **named)

    called.__name__ = called.__qualname__ = former
    return called


def with_former_keywords(**names: str) -> Callable[[Callable[Given, Answer]], Callable[Given, Answer]]:
    """Let a function be called with the former names of its keywords, by former name; each warns.

    >>> import warnings
    >>> @with_former_keywords(anew="restart")
    ... def search(*, restart: bool = False) -> bool:
    ...     return restart
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     search(anew=True)
    True
    >>> print(caught[0].message)
    anew= of search is called restart= now; the former name goes with the next release
    """

    def decorated(function: Callable[Given, Answer]) -> Callable[Given, Answer]:
        @functools.wraps(function)
        def called(*args: Given.args, **named: Given.kwargs) -> Answer:
            for former in names.keys() & named.keys():
                warn_of_former_name(f"{former}= of {function.__name__}", f"{names[former]}=")
                named[names[former]] = named.pop(former)
            return function(*args, **named)

        return called

    return decorated


def former_attributes(package: str, names: Mapping[str, str]) -> Callable[[str], Any]:
    """The `__getattr__` of a package with renamed parts; names: the present ones by the former ones. Each warns."""

    def present(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        warn_of_former_name(f"{package}.{name}", f"{package}.{names[name]}")
        return getattr(sys.modules[package], names[name])

    return present
