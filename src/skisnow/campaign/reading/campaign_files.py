"""Where the files of a campaign lie: in a folder, or in memory."""

from __future__ import annotations

import hashlib
import stat
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from ..problems import error, warning

if TYPE_CHECKING:
    from ..problems import Problem
    from .text import UnreadableTextError


class CampaignFiles(Protocol):
    """Files by name, of one campaign."""

    @property
    def folder(self) -> Path:
        """The folder; of files in memory one by whose name the campaign goes where it has none."""
        ...

    def read(self, name: str) -> bytes | None:
        """A file's bytes; None where it is something that is no plain file.

        Raises
        ------
        FileNotFoundError
            There is no such file.
        OSError
            It cannot be read.
        """
        ...

    def names(self) -> dict[str, bool]:
        """What lies there, and whether it is a file."""
        ...


@dataclass(frozen=True, slots=True)
class FilesOfFolder:
    """The files of a folder."""

    folder: Path

    def read(self, name: str) -> bytes | None:
        """See `CampaignFiles.read`."""
        path = self.folder / name
        # a pipe would be waited for, a folder cannot be read
        return path.read_bytes() if stat.S_ISREG(path.stat().st_mode) else None

    def names(self) -> dict[str, bool]:
        """See `CampaignFiles.names`."""
        return {path.name: path.is_file() for path in self.folder.iterdir()}


@dataclass(frozen=True, slots=True, eq=False)
class FilesInMemory:
    """Files that are at hand.

    Attributes
    ----------
    contents
        By name.
    others
        Names of files that are no part of a campaign, whose contents nobody asks for.
    folder
        By whose name the campaign goes where its description has none; nothing is looked for there.
    """

    contents: Mapping[str, bytes]
    others: tuple[str, ...] = ()
    folder: Path = Path("campaign")

    def read(self, name: str) -> bytes | None:
        """See `CampaignFiles.read`."""
        if name not in self.contents:
            raise FileNotFoundError(name)
        return self.contents[name]

    def names(self) -> dict[str, bool]:
        """See `CampaignFiles.names`."""
        return dict.fromkeys((*self.contents, *self.others), True)


@dataclass(frozen=True, slots=True)
class RawFiles:
    """Reads files of one campaign and remembers what it met.

    Attributes
    ----------
    files
        Where they lie.
    found
        Takes the problems.
    hashes
        SHA-256 of each file that was read.
    absent
        Names that were asked for and are not there.
    """

    files: CampaignFiles
    found: list[Problem] = field(default_factory=list)
    hashes: dict[str, str] = field(default_factory=dict)
    absent: set[str] = field(default_factory=set)

    def read(self, name: str) -> bytes | None:
        """Give a file's bytes; None where it is absent, or cannot be read, which is reported."""
        try:
            data = self.files.read(name)
        except FileNotFoundError:
            self.absent.add(name)
            return None
        except OSError as failure:
            self._refuse(name, failure.strerror or str(failure))
            return None
        if data is None:
            self._refuse(name, "something that is no plain file")
            return None
        self.hashes[name] = hashlib.sha256(data).hexdigest()
        return data

    def _refuse(self, name: str, what: str) -> None:
        action = "Make the file readable, or remove it from the campaign."
        allowed = "a plain file that may be read"
        self.found.append(error("unreadable_file", name, value=what, allowed=allowed, action=action))

    def report_unreadable(self, name: str, failure: UnreadableTextError) -> None:
        """Say that a file is not the text it should be."""
        self.found.append(
            error(
                "unreadable_file",
                name,
                row=failure.row,
                value=failure.value,
                allowed=failure.allowed,
                action=failure.action,
            )
        )

    def report_encoding(self, name: str, foreign_encoding: str | None) -> None:
        """State an encoding that is not the plain one."""
        if foreign_encoding is None:
            return
        how = "It was guessed" if foreign_encoding == "Windows-1252" else "It was read as such"
        action = f"{how}; save as UTF-8 if letters look wrong in the report."
        self.found.append(
            warning(
                "encoding",
                name,
                value=foreign_encoding,
                allowed="UTF-8, in the plain form",
                action=action,
                needs_action=False,
            )
        )
