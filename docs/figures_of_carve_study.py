"""Draw the gallery's maps from the example study: python docs/figures_of_carve_study.py.

The pictures are written with 128 colours: a third of the bytes, and nobody sees it in a drawing of lines.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from fewer_colours import write_fewer_colours

from skisnow.carving.answer import answer_question, answers_dict
from skisnow.carving.question import carve_question
from skisnow.report.carving_figure import carved_skis
from skisnow.report.figures.drawing import write_figure
from skisnow.report.study_maps import grip_map, radius_map
from skisnow.studies import read_study, run_study

DOCS = Path(__file__).resolve().parent
GALLERY = DOCS / "_static" / "gallery"


def main() -> None:
    """Run the study in a folder of its own and draw."""
    with tempfile.TemporaryDirectory() as folder:
        study_file = Path(shutil.copy(DOCS.parent / "examples" / "carve_study.toml", folder))
        table = run_study(read_study(study_file))
    write_figure(GALLERY / "carve-study-radius.png", lambda: radius_map(table))
    write_figure(GALLERY / "carve-study-grip.png", lambda: grip_map(table))
    asked = {"edge_angle_deg": 45, "load_N": 800, "H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.35, "unloading_ratio": 10}
    found = answers_dict([answer_question(carve_question(asked | {"ski": ski})) for ski in ("slalom", "giant-slalom")])
    write_figure(GALLERY / "two-skis.png", lambda: carved_skis(found))
    for name in ("carve-study-radius", "carve-study-grip", "two-skis"):
        write_fewer_colours(GALLERY / f"{name}.png", colours=128)


if __name__ == "__main__":
    main()
