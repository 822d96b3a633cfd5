from collections.abc import Callable
from pathlib import Path

import pytest

SLALOM: dict[str, object] = {
    "length_mm": 1593,
    "running_length_mm": 1396,
    "sidecut_length_mm": 1458,
    "tip_width_mm": 116,
    "waist_width_mm": 68,
    "tail_width_mm": 101,
    "mass_kg": 2.231,
    "camber_mm": 7,
    "EI_N_m2": [100, 250, 440, 260, 100],
    "GJ_N_m2": [60, 140, 175, 140, 60],
}


@pytest.fixture
def ski_file(tmp_path: Path) -> Callable[..., Path]:
    """Write a slalom ski's file with some keys changed, added or, as None, left out."""

    def written(**changes: object) -> Path:
        values = {key: value for key, value in {**SLALOM, **changes}.items() if value is not None}
        path = tmp_path / "mine.toml"
        text = "".join(
            f"{key} = {str(value).lower() if value is True else repr(value)}\n" for key, value in values.items()
        )
        path.write_text(text, encoding="utf-8")
        return path

    return written
