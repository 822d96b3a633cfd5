"""Search bounds of keys: they are in the key's unit, so that they hold its default and are in its range."""

from __future__ import annotations

import pytest

from skisnow.scenario.keys import SCENARIO_KEYS

SEARCHED = {name: key for name, key in SCENARIO_KEYS.items() if key.search is not None and not key.search.about}


@pytest.mark.parametrize("name", SEARCHED)
def test_usual_bounds_hold_the_default_and_lie_in_the_range(name: str) -> None:
    key = SEARCHED[name]
    assert key.search is not None
    assert key.lowest <= key.search.lower < key.search.upper <= key.highest
    if isinstance(key.default, float | int):
        assert key.search.lower <= key.default <= key.search.upper


def test_a_logarithm_has_a_size_of_its_own_order() -> None:
    """A factor of e^0.5 to e^3: with a size in another unit a step would be no step."""
    for key in SEARCHED.values():
        if key.search is not None and key.search.logarithmic:
            assert 0.5 <= key.search.size <= 3.0
