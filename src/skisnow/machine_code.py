"""Machine code of the compiled loops: made once, kept on the disk, and never that of another program.

Numba asks of what it keeps only whether the file of the outermost function is the same: an edited law that this one
calls would go unseen. Here everything is kept in a folder that bears the fingerprint of all files with compiled loops,
of compiler, Python and NumPy, and of the processor. Another fingerprint finds nothing, and takes older folders away.

Each file begins with the SHA-256 of the rest: what is damaged is thrown away and compiled anew.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import logging
import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, Final

import llvmlite.binding
import numba
import numpy as np
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from .errors import OutputError
from .files import require_writable, write_file

PACKAGE: Final = Path(__file__).resolve().parent
KERNELS: Final = ("machine_code.py", "ski/beam", "simulate/contact", "simulate/equilibrium", "simulate/motion")
"""Files and folders with all compiled loops and every constant that they take in."""
LOG: Final = logging.getLogger("skisnow.machine_code")
_DIGEST: Final = hashlib.sha256().digest_size
_SETTINGS: Any = numba.config  # Numba is untyped
_RESULT: Any = CompileResult
_DUMPED: Any = dumps
_SHAPING: Final = ("CPU_NAME", "CPU_FEATURES", "OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX", "BOUNDSCHECK")
"""Settings of Numba that make other code of the same source."""


def compiled(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """A decorator for functions of a module: `numba.njit` with these options, its machine code kept here."""

    def made(function: Callable[..., Any]) -> Any:
        loop = numba.njit(**options)(function)
        if hasattr(loop, "py_func"):  # with NUMBA_DISABLE_JIT it is the function itself
            loop._cache = _Keeping(function)
        return loop

    return made


def sources_fingerprint(package: Path = PACKAGE) -> str:
    """Tells one state of the files with compiled loops from every other; "" where their text is not at hand."""
    digest, found = hashlib.sha256(), False
    for place in KERNELS:
        path = package / place
        for file in [path] if path.suffix else sorted(path.glob("*.py")):
            with contextlib.suppress(OSError):
                digest.update(f"{place}/{file.name}\0".encode() + hashlib.sha256(file.read_bytes()).digest())
                found = True
    return digest.hexdigest() if found else ""


SOURCES: Final = sources_fingerprint()
"""Of this process: taken before the first loop is defined."""


@cache
def machine_fingerprint() -> str:
    """Tells one processor, Python, compiler and its settings from every other."""
    host = llvmlite.binding.get_host_cpu_name(), llvmlite.binding.get_host_cpu_features().flatten()
    versions = sys.version, numba.__version__, llvmlite.__version__, np.__version__
    chosen = [getattr(_SETTINGS, name, None) for name in _SHAPING]
    return hashlib.sha256(repr((versions, host, chosen)).encode()).hexdigest()


@cache
def place() -> Path:
    """The first folder of these that can be written: NUMBA_CACHE_DIR, beside the program, the user's cache.

    Where none can, one that lasts as long as this process and is handed to those that it starts.
    """
    for folder in _places():
        with contextlib.suppress(OutputError):
            require_writable(folder / _own_name())
            return folder
    folder = Path(tempfile.mkdtemp(prefix="skisnow-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    return folder


def _places() -> Iterator[Path]:
    from platformdirs import user_cache_path

    if not SOURCES:  # no fingerprint: nothing may outlive the process
        return
    if _SETTINGS.CACHE_DIR:
        yield Path(_SETTINGS.CACHE_DIR)
    yield PACKAGE / "__pycache__"
    yield user_cache_path("skisnow", appauthor=False)


def _own_name() -> str:
    """Of this copy of the program: others may share the place."""
    return f"skisnow-compiled-{hashlib.sha256(str(PACKAGE).encode()).hexdigest()[:12]}"


def folder() -> Path:
    """Where the code of this fingerprint is kept; it may not be there yet."""
    return place() / _own_name() / f"{machine_fingerprint()[:16]}-{SOURCES[:32]}"


def throw_away_older() -> None:
    """Remove what was made from another state of the sources, for whatever machine."""
    for other in folder().parent.glob("*-*"):
        if not other.name.endswith(f"-{SOURCES[:32]}"):
            shutil.rmtree(other, ignore_errors=True)


def keep(path: Path, content: bytes) -> None:
    """Write a file with its digest; where that cannot be done nothing is kept.

    Nor is it where the sources were edited after this process read them.
    """
    if sources_fingerprint() != SOURCES:
        return
    if not path.parent.is_dir():
        throw_away_older()
    with contextlib.suppress(OutputError):
        write_file(path, hashlib.sha256(content).digest() + content)


def kept(path: Path) -> bytes | None:
    """Content of a file; None where there is none. A damaged one is thrown away, with a word on standard error."""
    try:
        found = path.read_bytes()
    except OSError:
        return None
    content = found[_DIGEST:]
    if hashlib.sha256(content).digest() == found[:_DIGEST]:
        return content
    throw_away(path)
    return None


def throw_away(path: Path) -> None:
    """Remove a damaged file and say so."""
    LOG.warning("skisnow: kept machine code was damaged and is made anew: %s", path)
    with contextlib.suppress(OSError):
        path.unlink()


class _Keeping(NullCache):
    """What Numba asks for the code of one function, and hands over when it has made it."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._name = f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}".replace("<locals>.", "")

    @property
    def cache_path(self) -> str:
        return str(folder())

    def load_overload(self, signature: Any, target: Any) -> Any:
        """The code for a signature, or None."""
        target.refresh()
        path = self._path(signature, target.codegen())
        content = kept(path)
        if content is None:
            return None
        try:
            return _RESULT._rebuild(target, *pickle.loads(content))
        except Exception:  # whole, yet not to be read: never a reason to fail
            throw_away(path)
            return None

    def save_overload(self, signature: Any, result: Any) -> None:
        """Keep what was compiled, unless it holds addresses of this process."""
        if not (result.library.has_dynamic_globals or any(not each.can_cache for each in result.lifted)):
            keep(self._path(signature, result.codegen), _DUMPED(result._reduce()))

    def _path(self, signature: Any, codegen: Any) -> Path:
        told = hashlib.sha256(repr((signature, codegen.magic_tuple())).encode()).hexdigest()
        return folder() / f"{self._name}-{told[:24]}.nbc"
