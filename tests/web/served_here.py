"""The program of a process that has loaded the lab already; given are a store, a port, and where to tell the address.

The process that draws for the lab runs this file, too, under another name: nothing stands here that takes long to load.
"""

import sys


def leave_figures_empty() -> None:
    """An empty picture instead of every figure."""
    from unittest.mock import patch

    from skisnow.report.figures.drawing import Drawing, Picture

    svg = '<svg xmlns="http://www.w3.org/2000/svg"/>'

    def empty(drawing: Drawing) -> Picture:
        return Picture(drawing.name, drawing.whole_caption, drawing.alt, drawing.wide, svg, svg.encode())

    patch("skisnow.report.figures.drawing.render", empty).start()
    patch("skisnow.web.campaign_analysis.drawing_svg", lambda _: svg).start()


if __name__ == "__main__":
    from pathlib import Path

    from skisnow.campaign.store import Store
    from skisnow.web import runs
    from skisnow.web.server import serve
    from skisnow.web.settings import Lab

    place, port, tells = globals()["given"]
    runs.COMMAND = (sys.executable, str(Path(__file__).with_name("simulate_here.py")))
    with Store.open(place) as store:
        serve(Lab(store, place.parent / "lab"), host="127.0.0.1", port=port, token=None, tell=tells.send)
elif __name__ == "__mp_main__":  # in its worker processes
    leave_figures_empty()
