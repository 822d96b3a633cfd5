"""The source files that a value passes: of a scenario file to the compiled core, of a typed reading to its hardness.

The value is an unusual number. A file counts when one of its frames holds that number, in the
unit of the file or in SI, in a local variable or in a field of one (three levels deep).
"""

import dataclasses
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

import skisnow
from skisnow import load_scenario, simulate
from skisnow.campaign.store import Journals, Store, campaign_in_memory, replay_journal
from skisnow.estimation.result_rows import experiment_hardness
from skisnow.scenario import scenario_text

from .campaign.store.test_journal import TOML, reading

FILE_VALUE = 0.2012345
"""H_V in N/mm³; close to that of the scenario below, so that the run is sound."""
SCENARIO = "carved-46m"
DEPTH = 3
PACKAGE = f"{Path(skisnow.__file__).parent}/"


def holds(value: object, numbers: tuple[float, ...], depth: int = DEPTH) -> bool:
    """True if a value is one of the numbers, or contains it."""
    if isinstance(value, bool):
        return False
    if isinstance(value, (int, float)):
        return any(abs(value / number - 1.0) < 1e-9 for number in numbers)
    if isinstance(value, str):
        return str(numbers[0]) in value
    if isinstance(value, np.ndarray):
        floats = value.dtype.kind == "f" and value.size < 10_000
        return floats and any(bool(np.any(np.abs(value / number - 1.0) < 1e-9)) for number in numbers)
    return depth > 0 and any(holds(part, numbers, depth - 1) for part in parts(value))


def parts(value: object) -> Iterator[object]:
    """Members of a container or fields of a dataclass."""
    if isinstance(value, Mapping):
        yield from list(value.values())[:400]
    elif isinstance(value, (list, tuple)):
        yield from value[:400]
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for field in dataclasses.fields(value):
            yield getattr(value, field.name, None)


def files_passed(action: Any, numbers: tuple[float, ...]) -> dict[str, list[str]]:
    """Functions by file, in the order in which the value reaches them."""
    passed: dict[str, list[str]] = {}

    def trace(frame: FrameType, event: str, _argument: object) -> None:
        name = frame.f_code.co_filename
        if event not in ("call", "return") or not name.startswith(PACKAGE):
            return
        short = name.removeprefix(PACKAGE)
        function = frame.f_code.co_name
        if function in passed.get(short, ()):
            return
        if any(holds(local, numbers) for local in list(frame.f_locals.values())):
            passed.setdefault(short, []).append(function)

    sys.setprofile(trace)
    try:
        action()
    finally:
        sys.setprofile(None)
    return passed


def test_hardness_passes_few_files_on_its_way_to_the_core(tmp_path: Path) -> None:
    """A reader who follows one value of a scenario file opens at most 15 files."""
    text = scenario_text(SCENARIO)
    lines = [
        f"H_V_N_per_mm3 = {FILE_VALUE}" if line.startswith("H_V_N_per_mm3") else line for line in text.splitlines()
    ]
    lines = ["duration_s = 0.05" if line.startswith("duration_s") else line for line in lines]
    path = tmp_path / "turn.toml"
    path.write_text("\n".join(lines), encoding="utf-8")
    passed = files_passed(lambda: simulate(load_scenario(path)), (FILE_VALUE, FILE_VALUE * 1e9))
    assert {"scenario/resolution.py", "contact/snow_contact.py"} <= passed.keys()
    assert len(passed) <= 15, passed


TYPED_MM = 1.234567


def test_a_typed_reading_passes_few_files_on_its_way_to_the_hardness(tmp_path: Path) -> None:
    """From the entry that the lab stores; the files after `estimation/hardness.py` do not count."""
    journals = Journals(Store.open(tmp_path / "store.sqlite3"))
    id_ = journals.begin(TOML)

    def enter_and_estimate() -> None:
        for position, depth in enumerate((0.7, TYPED_MM, 1.9)):
            seen = journals.entries(id_)[-1].sequence if position else 0
            journals.append(id_, reading("1", position, str(20 * (position + 1)), str(depth)), seen=seen)
        experiment_hardness(campaign_in_memory(replay_journal(journals.entries(id_))))

    passed = list(files_passed(enter_and_estimate, (TYPED_MM, TYPED_MM * 1e-3)))
    before = passed[: passed.index("estimation/hardness.py") + 1]
    assert "campaign/store/journal.py" in before
    assert len(before) <= 22, before
