"""Where the files of a campaign lie: in a folder, or in memory."""

from __future__ import annotations

import stat
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol


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
