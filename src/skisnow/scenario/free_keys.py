"""The words of ``--free``: keys of a scenario, with or without section and unit."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Final

from .._support.errors import ParameterError
from .._support.units import without_unit
from .keys import SCENARIO_KEYS

_HOW_IT_IS_COMPUTED: Final = ("run.", "solver.", "course.")

EACH: Final = "each"
"""Behind an ``@``: a value of its own for each run."""
FREE_KEYS: Final = tuple(
    name for name, key in SCENARIO_KEYS.items() if key.kind == "number" and not name.startswith(_HOW_IT_IS_COMPUTED)
)
"""Keys that may be looked for: numbers of slope, snow, friction, drag, sledge, ski and start."""


def short_name(key: str) -> str:
    """A key without section and unit; a run that it belongs to stays.

    >>> short_name("snow.S_f_N_per_mm2"), short_name("start.speed_m_per_s@second")
    ('S_f', 'speed@second')
    """
    own, at, run = key.partition("@")
    return without_unit(own.partition(".")[2]) + at + run


def _forms(key: str) -> tuple[str, str, str, str]:
    bare = key.partition(".")[2]
    return key, bare, without_unit(key), without_unit(bare)


def _by_word() -> Mapping[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for key in SCENARIO_KEYS:
        for word in dict.fromkeys(_forms(key)):
            found[word] = (*found.get(word, ()), key)
    return found


_KEYS_BY_WORD: Final = _by_word()


def free_key(word: str) -> str:
    """The scenario's key that a word means.

    Raises
    ------
    ParameterError
        No key or several are meant, or the key is no number that can be looked for; near ones are named.

    Examples
    --------
    >>> free_key("S_f"), free_key("drag_area"), free_key("friction.mu_0"), free_key("start.heading_deg")
    ('snow.S_f_N_per_mm2', 'drag.drag_area_m2', 'friction.mu_0', 'start.heading_deg')
    """
    word = word.strip()
    meant = _KEYS_BY_WORD.get(word, ())
    usable = tuple(key for key in meant if key in FREE_KEYS)
    if len(usable) > 1:
        raise ParameterError(f"--free: {word} may mean {' or '.join(usable)}. Write one of them in full")
    if usable:
        return usable[0]
    if meant:
        raise ParameterError(
            f"--free: {meant[0]} cannot be looked for: it is {_why_not(meant[0])}. There are {', '.join(FREE_KEYS)}"
        )
    raise ParameterError(f"--free: {word!r} is no key of a scenario. {_near(word)}")


def free_keys(words: str | Iterable[str]) -> tuple[str, ...]:
    """The keys of a list, or of a text with commas; one that is named twice is refused.

    A word may end in ``@RUN`` for one run of several, or ``@each`` for one value of each run.

    >>> free_keys("mu_0, drag_area@each, mu_1@second")
    ('friction.mu_0', 'drag.drag_area_m2@each', 'friction.mu_1_s_per_m@second')
    """
    listed = words.split(",") if isinstance(words, str) else list(words)
    keys = [_key_of_run(word) for word in listed if word.strip()]
    for key in keys:
        if keys.count(key) > 1:
            raise ParameterError(f"--free: {key} is named twice. Remove one of them")
    return tuple(keys)


def _key_of_run(word: str) -> str:
    own, at, run = word.partition("@")
    if at and not run.strip():
        raise ParameterError(
            f"--free: behind the @ of {word!r} a run is missing. Name one, or write {own.strip()}@{EACH}"
        )
    return free_key(own) + at + run.strip()


def _why_not(key: str) -> str:
    if key.startswith(_HOW_IT_IS_COMPUTED):
        return "how the run is computed, not what it follows from"
    kind = SCENARIO_KEYS[key].kind
    return "a whole table, not one number" if kind == "three numbers" else f"a {kind}, not a number"


def _near(word: str) -> str:
    small = {form.lower(): form for key in FREE_KEYS for form in (_forms(key)[3], _forms(key)[1], key)}
    like = difflib.get_close_matches(word.lower(), small, n=4, cutoff=0.5)
    keys = dict.fromkeys(_KEYS_BY_WORD[small[each]][0] for each in like)
    if keys:
        return f"Near are {', '.join(list(keys)[:3])}"
    return f"There are {', '.join(short_name(key) for key in FREE_KEYS)}"
