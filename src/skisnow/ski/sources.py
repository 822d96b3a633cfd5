"""Skis and snows by the words that users name them with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .._support.user_files import is_file
from ..snow import SnowProperties, published_snow, snow_from_results
from ..snow.measured_range import with_range_warnings
from . import Ski, read_ski, ski_names


@dataclass(slots=True)
class Sources:
    """Skis and snows by the words that name them, each read once.

    Attributes
    ----------
    folder
        Where relative paths start; None: the current folder.
    """

    folder: Path | None = None
    _skis: dict[str, tuple[Ski, tuple[str, ...]]] = field(default_factory=dict)
    _snows: dict[tuple[str | None, str | None, str | None], SnowProperties] = field(default_factory=dict)

    def ski(self, word: str) -> tuple[Ski, tuple[str, ...]]:
        """The ski of a name or path, and what its reader warned of."""
        if word not in self._skis:
            self._skis[word] = with_range_warnings(lambda: read_ski(self._ski_place(word)))
        return self._skis[word]

    def named_snow(self, words: Mapping[str, Any]) -> SnowProperties:
        """The snow of the words `published`, or `results` and `site`."""
        named = (words.get("published"), words.get("results"), words.get("site"))
        if named not in self._snows:
            self._snows[named] = self._read_snow(*named)
        return self._snows[named]

    def take_snow(self, snow: SnowProperties, *, results: str, site: str | None) -> None:
        """Take a snow that is at hand for that of the words `results` and `site`, whose file is then not read."""
        self._snows[None, results, site] = snow

    def path(self, word: str) -> Path:
        """The place of a file."""
        return (self.folder or Path()) / word

    def ski_file(self, word: str) -> Path | None:
        """The file that a ski's word names, None for a name of the catalogue."""
        if word in ski_names():
            return None
        place = self.path(word)
        looks_like_one = Path(word).suffix.lower() in (".toml", ".json") or Path(word).name != word
        return place if looks_like_one or is_file(place) else None

    def _ski_place(self, word: str) -> str | Path:
        return self.ski_file(word) or word

    def _read_snow(self, published: str | None, results: str | None, site: str | None) -> SnowProperties:
        if results is not None:
            return snow_from_results(self.path(results), site=site)
        return published_snow(published or "")
