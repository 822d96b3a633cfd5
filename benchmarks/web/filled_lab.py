"""A lab as it is late in a season: 10,000 readings in its store, a kept campaign, a run; served as a person does it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from skisnow.campaign import write_reference
from skisnow.campaign.store import Journals, NewEntry, Store
from skisnow.campaign.store.replayed import Value, description_text

LOADS_N = (12, 32, 72, 132, 212, 332, 492)
SITES, SEED = 20, 1
RUN = "carved-46m"
TOOL: dict[str, Value] = {"name": "ski piece", "shape": "ski", "length_mm": 200.0, "width_mm": 62.0}
PLATE: dict[str, Value] = {"name": "plate", "length_mm": 100.0}


@dataclass(frozen=True, slots=True)
class FilledLab:
    """Address of the server, its store, ids of the campaign in entry and of the kept ones, readings of the first."""

    address: str
    store: Path
    entry: str
    kept: tuple[str, ...]
    readings: int

    def enter_one_more(self, name: str) -> None:
        """Add a reading to the campaign in entry, as another browser would."""
        with Store.open(self.store) as store:
            _enter(Journals(store), self.entry, name, {**_head(3, name, 45), "load_N": "12", "depth_mm": "0.9"})


@contextmanager
def filled_lab(readings: int, campaigns: int) -> Iterator[FilledLab]:
    """Fill a store in a folder that goes away, and serve it."""
    with TemporaryDirectory(prefix="skisnow-benchmark-") as name:
        folder = Path(name)
        place = folder / "store.sqlite3"
        with Store.open(place) as store:
            entry = _entered(store, readings)
            kept = tuple(_kept(store, folder / f"reference-{seed}", seed) for seed in range(1, campaigns + 1))
        _simulated(folder / "lab" / RUN)
        with served(place) as address:
            yield FilledLab(address, place, entry, kept, readings)


def _kept(store: Store, folder: Path, seed: int) -> str:
    write_reference(folder, seed=seed)
    return store.add(folder).id


def _entered(store: Store, readings: int) -> str:
    """Series of seven loads on snow of lognormal hardness, at 20 sites: F = H_V V with a scatter of 2 %."""
    rng = np.random.default_rng(SEED)
    journals = Journals(store)
    values: dict[str, Value | None] = {
        "name": "a season",
        "load_steps_N": LOADS_N,
        "gauge_resolution_mm": 0.01,
        "observers": ("Ada",),
    }
    id_ = journals.begin(description_text(values, (TOOL,), (PLATE,)))
    for number in range(readings // len(LOADS_N)):
        last = 0
        for position, cells in enumerate(_series(number, rng)):
            last = _enter(journals, id_, str(number + 1), cells, position=position, seen=last)
    return id_


def _enter(journals: Journals, id_: str, test: str, cells: dict[str, str], *, position: int = 0, seen: int = 0) -> int:
    row = NewEntry(action="add", file="penetration.csv", test=test, cells=cells, position=position, who="Ada")
    return journals.append(id_, row, seen=seen).sequence


def _head(site: int, name: str, edge_angle_deg: int) -> dict[str, str]:
    head = {"experiment": name, "site": f"site {site}", "spot": "", "tool": "ski piece"}
    return {**head, "edge_angle_deg": str(edge_angle_deg)}


def _series(number: int, rng: np.random.Generator) -> Iterator[dict[str, str]]:
    hardness, angle = float(np.exp(rng.normal(-1.0, 0.8))), (30, 45, 60)[number % 3]
    tangent = float(np.tan(np.radians(angle)))
    for load in LOADS_N:
        depth = np.sqrt(2.0 * load * tangent / (hardness * 200.0)) * np.exp(rng.normal(0.0, 0.02))
        cells = _head(number % SITES, str(number + 1), angle)
        yield {**cells, "load_N": str(load), "depth_mm": f"{depth:.2f}"}


def _simulated(folder: Path) -> None:
    folder.parent.mkdir()
    command = [sys.executable, "-m", "skisnow", "simulate", RUN, "--out", str(folder)]
    subprocess.run(command, check=True, capture_output=True)


@contextmanager
def served(store: Path) -> Iterator[str]:
    """Address of a lab with this store, as a person serves it."""
    command = [sys.executable, "-m", "skisnow", "serve", "--port", "0", "--store", str(store)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        yield process.stdout.readline().strip().rstrip("/")
    finally:
        process.terminate()
        process.wait(30)
