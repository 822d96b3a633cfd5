"""Mutations of TOML and JSON: values of another kind, nested, doubled, swapped, dropped, or huge."""

import json
import tomllib
from random import Random
from typing import Any, Final

from . import values
from .texts import Mutation, bulk, encoding, piece, rows

_SCALARS: Final[tuple[Any, ...]] = (
    0, -1, 1, 2, 10**6, 2**31, 2**63 - 1, -(2**63), 2**63, 10**30, 0.0, -0.0, 0.5, 1e308, -1e308, 5e-324, 1e-300, 1e155,
    float("nan"), float("inf"), float("-inf"), True, False, None, "", " ", "x", "nan", "1e309", "\0", "a" * 3000,
    "../../x", "/dev/zero", "/dev/null", ".", "/", "ä☃", [], {}, [[]], [{}], {"": 0}, [None], [1, "x"], ["1", "2"],
)  # fmt: skip


def _places(value: Any, found: list[tuple[Any, Any]]) -> list[tuple[Any, Any]]:
    """Every container with each of its keys."""
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in pairs:
        found.append((value, key))
        _places(inner, found)
    return found


def _extreme(rng: Random, old: Any) -> Any:
    if isinstance(old, list) and rng.random() < 0.5:
        return _other_list(rng, old)
    if isinstance(old, int | float) and not isinstance(old, bool) and abs(old) < 1e300 and rng.random() < 0.5:
        return old * 10.0 ** rng.choice((-300, -6, -3, -1, 1, 3, 6, 150, 300)) if rng.random() < 0.7 else -old
    if rng.random() < 0.15:
        return values.word(rng)
    return rng.choice(_SCALARS)


def _other_list(rng: Random, old: list[Any]) -> list[Any]:
    how = rng.randrange(6)
    if how == 0:
        return old[: rng.randrange(len(old) + 1)]
    if how == 1:
        return old * rng.choice((2, 50, 2000))
    if how == 2:
        return old[::-1]
    if how == 3:
        return [old, old]
    if how == 4:
        return [*old, rng.choice(_SCALARS)]
    return [rng.choice(_SCALARS) for _ in old]


def _changed(rng: Random, tree: Any) -> Any:
    places = _places(tree, [])
    if not places:
        return rng.choice(_SCALARS)
    holder, key = rng.choice(places)
    how = rng.randrange(10)
    if how < 5:
        holder[key] = _extreme(rng, holder[key])
    elif how == 5:
        del holder[key]
    elif how == 6 and isinstance(holder, dict):
        holder[rng.choice((str(key).upper(), f"{key}x", "", str(key)[1:], rng.choice(places)[1]))] = holder.pop(key)
    elif how == 7:
        other, name = rng.choice(places)
        holder[key] = _copied(other[name]) if name in other or (isinstance(other, list) and name < len(other)) else None
    elif how == 8:
        for _ in range(rng.choice((1, 2, 31, 33, 60))):
            holder[key] = [holder[key]] if rng.random() < 0.5 else {"x": holder[key]}
    elif isinstance(holder, dict):
        holder[values.word(rng)] = rng.choice(_SCALARS)
    return tree


def _copied(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _copied(inner) for key, inner in value.items()}
    return [_copied(inner) for inner in value] if isinstance(value, list) else value


def json_tree(rng: Random, data: bytes) -> bytes:
    """A change of a JSON file's values; of bytes that are none, a cut."""
    try:
        tree = json.loads(data)
    except (ValueError, RecursionError):
        return piece(rng, data)
    return json.dumps(_changed(rng, tree)).encode()


def toml_tree(rng: Random, data: bytes) -> bytes:
    """A change of a TOML file's values; of bytes that are none, a cut."""
    try:
        tree = tomllib.loads(data.decode())
    except (ValueError, RecursionError):
        return piece(rng, data)
    return toml_text(_changed(rng, tree)).encode("utf-8", "replace")


def toml_text(tree: Any) -> str:
    """A dictionary as TOML: tables as sections as far as they go, all else inline."""
    if not isinstance(tree, dict):
        return f"value = {_inline(tree)}\n"
    plain = [f"{_key(key)} = {_inline(value)}" for key, value in tree.items() if not _is_table(value)]
    for key, value in tree.items():
        for table in value if isinstance(value, list) and _is_table(value) else [value] if _is_table(value) else []:
            bracket = "[[%s]]" if isinstance(value, list) else "[%s]"
            plain += [bracket % _key(key), *(f"{_key(name)} = {_inline(inner)}" for name, inner in table.items())]
    return "\n".join(plain) + "\n"


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and bool(value) and all(isinstance(each, dict) for each in value)
    )


def _key(key: object) -> str:
    return json.dumps(str(key))


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {_inline(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, str) or value is None:
        return json.dumps(value or "")
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, int | float) else str(value)


def nested(rng: Random, data: bytes) -> bytes:
    """Replace a value by thousands of brackets."""
    places = [place for place, byte in enumerate(data) if byte in b"=:"]
    deep = rng.choice((33, 3000, 100_000))
    at = rng.choice(places) + 1 if places else 0
    form = rng.choice((b"[%s]", b"%s", b"{a=%s}", b'{"a":%s}'))
    left, right = form.split(b"%s")
    return data[:at] + left * deep + b"1" + right * deep + data[at:] if left else data[:at] + b"a." * deep + data[at:]


def pairs(rng: Random, data: bytes) -> bytes:
    """Two values or keys change places."""
    lines = data.split(b"\n")
    one, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    (key, sign, value), (its_key, its_sign, its_value) = lines[one].partition(b"="), lines[other].partition(b"=")
    lines[one], lines[other] = key + sign + its_value, its_key + its_sign + value
    return b"\n".join(lines)


TOML: Final[tuple[Mutation, ...]] = (toml_tree,) * 6 + (pairs, nested, bulk, rows, encoding, piece)
JSON: Final[tuple[Mutation, ...]] = (json_tree,) * 7 + (nested, bulk, encoding, piece)
