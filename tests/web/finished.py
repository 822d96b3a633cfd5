"""Work for an event loop, done in a separate thread: in this one a loop may run, the one that drives a browser."""

import asyncio
from collections.abc import Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

Answer = TypeVar("Answer")


def finished(work: Coroutine[Any, Any, Answer]) -> Answer:
    """The result."""
    with ThreadPoolExecutor(1) as beside:
        return beside.submit(asyncio.run, work).result()
