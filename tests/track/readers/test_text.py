"""Dates and times in the cells of tables."""

from datetime import datetime

import pytest

from skisnow.track.readers.text import moment


@pytest.mark.parametrize("cell", ["", "12:30:00", "2022-12-27", "20221227", "2022-12-27T15", "٢٠٢٢-١٢-٢٧T١٥:٥١"])
def test_a_moment_needs_a_date_and_minutes_in_plain_figures(cell: str) -> None:
    assert moment(cell) is None


def test_a_moment_without_a_zone_keeps_its_clock() -> None:
    assert moment("2022-12-27T15:51") == datetime(2022, 12, 27, 15, 51)
