"""XML as a tree: names without their spaces, text before the first child, limits."""

from __future__ import annotations

import sys

import pytest

from skisnow._support.user_files import GivenError, xml_tree
from skisnow._support.user_files.xml_tree import DEEPEST
from tests.coded import Coded, coded, raises

TEXT = b"""<?xml version="1.0"?>
<p:pit xmlns:p="urn:pit" xmlns:q="urn:other" q:id="7" plain="x y">
  <p:layer top="0">  soft\n snow <p:grain>PP</p:grain> behind</p:layer>
  <q:note/>
  <p:layer top="12">hard</p:layer>
</p:pit>"""


def test_a_tree_has_local_names_texts_and_children() -> None:
    pit = xml_tree(TEXT)
    assert (pit.namespace, pit.name, dict(pit.attributes)) == ("urn:pit", "pit", {"id": "7", "plain": "x y"})
    assert [(each.namespace, each.name) for each in pit.children] == [
        ("urn:pit", "layer"), ("urn:other", "note"), ("urn:pit", "layer"),
    ]  # fmt: skip
    assert [each.attributes["top"] for each in pit.every("layer")] == ["0", "12"]
    first = pit.child("layer")
    assert first is pit.children[0]
    assert first.text == "  soft\n snow "
    assert pit.text_of("layer") == "soft\n snow"
    assert (pit.text_of("layer", "grain"), pit.text_of("note"), pit.text_of()) == ("PP", "", "")
    assert pit.child() is pit
    assert pit.child("grain") is None
    assert pit.child("note", "grain", "size") is None
    assert pit.text_of("note", "grain") == ""
    assert list(pit.every("grain")) == []


def nested(depth: int) -> bytes:
    return b"<a>" * depth + b"</a>" * depth


def test_what_is_beyond_a_limit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    assert xml_tree(nested(DEEPEST)).name == "a"
    with raises(GivenError, "too_large", depth=60):
        xml_tree(nested(DEEPEST + 1))
    monkeypatch.setattr(
        sys.modules["skisnow._support.user_files.xml_tree"], "MOST_ELEMENTS", 3
    )  # the function hides it
    assert len(xml_tree(b"<a><b/><b/></a>").children) == 2
    with raises(GivenError, "too_large", count=3):
        xml_tree(b"<a><b/><b/><b/></a>")


@pytest.mark.parametrize(
    ("data", "line", "told"),
    [
        (b"<a>\n<b></a>", 2, coded("not_xml", line=2)),
        (b"", 1, "not_xml"),
        (b"<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>", None, "document_type"),
    ],
)
def test_what_is_no_xml_is_refused(data: bytes, line: int | None, told: str | Coded) -> None:
    with raises(GivenError, told) as error:
        xml_tree(data)
    assert error.value.line == line
