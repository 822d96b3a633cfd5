"""Mutations of texts: cells, columns, rows, lines, encodings. Each takes a generator and the file's bytes."""

import re
from collections.abc import Callable
from random import Random
from typing import Final

from . import values

Mutation = Callable[[Random, bytes], bytes]
_TOKEN: Final = re.compile(r"[^\s,;=<>\"'*$\[\]]+")
_NUMBER: Final = re.compile(r"\d+(?:\.\d+)?")
_MANY: Final = (2, 3, 50, 2000)
_LARGE: Final = 3_000_000
"""Bytes of a large piece."""
_MOST: Final = 4_000_000
"""Bytes that a mutation may grow a file to."""


def text_of(data: bytes) -> str:
    """The text, each odd byte as one character that `bytes_of` gives back."""
    return data.decode("utf-8", "surrogateescape")


def bytes_of(text: str) -> bytes:
    """The reverse of `text_of`."""
    return text.encode("utf-8", "surrogateescape")


def replace_one(rng: Random, pattern: re.Pattern[str], data: bytes, new: Callable[[str], str] | None = None) -> bytes:
    """The last group of one match becomes an extreme word, or another text that is made from it."""
    text = text_of(data)
    matches = list(pattern.finditer(text))
    if not matches:
        return data
    match, group = rng.choice(matches), pattern.groups
    word = new(match[group]) if new else values.word(rng)
    return bytes_of(text[: match.start(group)] + word + text[match.end(group) :])


def token(rng: Random, data: bytes) -> bytes:
    """One word or number becomes an extreme one."""
    return replace_one(rng, _TOKEN, data)


def scaled(rng: Random, data: bytes) -> bytes:
    """One number is shifted by a power of ten, or a digit of it changes."""

    def other(number: str) -> str:
        powers = (-300, -20, -6, -3, 3, 6, 20, 150, 300)
        return f"{number}e{rng.choice(powers)}" if rng.random() < 0.6 else number[::-1]

    return replace_one(rng, _NUMBER, data, other)


def _separator(text: str) -> str:
    head = text[:2000]
    return max((",", ";", "\t", " "), key=lambda mark: head.count(mark) * (0.2 if mark == " " else 1.0))


def _table(data: bytes) -> tuple[list[list[str]], str]:
    text = text_of(data)
    mark = _separator(text)
    return [line.split(mark) for line in text.split("\n")], mark


def _joined(rows: list[list[str]], mark: str) -> bytes:
    return bytes_of("\n".join(mark.join(row) for row in rows))


def cell(rng: Random, data: bytes) -> bytes:
    """One cell becomes an extreme one."""
    rows, mark = _table(data)
    row = rng.choice(rows)
    row[rng.randrange(len(row))] = values.word(rng)
    return _joined(rows, mark)


def column(rng: Random, data: bytes) -> bytes:
    """A column is dropped, doubled, swapped, renamed, made constant, scaled, or put in reverse."""
    rows, mark = _table(data)
    width = max(map(len, rows))
    one, other = rng.randrange(width), rng.randrange(width)
    how = rng.randrange(8)
    fill, factor = values.word(rng), rng.choice(("e300", "e-300", "e155", "e10", "e-9"))
    last = [row[one] if one < len(row) else "" for row in reversed(rows[1:])]
    for number, row in enumerate(rows):
        if one >= len(row):
            continue
        if how == 0:
            del row[one]
        elif how == 1:
            row.insert(other, row[one])
        elif how == 2 and other < len(row):
            row[one], row[other] = row[other], row[one]
        elif how == 3 and number == 0:
            row[one] = rng.choice(
                (row[one].upper(), row[one] + " ", row[one] + "x", fill, rows[0][other % len(rows[0])])
            )
        elif how in (4, 5) and number:
            row[one] = fill if how == 4 or not row[one] else row[one] + factor
        elif how == 6 and number and other < len(row):
            row[one] = row[other]
        elif how == 7 and number:
            row[one] = last[number - 1]
    return _joined(rows, mark)


