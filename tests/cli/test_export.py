"""skisnow export, skisnow schema."""

import builtins
import json
import platform
import re
import shlex
import sys
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from skisnow.cli import main
from skisnow.cli.shell import NAMES

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


def test_wrong_words_and_names_are_rejected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "sledge.zip")
    assert main(["export", "fmu", "carved-46m", "--out", out]) == 1
    assert ".fmu" in capsys.readouterr().err
    with pytest.raises(SystemExit) as ended:
        main(["export", "fmu", "carved-46m", "--out", out, "--skis", "1"])
    assert ended.value.code == 2
    assert "--contact" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


# `skisnow serve` where the web lab is not installed. What it serves is tested with the pages


@pytest.fixture
def missing(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Importing the server fails without this module."""
    imported = builtins.__import__

    def put(name: str | None) -> None:
        def importing(module: str, *others: Any, **named: Any) -> Any:
            if module == "web.server":
                raise ModuleNotFoundError("gone", name=name)
            return imported(module, *others, **named)

        monkeypatch.setattr(builtins, "__import__", importing)

    return put


def test_a_missing_extra_is_named_with_its_installation(missing: Any, capsys: pytest.CaptureFixture[str]) -> None:
    missing("nicegui")
    assert main(["serve"]) == 1
    told = capsys.readouterr()
    assert "skisnow[web]" in told.err
    assert told.out == ""


@pytest.mark.parametrize("name", ["skisnow.web.server", "skisnow", None])
def test_a_part_of_our_own_is_not_to_be_installed(
    name: str | None, missing: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    missing(name)
    assert main(["serve"]) != 0
    assert "pip install" not in capsys.readouterr().err


# The commands of `make demo` print no warning


MAKEFILE = Path(__file__).parents[2] / "Makefile"
REDUCED = {
    "analyse": ["--resamples", "100"],
    "turn": ["--runs", "3", "--workers", "1", "--set", "run.duration_s=0.2"],
    "simulate": ["--set", "run.duration_s=0.2"],
}
"""Further options with which each command is quick."""


def commands(folder: Path) -> list[list[str]]:
    """Arguments of the commands of the demo, with its own settings."""
    text = MAKEFILE.read_text(encoding="utf-8")
    turn = re.search(r"^TURN := (.*)$", text, re.MULTILINE)
    recipe = re.search(r"^demo:.*\n((?:\t.*\n)+)", text, re.MULTILINE)
    assert turn is not None
    assert recipe is not None
    lines = re.findall(r"^\t\$\(BIN\)/skisnow (.*)$", recipe[1], re.MULTILINE)
    values = {"DEMO": str(folder), "SEED": "1", "TURN": turn[1]}
    return [shlex.split(re.sub(r"\$\((\w+)\)", lambda found: values[found[1]], line)) for line in lines]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("reduced", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_the_demo_prints_no_warning(
    reduced: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str], request: pytest.FixtureRequest
) -> None:
    if reduced:
        request.getfixturevalue("undrawn")
    found = commands(tmp_path / "demo")
    assert [arguments[0] for arguments in found] == ["reference", "analyse", "turn", "simulate"]
    for arguments in found:
        status = main([*arguments, *(REDUCED.get(arguments[0], []) if reduced else [])])
        said = capsys.readouterr()
        # the reduced slalom passes no gate, which is the outcome of its length
        assert status == 0 or (reduced and arguments[0] == "simulate")
        assert "warning" not in (said.out + said.err).lower()


@pytest.mark.parametrize("name", NAMES)
def test_each_schema_is_valid(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", name]) == 0
    schema = json.loads(capsys.readouterr().out)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["properties" if name != "carve" else "$defs"]
