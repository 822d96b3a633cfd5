"""Mutations of XML: contents, attributes, elements, declarations, entities."""

import re
from random import Random
from typing import Final

from .texts import Mutation, bulk, bytes_of, encoding, lines, piece, replace_one, scaled, text_of

_CONTENT: Final = re.compile(r">([^<>]+)<")
_ATTRIBUTE: Final = re.compile(r"=\"([^\"]*)\"")
_BEGIN: Final = re.compile(r"<(\w[\w:.-]*)")
_NAME: Final = re.compile(r"</?([\w:.-]+)")
_ENCODINGS: Final = (
    "utf-9", "UTF-8", "utf-16", "UTF-32", "ascii", "latin-1", "iso-8859-15", "windows-1252", "rot13", "base64", "hex",
    "zip", "idna", "punycode", "unicode_escape", "raw_unicode_escape", "utf-7", "big5", "shift_jis", "utf_8_sig", "",
    "x" * 300, "undefined", "mbcs",
)  # fmt: skip


def _reference(number: int) -> str:
    return f"&x{number - 1};" if number else "&x;"


_TENFOLD: Final = "".join(f'<!ENTITY x{i} "{_reference(i) * 10}">' for i in range(8))
_DOCTYPES: Final = (
    '<!DOCTYPE a [<!ENTITY b "c">]>',
    '<!DOCTYPE a SYSTEM "/dev/zero">',
    f'<!DOCTYPE a [<!ENTITY x "xxxxxxxxxx">{_TENFOLD}]>',
)


def content(rng: Random, data: bytes) -> bytes:
    """The text of an element becomes an extreme one."""
    return replace_one(rng, _CONTENT, data)


def attribute(rng: Random, data: bytes) -> bytes:
    """An attribute's value becomes an extreme one."""
    return replace_one(rng, _ATTRIBUTE, data)


def element(rng: Random, data: bytes) -> bytes:
    """An element is dropped, repeated, replaced by another, emptied, or put into itself."""
    text = text_of(data)
    begins = list(_BEGIN.finditer(text))
    if not begins:
        return data
    (name, begin, end), (_, its_begin, its_end) = (_reach(text, rng.choice(begins)) for _ in range(2))
    whole, deep = text[begin:end], rng.choice((2, 40, 3000))
    new = (
        "",
        whole * min(rng.choice((2, 50, 2000)), 1 + 2_000_000 // len(whole)),
        text[its_begin:its_end],
        f"<{name}/>",
        f"<{name}>" * deep + whole + f"</{name}>" * deep,
    )[rng.randrange(5)]
    return bytes_of(text[:begin] + new + text[end:])


def _reach(text: str, begin: re.Match[str]) -> tuple[str, int, int]:
    """Name, begin and end of an element; it ends with the first tag that closes its name."""
    closing = f"</{begin[1]}>"
    end = text.find(closing, begin.end())
    return begin[1], begin.start(), len(text) if end < 0 else end + len(closing)


def name(rng: Random, data: bytes) -> bytes:
    """An element has another name, everywhere or once."""
    text = text_of(data)
    found = list(_NAME.finditer(text))
    if not found:
        return data
    at = rng.choice(found)
    new = rng.choice((at[1].upper(), at[1] + "x", "x:" + at[1], at[1].rpartition(":")[2], rng.choice(found)[1]))
    if rng.random() < 0.5:
        return bytes_of(re.sub(rf"(</?){re.escape(at[1])}\b", lambda match: match[1] + new, text))
    return bytes_of(text[: at.start(1)] + new + text[at.end(1) :])


def declaration(rng: Random, data: bytes) -> bytes:
    """Another declaration of the encoding, or a document type."""
    text = text_of(data)
    if rng.random() < 0.3:
        begin = text.find("?>") + 2 if text.startswith("<?xml") else 0
        entity = text.replace(">", ">&x7;", 3) if rng.random() < 0.3 else text
        return bytes_of(entity[:begin] + rng.choice(_DOCTYPES) + entity[begin:])
    code = rng.choice(_ENCODINGS)
    body = re.sub(r"^<\?xml.*?\?>", "", text, flags=re.DOTALL)
    whole = f'<?xml version="{rng.choice(("1.0", "1.1", "x"))}" encoding="{code}"?>{body}'
    try:
        return whole.encode(code, "replace") if rng.random() < 0.4 else bytes_of(whole)
    except (LookupError, ValueError, TypeError):  # a name of no encoding, or of one that is not for texts
        return bytes_of(whole)


XML: Final[tuple[Mutation, ...]] = (
    (content,) * 5 + (attribute,) * 3 + (element,) * 3 + (name, declaration, scaled, bulk, lines, encoding, piece)
)
