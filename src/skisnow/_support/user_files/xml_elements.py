"""XML of users, as a tree of elements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final
from xml.parsers import expat

from .text_files import ContentError

DEEPEST: Final = 60
MOST_ELEMENTS: Final = 500_000
_LONGEST_REASON: Final = 100


@dataclass(slots=True)
class Element:
    """Element of XML: namespace, local name, attributes by local name, text before the first child, children."""

    namespace: str
    name: str
    attributes: Mapping[str, str]
    text: str = ""
    children: list[Element] = field(default_factory=list)

    def child(self, *path: str) -> Element | None:
        """First element on a path of local names, or None."""
        element: Element | None = self
        for name in path:
            if element is None:
                return None
            element = next((inner for inner in element.children if inner.name == name), None)
        return element

    def named(self, name: str) -> Iterator[Element]:
        """Direct children with this local name."""
        return (child for child in self.children if child.name == name)

    def text_of(self, *path: str) -> str:
        """Stripped text of the first element on a path of local names; ``""`` without one."""
        element = self.child(*path)
        return "" if element is None else element.text.strip()


class _Builder:
    """Builder of a tree of elements from the events of the XML parser expat."""

    def __init__(self) -> None:
        self.root: Element | None = None
        self._open: list[Element] = []
        self._count = 0

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """Begin an element within the open one; rejects too many elements or too deep ones."""
        self._count += 1
        if self._count > MOST_ELEMENTS or len(self._open) >= DEEPEST:
            raise ContentError("More than {count} elements, or {depth} within each other, are not read.").tag(
                "too_large", count=MOST_ELEMENTS, depth=DEEPEST
            )
        namespace, _, local = name.rpartition("}")
        element = Element(namespace, local, {key.rpartition("}")[2]: value for key, value in attributes.items()})
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)

    def text(self, text: str) -> None:
        """Add text to the open element, if it has no child yet."""
        if self._open and not self._open[-1].children:
            self._open[-1].text += text

    def end(self, _name: str) -> None:
        """End the open element."""
        self._open.pop()

    def document_type(self, *_what: object) -> None:
        """Reject a document type."""
        raise ContentError("A document type is declared, which is rejected: it may have endless entities.").tag(
            "document_type"
        )


def xml_tree(data: bytes) -> Element:
    """Parse XML of a user; returns the root element. Raises ContentError: not XML, or beyond a limit."""
    builder, parser = _Builder(), expat.ParserCreate(namespace_separator="}")
    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = builder.start, builder.end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = builder.text, builder.document_type
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ContentError("This is not XML, or it is damaged ({reason}).", line=error.lineno).tag(
            "not_xml", reason=expat.ErrorString(error.code)
        ) from error
    except ContentError:
        raise
    except (LookupError, ValueError) as error:  # Python's codec of the encoding that the first line declares
        what = str(error)[:_LONGEST_REASON]
        raise ContentError("The text has an encoding that cannot be read ({reason}). Save it as UTF-8.", line=1).tag(
            "not_text", reason=what
        ) from error
    if builder.root is None:
        raise ContentError("The file has no element.").tag("not_xml")
    return builder.root
