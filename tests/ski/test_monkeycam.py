import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow.ski import Ski, read_ski

SHAPES = Path(__file__).parents[3] / "shared" / "data" / "ski-shapes"

# the outline of MonkeyCAM's own sample ski, whose overview page (version 4.0.7) prints total length 178.5 cm and
# nose, waist and tail widths 12.8812, 9.3000, 11.4812 cm
BOARD: dict[str, Any] = {
    "name": "Sample-ski",
    "nose length": "11cm",
    "effective edge length": "161cm",
    "tail length": "6.5cm",
    "sidecut radius": "2250cm",
    "waist width": "9.3cm",
    "taper": "1.4cm",
    "edge shape": {"type": "Basic Arc"},
    "stance setback": "6cm",
}


@pytest.fixture
def design(tmp_path: Path) -> Callable[..., Path]:
    def written(**changes: Any) -> Path:
        named = {key.replace("_", " "): value for key, value in changes.items()}
        board = {key: value for key, value in {**BOARD, **named}.items() if value is not None}
        path = tmp_path / "ski-def.json"
        path.write_text(json.dumps({"board": board, "profile": {}}), encoding="utf-8")
        return path

    return written


def ski_of(path: Path, folder: Path | None = None) -> Ski:
    file = (folder or path.parent) / "mine.toml"
    file.write_text(f'shape = "{path}"\nmass_kg = 2\nEI_N_m2 = [100, 400, 100]\nGJ_N_m2 = [50, 150, 50]\n')
    return read_ski(file)


def require_sample_ski(ski: Ski) -> None:
    assert ski.name == "Sample-ski"
    assert ski.length == pytest.approx(1.785, abs=1e-12)
    # MonkeyCAM computes in whole steps of 1e-4 cm and prints a sagitta of 1.4406 cm for 1.44052, which counts twice
    assert [w * 100 for w in ski.sidecut_widths] == pytest.approx([12.8812, 9.3, 11.4812], abs=2.1e-4)
    assert ski.sidecut_length == ski.running_length == pytest.approx(1.61)
    assert ski.sidecut_radius_of_edge_line == pytest.approx(22.5, rel=2e-3)  # through three points of the arc, tapered
    assert ski.sidecut_middle == pytest.approx(0.06)  # the boot is set back by 6 cm
    assert ski.station[-1] == pytest.approx(0.06 - 0.805 - 0.065)


def test_widths_are_those_that_monkeycam_prints(design: Callable[..., Path]) -> None:
    require_sample_ski(ski_of(design()))


def test_the_sample_file_itself(tmp_path: Path) -> None:
    path = SHAPES / "ski-def.json"
    if not path.exists():
        pytest.skip("the shapes of MonkeyCAM are not beside the repository")
    require_sample_ski(ski_of(path, tmp_path))


def test_a_snowboard_is_an_arc_too(tmp_path: Path) -> None:
    path = SHAPES / "board-def.json"
    if not path.exists():
        pytest.skip("the shapes of MonkeyCAM are not beside the repository")
    board = ski_of(path, tmp_path)
    sagitta = 11.0 - math.sqrt(11.0**2 - 0.68**2)
    assert board.sidecut_widths == pytest.approx((0.250 + 2 * sagitta - 0.002, 0.246, 0.246 + 2 * sagitta - 0.002))


@pytest.mark.parametrize("text", ["161cm", "1610mm", "1.61 m", 161, "161", "63.38582677165354in", '63.38582677165354"'])
def test_lengths_in_any_unit(design: Callable[..., Path], text: object) -> None:
    assert ski_of(design(effective_edge_length=text)).sidecut_length == pytest.approx(1.61, rel=1e-12)


def test_a_file_names_a_shape(design: Callable[..., Path]) -> None:
    path = design().parent / "mine.toml"
    path.write_text('shape = "ski-def.json"\nmass_kg = 2\nEI_N_m2 = [100, 400, 100]\nGJ_N_m2 = [50, 150, 50]\n')
    require_sample_ski(read_ski(path))
    path.write_text('shape = "ski-def.json"\nmass_kg = 2\n')
    with raises(ParameterError, "missing", key="EI_N_m2"):
        read_ski(path)
    path.write_text('shape = "ski-def.json"\ntip_width_mm = 120\n')
    with raises(ParameterError, "contradiction", key="tip_width_mm", value="120", other="shape"):
        read_ski(path)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"edge_shape": {"type": "Bezier"}}, coded("out_of_range", value="'Bezier'")),
        ({"edge_shape": None}, "out_of_range"),
        ({"splitboard": True}, "wrong_kind"),
        ({"taper": None}, coded("out_of_range", key="taper")),
        ({"waist_width": "9.3 feet"}, coded("out_of_range", value="'9.3 feet'")),
        ({"waist_width": True}, "out_of_range"),
        ({"sidecut_radius": "70cm"}, coded("out_of_range", value="'70cm'")),
        ({"taper": "8cm"}, coded("invalid_ski", waist=93.00000000000001)),
    ],
)
def test_shapes_that_are_rejected(design: Callable[..., Path], changes: dict[str, Any], named: str | Coded) -> None:
    with raises(ParameterError, named):
        ski_of(design(**changes))


@pytest.mark.parametrize(("text", "named"), [("{", "not_json"), ("[]", "missing"), ("{}", "missing")])
def test_what_is_no_design_file(tmp_path: Path, text: str, named: str | Coded) -> None:
    path = tmp_path / "ski-def.json"
    path.write_text(text)
    with raises(ParameterError, named):
        ski_of(path)
    with raises(ParameterError, "cannot_read"):
        ski_of(tmp_path / "gone.json")


@pytest.mark.parametrize("radius", ["1e999cm", "1e200m", "1e5m"])
def test_a_sidecut_radius_must_be_that_of_a_ski(design: Callable[..., Path], radius: object) -> None:
    with raises(ParameterError, "out_of_range"):
        ski_of(design(sidecut_radius=radius))


@pytest.mark.parametrize("text", ["1" * 300_000 + "?", "1" + " " * 300_000 + "?", "1cm" + " " * 300_000 + "?"])
def test_a_long_text_is_rejected_after_one_pass(design: Callable[..., Path], text: str) -> None:
    with raises(ParameterError, "text_too_long"):  # with backtracking this would take minutes
        ski_of(design(waist_width=text))
