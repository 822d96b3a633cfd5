"""Files that are complete or not there: written to a temporary name, then moved into place."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from .errors import OutputError


def write_file(path: str | Path, content: str | bytes) -> None:
    """Write a file in one piece; text as UTF-8 with plain line ends. An existing file is replaced.

    Raises
    ------
    OutputError
        The place cannot be written or is full; whatever stood there before still does.
    """
    path = Path(path)
    data = content.encode("utf-8") if isinstance(content, str) else content
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".partial", dir=path.parent)
        temporary = Path(name)
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        reason = error.strerror or error
        raise OutputError(f"{path} cannot be written: {reason}. Choose another place or free some space.") from error
