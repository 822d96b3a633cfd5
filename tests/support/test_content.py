"""Content of an object: the same for the same content, another for another."""

from dataclasses import dataclass, field

import numpy as np

from skisnow._support.content import content_bytes


@dataclass
class Pole:
    """Fields that count, and values computed from them."""

    x: float
    names: tuple[str, ...] = ()
    found: float = field(init=False, default=0.0)


@dataclass
class Flag:
    """The same fields under another name."""

    x: float
    names: tuple[str, ...] = ()


def test_kind_fields_and_parts_count_and_what_was_worked_out_does_not() -> None:
    pole = Pole(1.5, ("a", "b"))
    assert list(content_bytes(pole)) == [b"Pole", b"1.5", b"'a'", b"'b'"]
    other = Pole(1.5, ("a", "b"))
    other.found = 7.0
    assert list(content_bytes(other)) == list(content_bytes(pole))
    assert list(content_bytes(Flag(1.5, ("a", "b")))) != list(content_bytes(pole))
    assert list(content_bytes(Pole(1.5, ("a",)))) != list(content_bytes(pole))


def test_an_array_is_its_bytes_and_a_class_its_name() -> None:
    values = np.array([1.0, 2.0])
    assert list(content_bytes([values, [3]])) == [values.tobytes(), b"3"]
    assert list(content_bytes(Pole)) == [repr(Pole).encode()]
