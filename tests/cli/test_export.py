"""``skisnow export``: models that are written, and refusals."""

from __future__ import annotations

import platform
import sys
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import pytest

from skisnow.cli import main

linux = pytest.mark.skipif(
    not sys.platform.startswith("linux") or platform.machine() != "x86_64",
    reason="FMUs hold a library for Linux on x86-64 alone",
)


@linux
@pytest.mark.parametrize(
    ("options", "version", "name", "first"),
    [
        (["--contact", "--skis", "1", "--fmi", "3"], "3.0", "skisnow contact", "ski.position[1]"),
        (["--contact"], "2.0", "skisnow contact", "left.position[1]"),
        (["--set", "speed_m_per_s=3"], "2.0", "skisnow sledge", "push.force[1]"),
    ],
)
def test_a_model_as_asked(
    options: list[str], version: str, name: str, first: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "model.fmu"
    assert main(["export", "fmu", "carved-46m", "--out", str(path), *options]) == 0
    assert capsys.readouterr().out.strip() == str(path)
    with zipfile.ZipFile(path) as archive:
        description = ET.fromstring(archive.read("modelDescription.xml"))
    assert (description.attrib["fmiVersion"], description.attrib["modelName"]) == (version, name)
    inputs = [each.attrib["name"] for each in description.iter() if each.attrib.get("causality") == "input"]
    assert inputs[0] == first
    if name == "skisnow sledge":
        (speed,) = (each for each in description.iter("ScalarVariable") if each.attrib["name"] == "start.speed")
        assert float(speed[0].attrib["start"]) == 3.0


def test_wrong_words_and_names_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "sledge.zip")
    assert main(["export", "fmu", "carved-46m", "--out", out]) == 1
    assert ".fmu" in capsys.readouterr().err
    with pytest.raises(SystemExit) as ended:
        main(["export", "fmu", "carved-46m", "--out", out, "--skis", "1"])
    assert ended.value.code == 2
    assert "--contact" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
