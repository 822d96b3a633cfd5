"""Flat discs pushed into dry sand, as a campaign: the same files and steps as for snow, on another material.

    python examples/plates_in_sand.py DATA [--out CAMPAIGN]

DATA is a folder with ``plates_large_box_7level.csv``: load and depth of nine trials with discs of 60, 80 and 100 mm at
seven levels each, from github robomechanics/3d-terramechanics (MIT). Prints what the nine candidate models give;
``skisnow analyse CAMPAIGN --out DIR`` gives the whole report.
"""

from __future__ import annotations

import argparse
import csv
import tempfile
from pathlib import Path

from skisnow import analyse, read_campaign, results_dict

SITE = "sand box"
HEADER = ("experiment", "site", "tool", "edge_angle_deg", "load_N", "depth_mm")


def disc(diameter_mm: str) -> str:
    """Name of the tool."""
    return f"disc {diameter_mm} mm"


def campaign_toml(diameters_mm: list[str]) -> str:
    """Describe the campaign. The data do not say how finely depth and load were read, so neither does this file."""
    tools = (f'[[tool]]\nname = "{disc(mm)}"\nshape = "disc"\ndiameter_mm = {mm}\n' for mm in diameters_mm)
    head = 'name = "Plates in sand"\nplace = "large box of dry sand"\nobservers = ["robomechanics/3d-terramechanics"]\n'
    return "\n".join([head, *tools])


def write_campaign(data: Path, folder: Path) -> None:
    """Write the campaign folder, which may not exist yet; it appears complete or not at all."""
    with (data / "plates_large_box_7level.csv").open(newline="", encoding="utf-8") as stream:
        readings = list(csv.DictReader(stream))
    if folder.exists():
        raise SystemExit(f"{folder} exists already; choose another --out or remove it.")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as place:
        part = Path(place) / "campaign"
        part.mkdir()
        diameters = sorted({reading["plate_diameter_mm"] for reading in readings}, key=float)
        (part / "campaign.toml").write_text(campaign_toml(diameters), encoding="utf-8")
        with (part / "penetration.csv").open("w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream)
            writer.writerow(HEADER)
            for reading in readings:  # a disc lies flat: edge angle 0
                names = (f"trial {reading['trial']}", SITE, disc(reading["plate_diameter_mm"]))
                writer.writerow((*names, 0, reading["load_N"], reading["depth_mm"]))
        part.rename(folder)


def main() -> None:
    """Write the campaign, read it back, fit the nine models."""
    parser = argparse.ArgumentParser(description="Turn the plates in sand into a campaign.")
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, default=Path("plates-in-sand"))
    arguments = parser.parse_args()
    write_campaign(arguments.data, arguments.out)
    penetration = results_dict(analyse(read_campaign(arguments.out)))["penetration"]
    for row in penetration["models"]:
        bound = f", on its bound: {', '.join(row['at_bound'])}" if row["at_bound"] else ""
        print(
            f"{row['id']:<26} rmse {row['rmse_N']:5.2f} N over {row['n']} readings of {row['n_series']} series{bound}"
        )
    print(penetration["warnings"][0])  # the plates lie flat, and one edge angle does not tell a from b


if __name__ == "__main__":
    main()
