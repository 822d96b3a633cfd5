"""Packages that can be called: `skisnow.simulate(turn)`, where `skisnow.simulate` is also the folder of the verb."""

from __future__ import annotations

import inspect
import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


def make_callable(package: str, module: str, verb: str) -> None:
    """Let calling a package call a function in it, which is loaded with the first call.

    So the name stays callable whatever was imported first: importing a package binds its name to the folder.

    Parameters
    ----------
    package
        ``__name__`` of the package that calls this.
    module, verb
        The module in it, such as ".simulated_run", and the function there.
    """

    def loaded() -> Callable[..., Any]:
        found: Callable[..., Any] = getattr(import_module(module, package), verb)
        return found

    class CallablePackage(ModuleType):
        """A package that is a verb, too."""

        def __call__(self, *args: Any, **named: Any) -> Any:
            return loaded()(*args, **named)

        @property
        def __signature__(self) -> inspect.Signature:
            return inspect.signature(loaded())

    CallablePackage.__call__.__doc__ = f"Call `{package}{module}.{verb}`."
    sys.modules[package].__class__ = CallablePackage
