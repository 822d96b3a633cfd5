"""One more key of a scenario: declared at its field and used where it acts, it is in every other place by itself."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import skisnow

PACKAGE = Path(skisnow.__file__).parent
BEFORE = "    friction: Annotated[\n"
DECLARED = """    crust: Annotated[
        float,
        Quantity(
            "snow.crust_mm",
            "a length that is new",
            lowest=0.5,
            highest=20.0,
            origin="choice: to be tried",
        ),
    ] = 2e-3
"""
ASKED = """
from dataclasses import replace

from skisnow._support.errors import ParameterError
from skisnow.parameters.json_schema import page_table
from skisnow.scenario import load_scenario, scenario_file, scenario_text
from skisnow.scenario.keys import free_key
from skisnow.scenario.keys import parse_change
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.scenario.schema import scenario_schema, output_scenario_schema
from skisnow.studies.points import Axis

print(load_scenario("carved-46m", changes=dict([parse_change("crust_mm=4")])).contact.crust)
print(scenario_file("carved-46m").values["snow.crust_mm"])
contact = load_scenario("carved-46m").contact
for refused in (lambda: scenario_file("carved-46m", changes={"crust_mm": 40}), lambda: replace(contact, crust=0.04)):
    try:
        refused()
    except ParameterError as error:
        print(error)
print(scenario_schema()["properties"]["snow"]["properties"]["crust_mm"])
print(output_scenario_schema()["properties"]["snow"]["properties"]["crust_mm"]["type"])
print([line for line in page_table(SCENARIO_KEYS.values()).splitlines() if "crust" in line])
print([line for line in scenario_text("carved-46m").splitlines() if "crust" in line])
print(free_key("crust"))
print(Axis.of(SCENARIO_KEYS["snow.crust_mm"], {"from": 1, "to": 3, "n": 3}).on_grid())
"""


def test_a_new_key_is_one_declaration(tmp_path: Path) -> None:
    """In a copy of the package one file is changed; the second would be the one that uses the value."""
    copy = tmp_path / "skisnow"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__", "static", "web", "field"))
    place = copy / "scenario" / "contact.py"
    text = place.read_text(encoding="utf-8")
    assert text.count(BEFORE) == 1
    place.write_text(text.replace(BEFORE, DECLARED + BEFORE), encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", ASKED], env=environment, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        "0.004",
        "2.0",
        "snow.crust_mm is 40; allowed is from 0.5 to 20 mm",
        "snow.crust_mm is 40.0; allowed is from 0.5 to 20 mm",
        "{'type': 'number', 'description': 'a length that is new (mm)', 'minimum': 0.5, 'maximum': 20.0, "
        "'default': 2.0}",
        "['number', 'null']",
        "['| `snow.crust_mm` | mm | from 0.5 to 20 | 2 | choice: to be tried | a length that is new |']",
        "['crust_mm = 2.0                          # default, choice: to be tried']",
        "snow.crust_mm",
        "[1.0, 2.0, 3.0]",
    ]
