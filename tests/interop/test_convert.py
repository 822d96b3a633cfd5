"""Conversions by endings, from the command line: results, and refusals with nothing written."""

from pathlib import Path

import pytest

from skisnow.cli import main
from skisnow.scenario.snow_map import read_snow_layers

from ..campaign.recordings import NEWTON, STEP_MM, built


def test_a_recording_becomes_layers_of_a_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Air of 0.05 N, 10 mm of snow with 1 N over 10 mm with 3 N: shares of 0.5 and 1.5 of their mean."""
    source, out = tmp_path / "two.pnt", tmp_path / "layers.csv"
    force = [0.05] * round(30.0 / STEP_MM) + [1.0] * round(10.0 / STEP_MM) + [3.0] * round(12.0 / STEP_MM)
    source.write_bytes(built([round(newtons / NEWTON) for newtons in force]))
    assert main(["convert", str(source), str(out), "--layers-to-mm", "20"]) == 0
    layers = read_snow_layers(out)
    assert layers.tops == pytest.approx([top / 1e3 for top in range(21)])
    assert layers.shares == pytest.approx([0.5] * 10 + [1.5] * 11)
    for words, target in ((["30"], "deeper.csv"), (["20"], "layers.trc"), ([], "none.csv")):
        option = ["--layers-to-mm", *words] if words else []
        assert main(["convert", str(source), str(tmp_path / target), *option]) == 1
        assert not (tmp_path / target).exists()
    capsys.readouterr()


@pytest.mark.parametrize(
    ("source", "target", "words"),
    [
        ("a.pnt", "a.docx", "states no format"),
        ("a.pnt", "a.trcc", ".trc?"),
        ("a.pnt", "a.trc", "SnowMicroPen to TRC markers is not known"),
        ("gone.pnt", "x.csv", "gone.pnt"),
        ("a.pnt", "a.pnt", "is not known"),
        ("a.mot", "a.mot", "another name"),
    ],
)
def test_refusals(tmp_path: Path, capsys: pytest.CaptureFixture[str], source: str, target: str, words: str) -> None:
    options = ["--layers-to-mm", "5"] if target.endswith(".csv") else []
    assert main(["convert", str(tmp_path / source), str(tmp_path / target), *options]) == 1
    assert words in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