def rows(rng: Random, data: bytes) -> bytes:
    """Rows are dropped, doubled, swapped, cut short, lengthened, joined, or put in reverse."""
    lines = text_of(data).split("\n")
    one, other = sorted((rng.randrange(len(lines)), rng.randrange(len(lines))))
    how = rng.randrange(10)
    if how == 0:
        del lines[one : other + 1]
    elif how == 1:
        piece = lines[one : one + rng.choice((1, 2, 5))]
        lines[one:one] = piece * min(rng.choice(_MANY), 1 + _MOST // (1 + sum(map(len, piece))))
    elif how == 2:
        lines[one], lines[other] = lines[other], lines[one]
    elif how == 3:
        lines[one] = lines[one][: rng.randrange(len(lines[one]) + 1)]
    elif how == 4:
        lines[one] += rng.choice((",1", ";1", "\t1", " 1", ",", ";" * 200, "," * 2000))
    elif how == 5 and one + 1 < len(lines):
        lines[one : one + 2] = [lines[one] + lines[one + 1]]
    elif how == 6:
        lines[1:] = lines[:0:-1]
    elif how == 7:
        rng.shuffle(lines)
    elif how == 8:
        del lines[rng.choice((1, 2, len(lines))) :]
    else:
        lines.insert(one, rng.choice(("", "#", "%", "sep=;", "x", ",,,", ";;", '"', "[DATA]", "\x1a", "  ")))
    return bytes_of("\n".join(lines))


def lines(rng: Random, data: bytes) -> bytes:
    """Other line ends, or none."""
    text = text_of(data)
    how = rng.randrange(6)
    if how < 4:
        return bytes_of(text.replace("\n", ("\r\n", "\r", "\n\n", "\x85")[how]))
    breaks = [place for place, letter in enumerate(text) if letter == "\n"]
    if not breaks:
        return data
    at = rng.choice(breaks)
    return bytes_of(text[:at] + ("" if how == 4 else "\r") + text[at + 1 :])


def encoding(rng: Random, data: bytes) -> bytes:
    """The text in another encoding, with or without a byte order mark, or with one wrong byte."""
    text = data.decode("utf-8", "replace")
    how = rng.choice(
        ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "latin-1", "utf-8-sig", "cp437", "utf-7", "byte", "mark")
    )
    if how == "byte":
        at = rng.randrange(len(data) + 1)
        return data[:at] + rng.choice((b"\xff", b"\xfe", b"\x80", b"\xc3", b"\xed\xa0\x80", b"\x00")) + data[at:]
    if how == "mark":
        return rng.choice((b"\xff\xfe", b"\xfe\xff", b"\xef\xbb\xbf", b"\xff\xfe\x00\x00")) + data
    return text.encode(how, "replace")


def separator(rng: Random, data: bytes) -> bytes:
    """Another separator, and perhaps decimal commas."""
    text = text_of(data)
    mark = _separator(text)
    new = rng.choice((",", ";", "\t", "|", " "))
    return bytes_of((text.replace(".", ",") if rng.random() < 0.5 else text).replace(mark, new))


def piece(rng: Random, data: bytes) -> bytes:
    """A piece is cut out, repeated, moved, or replaced by an extreme word."""
    begin = rng.randrange(len(data) + 1)
    end = min(len(data), begin + rng.choice((0, 1, 2, 8, 40, 400)))
    part, rest = data[begin:end], data[:begin] + data[end:]
    how = rng.randrange(5)
    if how == 0:
        return rest
    if how == 1:
        return data[:begin] + part * min(rng.choice(_MANY), 1 + _MOST // (1 + len(part))) + data[end:]
    if how == 2:
        at = rng.randrange(len(rest) + 1)
        return rest[:at] + part + rest[at:]
    if how == 3:
        return data[:begin] + bytes_of(values.word(rng)) + data[begin if rng.random() < 0.5 else end :]
    return data[:end]


def bulk(rng: Random, data: bytes) -> bytes:
    """Megabytes, in one of 15 such mutations: a line, a word, or a number over and over. Else a word changes."""
    if rng.random() > 1 / 15:
        return token(rng, data)
    text = text_of(data)
    found = list(_TOKEN.finditer(text))
    lines = text.splitlines(keepends=True)
    if not found or not lines:
        return data
    at = rng.choice(found)
    mark = rng.choice((",", ";", " ", "\t", "\n", "", "x,", "1,"))
    how = rng.randrange(3)
    if how == 0:
        row = rng.randrange(len(lines))
        return bytes_of("".join((*lines[:row], lines[row] * (_LARGE // len(lines[row])), *lines[row + 1 :])))
    piece = (at[0] if how == 1 else "9") + mark
    return bytes_of(text[: at.start()] + piece * (_LARGE // len(piece)) + text[at.start() :])


TEXT: Final[tuple[Mutation, ...]] = (token, token, bulk, scaled, scaled, rows, lines, encoding, piece)
TABLE: Final[tuple[Mutation, ...]] = (cell,) * 3 + (column, rows) * 2 + (
    bulk, scaled, lines, encoding, separator, piece,
)  # fmt: skip
