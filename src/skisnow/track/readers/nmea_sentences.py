"""Sentences of NMEA 0183 in a file: found, checked, and decoded with pynmeagps.

A sentence begins at any `$` and ends before the next `$` or line end, so that joined lines and bytes of other protocols
cost nothing else. A file may have no checksums: a sentence without one is read unless another of its kind has one.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from .recording import NOT_FINITE_CELL

READ: Final = ("GGA", "GNS", "GLL", "RMC", "VTG", "GST", "ZDA")
"""Sentences that are read."""
SENTENCE: Final = re.compile(rb"\$[A-Z]{2}(GGA|GNS|GLL|RMC|VTG|GST|ZDA),")
LONGEST: Final = 1_000
"""Maximum bytes of a sentence: NMEA allows 82, receivers write somewhat more."""
WRONG_CHECKSUM: Final = "sentences with a wrong checksum"
NO_CHECKSUM: Final = "sentences without a checksum, next to others with one"
UNREADABLE: Final = "sentences with a cell that cannot be read"
_PIECE: Final = re.compile(rb"\$([A-Z][A-Z0-9]{2,9}),([\x20-\x23\x25-\x7e]*)")
_CHECKSUM: Final = re.compile(rb"[0-9A-Fa-f]{2}")
_LINE_END: Final = re.compile(rb"\r\n|\r|\n")


@dataclass(frozen=True, slots=True)
class Sentence:
    """A decoded sentence, its row in the file, and whether a cell was `nan` or `inf`."""

    row: int
    message: Any
    has_not_finite_cell: bool


@dataclass(frozen=True, slots=True)
class _Piece:
    """A sentence as written; the checksum is None if missing or incomplete."""

    begin: int
    address: bytes
    content: bytes
    checksum: bytes | None


def sentences(data: bytes, counts: dict[str, int]) -> Iterator[Sentence]:
    """Every sentence that is read, in the order of the file; rejected ones are added to `counts`."""
    pieces = [_piece(match) for match in _PIECE.finditer(data)]
    checked = {piece.address for piece in pieces if piece.checksum is not None}
    line_ends = [match.end() for match in _LINE_END.finditer(data)]
    for piece in pieces:
        reason = _rejection(piece, checked)
        if reason is None and _is_read(piece.address):
            content, has_not_finite_cell = _finite(piece.content)
            message = _decode(content)
            if message is not None:
                yield Sentence(bisect_right(line_ends, piece.begin) + 1, message, has_not_finite_cell)
                continue
            reason = UNREADABLE
        if reason is not None:
            counts[reason] = counts.get(reason, 0) + 1


def _piece(match: re.Match[bytes]) -> _Piece:
    content, star, rest = match[0][1:].partition(b"*")
    checksum = _CHECKSUM.match(rest) if star else None
    return _Piece(match.start(), match[1], content.rstrip(), None if checksum is None else checksum[0])


def _is_read(address: bytes) -> bool:
    return len(address) == 5 and address[2:].decode("ascii") in READ


def _rejection(piece: _Piece, checked: set[bytes]) -> str | None:
    """The reason to leave a sentence out, or None."""
    from pynmeagps import calc_checksum

    if len(piece.content) > LONGEST:
        return UNREADABLE
    if piece.checksum is None:
        return NO_CHECKSUM if piece.address in checked else None
    expected: str = calc_checksum(piece.content.decode("ascii"))
    return None if expected == piece.checksum.decode("ascii").upper() else WRONG_CHECKSUM


def _finite(content: bytes) -> tuple[str, bool]:
    """The content with blank cells for `nan` and `inf`, and whether there were any."""
    cells = content.decode("ascii").split(",")
    blanked = ["" if NOT_FINITE_CELL.fullmatch(cell.strip()) else cell for cell in cells]
    return ",".join(blanked), blanked != cells


def _decode(content: str) -> Any:
    from pynmeagps import NMEAReader, calc_checksum

    try:
        return NMEAReader.parse(f"${content}*{calc_checksum(content)}".encode("ascii"))
    except Exception:  # pynmeagps fails in many ways for cells that are not numbers
        return None
