"""Tests call single loops before any run has seen to what Numba kept of them."""

from __future__ import annotations

from skisnow.simulate.compilation import throw_away_older_code

throw_away_older_code()
