"""The store of campaigns: raw files stored byte for byte in one SQLite file, or on a PostgreSQL server.

An import is one transaction: after it, or after the process was killed in its midst, the store holds the whole campaign
or nothing of it. A campaign's id comes from its content, so the same files get the same id wherever they are added.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Self

from ..._support.display import Facts, Shown
from ..._support.errors import StoreError
from .engine import database_errors, file_errors, open_engine, reading, writing
from .folder import (
    FileState,
    Progress,
    StoredFile,
    campaign_name,
    changed_files,
    checked_bytes,
    list_files,
    manifest_sha256,
    new_folder,
    no_progress,
    read_chunks,
    write_file,
)
from .rows import (
    ID_DIGITS,
    StoredCampaign,
    all_campaigns,
    one_campaign,
    refuse_changed,
    require_whole,
    store_campaign,
    store_content,
    stored_chunks,
)
from .schema import CHUNK_BYTES
from .server import ServerAddress, store_place
from .verification import Finding, findings

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Mapping
    from types import TracebackType

    from sqlalchemy import Engine

    from .server import StorePlace

__all__ = ["AddedCampaign", "Finding", "Store", "StoredCampaign", "StoredFile", "default_path"]


@dataclass(frozen=True, slots=True)
class AddedCampaign:
    """What `Store.add` stored.

    Attributes
    ----------
    id, name, sha256, n_errors, n_warnings
        As in `StoredCampaign`.
    n_files, n_bytes
        How much the campaign holds.
    already_stored
        The same files were there before; nothing was added.
    n_repaired
        Files that were there but damaged, and now are whole again.
    check_failure
        Why the check of the campaign itself failed, else None.
    """

    id: str
    name: str
    n_files: int
    n_bytes: int
    sha256: str
    already_stored: bool
    n_repaired: int
    n_errors: int | None
    n_warnings: int | None
    check_failure: str | None


@dataclass(frozen=True, slots=True)
class _Check:
    """Outcome of checking a campaign before it is stored."""

    n_errors: int | None
    n_warnings: int | None
    failure: str | None


class Store(Shown):
    """An open store; made by `Store.open`, closed by leaving its ``with`` block.

    Every method raises `StoreError`, with what to do, where the disk is full, the store is read-only or locked for
    longer than the timeout, or the file is damaged; the store then is as it was.

    See Also
    --------
    skisnow.read_campaign
    """

    def __init__(self, path: StorePlace, engine: Engine) -> None:
        self.path = path
        self.engine = engine

    @classmethod
    def open(
        cls, path: Path | str | ServerAddress | None = None, *, create: bool = True, busy_timeout_s: float = 30.0
    ) -> Self:
        """Open a store, and bring it to the present schema.

        Parameters
        ----------
        path
            The SQLite file, or a database as ``postgresql://USER@HOST/DATABASE``; None: the user's own file, see
            `default_path`.
        create
            Make the file, and the folders above it, or the tables in the database, where there are none.
        busy_timeout_s
            How long to wait for another process that writes (s).

        Raises
        ------
        StoreError
            There is none, or it is something else, or its schema is unknown.
        """
        place = default_path() if path is None else store_place(path)
        if isinstance(place, ServerAddress):
            return cls(place, open_engine(place, create=create, busy_timeout_s=busy_timeout_s))
        with file_errors(place, "cannot be used as a store"):
            if place.is_dir():
                raise StoreError(f"{place} is a folder, not a store; name a file.")
            if not place.exists():
                if not create:
                    raise StoreError(f"There is no store at {place}; add a campaign first, or name another file.")
                place.parent.mkdir(parents=True, exist_ok=True)
        return cls(place, open_engine(place, create=create, busy_timeout_s=busy_timeout_s))

    def _facts(self) -> Facts:
        return Facts(f"at {self.path}")

    def close(self) -> None:
        """Let go of the file or the server."""
        self.engine.dispose()

    def __enter__(self) -> Self:
        """Use the store for the length of a block."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the store at the end of the block."""
        self.close()

    def add(self, folder: Path, *, progress: Progress = no_progress) -> AddedCampaign:
        """Keep all files below a folder, as they are, whether or not they make a sound campaign.

        Files are read twice: once to know the campaign's id, once to store them; a file that changes in between refuses
        the campaign. Only the second reading holds other writers up.

        Raises
        ------
        StoreError
            No such folder, no file in it, a link or the like in it, or a file that changed while it was read.
        """
        folder = Path(folder)
        with file_errors(folder, "could not be read"):
            before = self._files_to_add(folder)
            n_bytes = sum(state.size for state in before.values())
            files = _hashed_files(folder, before, lambda done: progress(done, 2 * n_bytes))
            name, check = campaign_name(folder), _check(folder)
            sha256 = manifest_sha256(files)
            with database_errors(self.path, "could not take the campaign in"), writing(self.engine) as connection:
                n_repaired, done = 0, n_bytes
                for file in files:
                    n_repaired += store_content(connection, folder, file)
                    done += file.size
                    progress(done, 2 * n_bytes)
                is_new = store_campaign(connection, files, sha256, name, (check.n_errors, check.n_warnings))
                refuse_changed(changed_files(before, list_files(folder)))
        return AddedCampaign(
            id=sha256[:ID_DIGITS],
            name=name,
            n_files=len(files),
            n_bytes=n_bytes,
            sha256=sha256,
            already_stored=not is_new,
            n_repaired=n_repaired,
            n_errors=check.n_errors,
            n_warnings=check.n_warnings,
            check_failure=check.failure,
        )

    def _files_to_add(self, folder: Path) -> dict[str, FileState]:
        if not folder.is_dir():
            raise StoreError(f"{folder} is no folder; name the folder that holds the campaign's files.")
        if isinstance(self.path, Path) and self.path.resolve().is_relative_to(folder.resolve()):
            raise StoreError(f"The store {self.path} lies in {folder} itself; keep it somewhere else.")
        files = list_files(folder)
        if not files:
            raise StoreError(f"{folder} holds no file; name the folder that holds the campaign's files.")
        return files

    def list(self) -> tuple[StoredCampaign, ...]:
        """Give all campaigns, oldest first."""
        with database_errors(self.path, "could not be read"), reading(self.engine) as connection:
            return all_campaigns(connection)

    def show(self, id: str) -> StoredCampaign:  # noqa: A002 (users know it by this name)
        """Give one campaign by its id or the beginning of it (at least 4 digits).

        Raises
        ------
        StoreError
            No campaign or several begin so; the message lists those that may be meant.
        """
        with database_errors(self.path, "could not be read"), reading(self.engine) as connection:
            return one_campaign(connection, id)

    def export(
        self,
        id: str,  # noqa: A002
        out_folder: Path,
        *,
        progress: Progress = no_progress,
        complete: Callable[[Path], object] | None = None,
    ) -> StoredCampaign:
        """Give a campaign's files back as they came in, in a new folder; `export_corrected` adds later corrections.

        The folder appears under its name when all files are on the disk and their hashes were checked. ``complete`` is
        called with it just before, and can put more into it.

        Raises
        ------
        StoreError
            As in `show`; the folder is there already and not empty; a file is damaged or its path is not safe here.
        """
        out, done = Path(out_folder), 0
        with database_errors(self.path, "could not be read"), reading(self.engine) as connection:
            stored = one_campaign(connection, id)
            require_whole(stored)
            with file_errors(out, "could not be written"), new_folder(out) as filling:
                for file in stored.files:
                    write_file(filling, file, stored_chunks(connection, file.sha256))
                    done += file.size
                    progress(done, stored.n_bytes)
                if complete is not None:
                    complete(filling)
        return stored

    def contents(
        self,
        id: str,  # noqa: A002
        names: Container[str],
    ) -> tuple[StoredCampaign, dict[str, bytes]]:
        """Give some of a campaign's files as they came in, by their paths; those that it does not have are left out.

        Raises
        ------
        StoreError
            As in `show`; a file is damaged.
        """
        with database_errors(self.path, "could not be read"), reading(self.engine) as connection:
            stored = one_campaign(connection, id)
            require_whole(stored)
            chosen = [file for file in stored.files if file.path in names]
            return stored, {file.path: checked_bytes(file, stored_chunks(connection, file.sha256)) for file in chosen}

    def verify(self, *, progress: Progress = no_progress) -> tuple[Finding, ...]:
        """Look for damage: the database's own checks, the hash of every file, the id of every campaign; () if sound."""
        with database_errors(self.path, "could not be read"), reading(self.engine) as connection:
            return findings(connection, progress)


def default_path() -> Path:
    """Place of the user's own store."""
    from platformdirs import user_data_path

    return user_data_path("skisnow") / "store.sqlite3"


def _hashed_files(
    folder: Path, states: Mapping[str, FileState], progress: Callable[[int], None]
) -> tuple[StoredFile, ...]:
    """Take the hash of each file; ``progress`` is called with how many bytes are done."""
    files, done = [], 0
    for path, state in states.items():
        digest, size = hashlib.sha256(), 0
        for piece in read_chunks(folder / path, CHUNK_BYTES):
            digest.update(piece)
            size += len(piece)
            progress(done + size)
        if size != state.size:
            refuse_changed([path])
        files.append(StoredFile(path, size, digest.hexdigest()))
        done += size
    return tuple(files)


def _check(folder: Path) -> _Check:
    from ..reading.campaign import check_campaign

    try:
        problems = check_campaign(folder)
    except Exception as error:  # whatever breaks in the check, raw data are kept; the caller gets the error
        return _Check(None, None, f"{type(error).__name__}: {error}")
    severities = [problem.severity for problem in problems]
    return _Check(severities.count("error"), severities.count("warning"), None)
