"""Rooms that can be called: `skisnow.simulate(turn)`, where `skisnow.simulate` is also the folder of the verb."""

from __future__ import annotations

import inspect
import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


def make_callable(room: str, module: str, verb: str) -> None:
    """Let calling a room call a function in it, which is loaded with the first call.

    So the name stays callable whatever was imported first: importing a room binds its name to the folder.

    Parameters
    ----------
    room
        ``__name__`` of the package that calls this.
    module, verb
        The module in it, such as ".simulated_run", and the function there.
    """

    def loaded() -> Callable[..., Any]:
        found: Callable[..., Any] = getattr(import_module(module, room), verb)
        return found

    class CallableRoom(ModuleType):
        """A room that is a verb, too."""

        def __call__(self, *args: Any, **named: Any) -> Any:
            return loaded()(*args, **named)

        @property
        def __signature__(self) -> inspect.Signature:
            return inspect.signature(loaded())

    CallableRoom.__call__.__doc__ = f"Call `{room}{module}.{verb}`."
    sys.modules[room].__class__ = CallableRoom
