"""Draw docs/_static/track-comparison.png: python docs/figure_of_comparison.py.

The built-in carver-42m with elastic snow, held against the same on hypoplastic snow.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

from skisnow import compare, load_scenario, simulate
from skisnow.report.figures.drawing import write_figure
from skisnow.report.track.report import track_comparison
from skisnow.simulation.run_tables import write_track
from skisnow.track.read import read_track
from skisnow.track.track import Track

PLACE = Path(__file__).resolve().parent / "_static" / "track-comparison.png"


def track(penetration: str, folder: Path) -> Track:
    """The track of a run on snow of that kind, by way of its file."""
    found = simulate(load_scenario("carver-42m", changes={"snow.penetration": penetration}))
    write_track(found, folder / "track.csv")
    return replace(read_track(folder / "track.csv"), name=f"{penetration} snow", axes="slope")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        elastic, hypoplastic = (track(kind, Path(folder)) for kind in ("elastic", "hypoplastic"))
        write_figure(PLACE, lambda: track_comparison(compare(elastic, hypoplastic)))
