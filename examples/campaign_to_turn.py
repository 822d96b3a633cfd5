"""From a campaign to a turn: each contact on the snow that was found, and a band over what is not known.

    python examples/campaign_to_turn.py CAMPAIGN OUT [--site SITE] [--runs N]

Site C of the reference campaign is weak in shear, so the turn is slow and on a gentle slope: what it asks of the snow,
the snow can hold. OUT/report.html shows the whole chain. `skisnow turn` does the same without a script.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import skisnow


def main() -> None:
    """Analyse, simulate, draw, write; print what the contacts do otherwise."""
    parser = argparse.ArgumentParser(description="From a campaign to a turn.")
    parser.add_argument("campaign", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--site", default="C")
    parser.add_argument("--runs", type=int, default=64)
    asked = parser.parse_args()
    turn = skisnow.load_scenario("carved-46m").with_(angle_deg=5, speed_m_per_s=4.5, edge_angle_deg=40)
    chain = skisnow.turn(
        asked.campaign, asked.site, turn, runs=asked.runs, progress=lambda text: print(text, file=sys.stderr)
    )
    print(*chain.sentences, f"The whole chain: {chain.report(asked.out)}", sep="\n")


if __name__ == "__main__":  # the band is computed in processes of its own
    main()
