"""Store of campaigns: raw files byte for byte in an SQLite file, or on a PostgreSQL server.

An import is one transaction: also if the process is killed, the store has the whole campaign or nothing of it. A
campaign's id is computed from its content, so the same files have the same id in all stores.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Self

from sqlalchemy import Engine

from ..._support.errors import StoreError
from ..._support.units import Facts, Shown
from . import folder as campaign_folder
from . import rows
from .engine import database_errors, file_errors, open_engine, reading, writing
from .folder import FileState, Progress, StoredFile, campaign_name, checked_bytes, no_progress
from .rows import StoredCampaign
from .schema import CHUNK_BYTES
from .server import ServerAddress, StorePlace, store_place
from .verification import Finding, findings

__all__ = ["AddedCampaign", "Finding", "Store", "StoredCampaign", "StoredFile", "default_path"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AddedCampaign(StoredCampaign):
    """Result of `Store.add`.

    already_stored: True if the same files were stored before; nothing was added.
    n_repaired: number of damaged files that were repaired.
    check_failure: reason why the check of the campaign failed, or None.
    """

    already_stored: bool
    n_repaired: int
    check_failure: str | None


class Store(Shown):
    """An open store, from `Store.open`; it is closed at the end of its ``with`` block.

    Every method raises `StoreError` with a remedy if the disk is full, the store is read-only, locked for longer than
    the timeout, or damaged. The store is then unchanged.

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
        """Open a store, and migrate it to the current schema.

        path: SQLite file, or a database as ``postgresql://USER@HOST/DATABASE`` (default: `default_path`).
        create: True to create a missing file with its folders, or missing tables in the database.
        busy_timeout_s: longest wait for another process that writes (s).
        Raises StoreError: the store does not exist, is something else, or has an unknown schema.
        """
        place = default_path() if path is None else store_place(path)
        if isinstance(place, ServerAddress):
            return cls(place, open_engine(place, create=create, busy_timeout_s=busy_timeout_s))
        with file_errors(place, "not_usable"):
            if place.is_dir():
                raise StoreError("{place} is a folder, not a store; name a file.").tag("not_a_file", place=place)
            if not place.exists():
                if not create:
                    raise StoreError("There is no store at {place}; add a campaign first, or name another file.").tag(
                        "no_store", place=place
                    )
                place.parent.mkdir(parents=True, exist_ok=True)
        return cls(place, open_engine(place, create=create, busy_timeout_s=busy_timeout_s))

    def _repr_facts(self) -> Facts:
        """Path of the store, for the representation."""
        return Facts(f"at {self.path}")

    def close(self) -> None:
        """Close all connections to the database file."""
        self.engine.dispose()

    def __enter__(self) -> Self:
        """The store itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the store at the end of the block."""
        self.close()

    def add(self, folder: Path, *, progress: Progress = no_progress) -> AddedCampaign:
        """Store all files below a folder unchanged, also if they are not a valid campaign.

        Files are read twice, for the campaign's id and to store them. If a file changes in between, nothing is stored.
        Other writers wait only during the second reading.

        Raises StoreError: the folder does not exist, is empty, contains a link or the like, or a file changed while it
            was read.
        """
        folder = Path(folder)
        with file_errors(folder, "not_read"):
            before = self._files_to_add(folder)
            n_bytes = sum(size for size, _ in before.values())
            files = _hashed_files(folder, before, lambda done: progress(done, 2 * n_bytes))
            (n_errors, n_warnings), failure = _check(folder)
            sha256 = campaign_folder.manifest_sha256(files)
            id_, name, added_at = sha256[: rows.ID_DIGITS], campaign_name(folder), datetime.now(UTC)
            campaign = StoredCampaign(id_, name, added_at, sha256, n_errors, n_warnings, files)
            with database_errors(self.path, "not_stored"), writing(self.engine) as connection:
                n_repaired, done = 0, n_bytes
                for file in files:
                    n_repaired += rows.store_content(connection, folder, file)
                    done += file.size
                    progress(done, 2 * n_bytes)
                is_new = rows.store_campaign(connection, campaign)
                rows.refuse_changed(campaign_folder.changed_files(before, campaign_folder.list_files(folder)))
        fields = {field: getattr(campaign, field) for field in StoredCampaign.__slots__}
        return AddedCampaign(**fields, already_stored=not is_new, n_repaired=n_repaired, check_failure=failure)

    def _files_to_add(self, folder: Path) -> dict[str, FileState]:
        """Files below a folder; rejects no folder, an empty one, and one that contains the store itself."""
        if not folder.is_dir():
            raise StoreError("{folder} is not a folder; name the folder with the campaign's files.").tag(
                "no_folder", folder=folder
            )
        if isinstance(self.path, Path) and self.path.resolve().is_relative_to(folder.resolve()):
            raise StoreError("The store {path} is in {folder} itself; keep it somewhere else.").tag(
                "inside_folder", path=self.path, folder=folder
            )
        files = campaign_folder.list_files(folder)
        if not files:
            raise StoreError("{folder} contains no file; name the folder with the campaign's files.").tag(
                "no_files", folder=folder
            )
        return files

    def remove(self, id: str) -> StoredCampaign:
        """Remove a campaign without corrections, and the contents that no other campaign has; returns it.

        A later sync brings it back from a group's store that has it.

        Raises StoreError: as in `show`; or the campaign has corrections.
        """
        with database_errors(self.path, "not_written"), writing(self.engine) as connection:
            stored = rows.one_campaign(connection, id)
            rows.remove_campaign(connection, stored)
        return stored

    def list(self) -> tuple[StoredCampaign, ...]:
        """All campaigns, oldest first."""
        with database_errors(self.path, "not_read"), reading(self.engine) as connection:
            return tuple(rows.stored_campaign(connection, row) for row in rows.campaign_rows(connection).values())

    def show(self, id: str) -> StoredCampaign:
        """One campaign by its id or the beginning of it (at least 4 digits).

        Raises StoreError: the id is unknown or ambiguous; the message lists candidates.
        """
        with database_errors(self.path, "not_read"), reading(self.engine) as connection:
            return rows.one_campaign(connection, id)

    def export(
        self,
        id: str,
        out_folder: Path,
        *,
        progress: Progress = no_progress,
        complete: Callable[[Path], object] | None = None,
    ) -> StoredCampaign:
        """Export a campaign's original files to a new folder; `export_corrected` adds later corrections.

        The folder gets its name after all files are on the disk and verified. ``complete`` is called with it before,
        and can add files.

        Raises StoreError: as in `show`; the folder exists and is not empty; a file is damaged or its path is not safe
            here.
        """
        out, done = Path(out_folder), 0
        with database_errors(self.path, "not_read"), reading(self.engine) as connection:
            stored = rows.one_campaign(connection, id)
            rows.require_whole(stored)
            with file_errors(out, "not_written"), campaign_folder.new_folder(out) as filling:
                for file in stored.files:
                    campaign_folder.write_file(filling, file, rows.stored_chunks(connection, file.sha256))
                    done += file.size
                    progress(done, stored.n_bytes)
                if complete is not None:
                    complete(filling)
        return stored

    def contents(self, id: str, names: Container[str]) -> tuple[StoredCampaign, dict[str, bytes]]:
        """Original bytes of some of a campaign's files, by path; missing ones are omitted.

        Raises StoreError: as in `show`; a file is damaged.
        """
        with database_errors(self.path, "not_read"), reading(self.engine) as connection:
            stored = rows.one_campaign(connection, id)
            rows.require_whole(stored)
            chosen = [file for file in stored.files if file.path in names]
            contents = ((file, rows.stored_chunks(connection, file.sha256)) for file in chosen)
            return stored, {file.path: checked_bytes(file, pieces) for file, pieces in contents}

    def verify(self, *, progress: Progress = no_progress) -> tuple[Finding, ...]:
        """Search for damage: checks of the database, hashes of all files, ids of all campaigns; () without damage."""
        with database_errors(self.path, "not_read"), reading(self.engine) as connection:
            return findings(connection, progress)


