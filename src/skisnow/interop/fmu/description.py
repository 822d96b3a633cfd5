"""modelDescription.xml of FMI 2.0 and 3.0: what an importing program reads before it loads the library."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from importlib.metadata import version
from typing import Final, Literal, TypeAlias

from .models import Model
from .variables import UNITS, Variable

Version: TypeAlias = Literal[2, 3]
IDENTIFIER: Final = "skisnow"
"""Name of the library within the FMU, without its ending."""
_STATE: Final = {
    2: ("canGetAndSetFMUstate", "canSerializeFMUstate"),
    3: ("canGetAndSetFMUState", "canSerializeFMUState"),
}


def description(model: Model, token: str, *, fmi: Version) -> bytes:
    """The file, as one of the two standards has it."""
    root = ET.Element("fmiModelDescription", _head(model, token, fmi))
    capabilities = {
        "modelIdentifier": IDENTIFIER,
        "canHandleVariableCommunicationStepSize": "true",
        **dict.fromkeys(_STATE[fmi], "true"),
    }
    ET.SubElement(root, "CoSimulation", capabilities)
    units = ET.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        base = {unit: str(power) for unit, power in exponents.items()}
        ET.SubElement(ET.SubElement(units, "Unit", name=name), "BaseUnit", base)
    categories = ET.SubElement(root, "LogCategories")
    ET.SubElement(categories, "Category", name="logStatusError", description="what was refused, and why")
    ET.SubElement(root, "DefaultExperiment", startTime="0", stepSize=repr(model.step))
    offered = [(number, variable) for number, variable in enumerate(model.variables) if variable.offered]
    variables = ET.SubElement(root, "ModelVariables")
    for number, exported in offered:
        (_variable_2 if fmi == 2 else _variable_3)(variables, number, exported)
    _structure(root, offered, fmi)
    ET.indent(root)
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="utf-8") + b"\n"


def _head(model: Model, token: str, fmi: Version) -> dict[str, str]:
    return {
        "fmiVersion": f"{fmi}.0",
        "modelName": model.name,
        "guid" if fmi == 2 else "instantiationToken": token,
        "description": model.about,
        "generationTool": f"skisnow {version('skisnow')}",
        "license": "BSD-3-Clause",
        "variableNamingConvention": "structured",
    }


def _attributes(number: int, variable: Variable) -> dict[str, str]:
    variability = "fixed" if variable.causality == "parameter" else "continuous"
    return {
        "name": variable.name,
        "valueReference": str(number),
        "description": variable.about,
        "causality": variable.causality,
        "variability": variability,
    }


def _quantity(variable: Variable) -> dict[str, str]:
    starts = variable.causality in ("parameter", "input")
    return {"unit": variable.unit} | ({"start": repr(variable.start)} if starts else {})


def _variable_2(variables: ET.Element, number: int, variable: Variable) -> None:
    ET.SubElement(
        ET.SubElement(variables, "ScalarVariable", _attributes(number, variable)), "Real", _quantity(variable)
    )


def _variable_3(variables: ET.Element, number: int, variable: Variable) -> None:
    ET.SubElement(variables, "Float64", _attributes(number, variable) | _quantity(variable))


def _structure(root: ET.Element, offered: list[tuple[int, Variable]], fmi: Version) -> None:
    """Which variables are outputs, by place in the list (2.0, from 1) or by reference (3.0)."""
    structure = ET.SubElement(root, "ModelStructure")
    outputs = [
        str(place if fmi == 2 else number)
        for place, (number, element) in enumerate(offered, start=1)
        if element.causality == "output"
    ]
    if fmi == 2:
        lists = ET.SubElement(structure, "Outputs"), ET.SubElement(structure, "InitialUnknowns")
        for element in lists:
            for place in outputs:
                ET.SubElement(element, "Unknown", index=place)
        return
    for kind in ("Output", "InitialUnknown"):
        for number in outputs:
            ET.SubElement(structure, kind, valueReference=number)
