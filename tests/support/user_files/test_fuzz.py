"""Damaged files of each kind give a result or an error in words."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.support.user_files.fuzz import KINDS, Kind, broken

each_kind = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)


MU_0 = ("friction.mu_0", 0.05, 0.01)
EDGES = [30.0, 30.0, 60.0, 60.0, 60.0]  # five strata: the two below a half, the three above
SAID: dict[str, Callable[[Any], tuple[object, object]]] = {
    "campaign.toml": lambda campaign: (campaign.load_steps, (50.0, 100.0, 150.0)),
    "scenario.toml": lambda asked: (asked.values["slope.angle_deg"], 10.0),
    "identify.toml": lambda table: ([(each.key, each.start, each.prior_sd) for each in table], [MU_0]),
    "ski.toml": lambda ski: (ski.mass, 2.231),
    "study.toml": lambda study: (sorted(point["edge_angle_deg"] for point in study.points), EDGES),
    "results.json": lambda snow: (snow.snow_hardness, pytest.approx(1.6e8)),  # sqrt(0.128 × 0.2) N/mm³
    "ski-def.json": lambda shape: (shape.outline.waist_width, pytest.approx(0.072)),
    "changes": lambda asked: (asked.values["sledge.inertia_kg_m2"], [6.0, 8.0, 10.0]),
}


@each_kind
def test_sound_file_is_read(kind: Kind, tmp_path: Path) -> None:
    (tmp_path / kind.name).write_bytes(kind.sound)
    found, expected = SAID[kind.name](kind.read(tmp_path / kind.name))
    assert found == expected


@each_kind
def test_damaged_files(kind: Kind, tmp_path: Path) -> None:
    assert broken(kind, tmp_path, seed=1, number=40) == []


@pytest.mark.slow
@each_kind
def test_many_damaged_files(kind: Kind, tmp_path: Path) -> None:
    assert broken(kind, tmp_path, seed=2, number=3000) == []