def default_path() -> Path:
    """File of the user's own store, which is used if no other is named."""
    from platformdirs import user_data_path

    return user_data_path("skisnow") / "store.sqlite3"


def _hashed_files(
    folder: Path, states: Mapping[str, FileState], progress: Callable[[int], object]
) -> tuple[StoredFile, ...]:
    """Hash each file below a folder; ``progress`` is called with the number of bytes so far."""
    files, done = [], 0
    for path, (expected_size, _) in states.items():
        digest, size = hashlib.sha256(), 0
        for piece in campaign_folder.read_chunks(folder / path, CHUNK_BYTES):
            digest.update(piece)
            size += len(piece)
            progress(done + size)
        if size != expected_size:
            rows.refuse_changed([path])
        files.append(StoredFile(path, size, digest.hexdigest()))
        done += size
    return tuple(files)


def _check(folder: Path) -> tuple[tuple[int | None, int | None], str | None]:
    """Check a campaign: numbers of errors and of warnings that need an action; reason why the check failed, or None."""
    from ..reading.campaign import check_campaign

    try:
        problems = check_campaign(folder)
    except Exception as error:  # whatever breaks in the check, raw data are kept; the caller gets the error
        return (None, None), f"{type(error).__name__}: {error}"
    severities = [problem.severity for problem in problems if problem.needs_action]
    return (severities.count("error"), severities.count("warning")), None
