"""An FMU as a file: modelDescription.xml of FMI 2.0 or 3.0, the core as a library, and the model's data."""

from __future__ import annotations

import hashlib
import io
import platform
import sys
import xml.etree.ElementTree as ET
import zipfile
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path
from typing import Final, Literal, TypeAlias

from ..._support.errors import ParameterError
from ..._support.staging import require_ending, write_file
from ...contact import c_library
from ...scenario import Scenario
from .models import UNITS, Model, contact_model, sledge_model

ENDING: Final = ".fmu"
DATA: Final = "skisnow.txt"
"""The model's data, in the folder of resources; its first word is the token that the model description has, too."""
FOLDERS: Final[dict[Version, str]] = {2: "linux64", 3: "x86_64-linux"}
"""Folder of the library within the FMU, by the version of the standard."""
STEP: Final = {"contact": 2e-4, "sledge": 1e-2}
"""Step (s) that the model description proposes (see the page docs/how-to/other-programs.md)."""
_DATE: Final = (1980, 1, 1, 0, 0, 0)  # the earliest that a zip knows: the same FMU has the same bytes


def write_contact_fmu(scenario: Scenario, path: str | Path, *, fmi: Version = 2, skis: int = 2) -> Path:
    """Write an FMU of rigid skis in the snow of a scenario: pose and motion in, force and moment out.

    scenario: its ski, snow, laws and slope; its sledge defines the start of the skis.
    path: path that ends in .fmu.
    fmi: version of the standard, 2 (2.0) or 3 (3.0).
    skis: 1, or 2: the left and the right one.
    Returns: path of the file.
    Raises ParameterError: the path does not end in .fmu, this machine has no library, or the number is not allowed.
    Raises OutputError: the file cannot be written.

    See the page docs/how-to/other-programs.md.
    """
    _require(path, fmi)
    if skis not in (1, 2):
        raise ParameterError("skis is {skis!r}; an FMU of the contact has 1 or 2").tag("out_of_range", skis=skis)
    return _write_fmu(contact_model(scenario, skis=skis, step=STEP["contact"]), Path(path), fmi)


def write_sledge_fmu(scenario: Scenario, path: str | Path, *, fmi: Version = 2) -> Path:
    """Write an FMU of the sledge of a scenario on its flexible skis: a push in, motion and forces on the boots out.

    With a skier the poses of its boots at the end of each step go in, too: the importing program controls them.

    scenario: scenario without boots.file.
    path, fmi: as in `write_contact_fmu`, like the errors.
    """
    _require(path, fmi)
    return _write_fmu(sledge_model(scenario, step=STEP["sledge"]), Path(path), fmi)


def _require(path: str | Path, fmi: int) -> None:
    """Reject a path without the ending .fmu, an unknown FMI version, or a platform other than Linux on x86-64."""
    require_ending(path, ENDING)
    if fmi not in FOLDERS:
        raise ParameterError("fmi is {fmi!r}; FMUs are written for version 2 or 3 of the standard").tag(
            "unknown_name", fmi=fmi
        )
    if not sys.platform.startswith("linux") or platform.machine() != "x86_64":
        raise ParameterError("FMUs are written on Linux on x86-64, the only platform of their library").tag(
            "not_supported"
        )


def _write_fmu(model: Model, path: Path, fmi: Version) -> Path:
    """Write the FMU: description, compiled library, data and licence; its bytes depend on the contents only."""
    library = c_library().read_bytes()
    digest = hashlib.sha256(library + model.data.encode() + repr(model).encode()).hexdigest()
    token = "-".join((digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:32]))
    files = {
        "modelDescription.xml": description(model, f"{{{token}}}", fmi=fmi),
        f"binaries/{FOLDERS[fmi]}/{IDENTIFIER}.so": library,
        f"resources/{DATA}": f"{{{token}}}\n{model.data}".encode(),
        "documentation/licenses/license.txt": _licence().encode(),
    }
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, _DATE), content, zipfile.ZIP_DEFLATED)
    write_file(path, packed.getvalue())
    return path


def _licence() -> str:
    """Text of skisnow's licence, for an FMU, which contains its library."""
    try:
        text = distribution("skisnow").read_text("licenses/LICENSE")
    except PackageNotFoundError:
        text = None
    return text or "skisnow: BSD-3-Clause\n"


Version: TypeAlias = Literal[2, 3]
IDENTIFIER: Final = "skisnow"
"""Name of the library within the FMU, without its ending."""
_STATE: Final = {
    2: ("canGetAndSetFMUstate", "canSerializeFMUstate"),
    3: ("canGetAndSetFMUState", "canSerializeFMUState"),
}


def description(model: Model, token: str, *, fmi: Version) -> bytes:
    """Contents of modelDescription.xml for FMI 2.0 or 3.0; `token` identifies the model."""
    head = {
        "fmiVersion": f"{fmi}.0",
        "modelName": model.name,
        "guid" if fmi == 2 else "instantiationToken": token,
        "description": model.about,
        "generationTool": f"skisnow {version('skisnow')}",
        "license": "BSD-3-Clause",
        "variableNamingConvention": "structured",
    }
    root = ET.Element("fmiModelDescription", head)
    capabilities = {
        "modelIdentifier": IDENTIFIER,
        "canHandleVariableCommunicationStepSize": "true",
        **dict(zip(_STATE[fmi], ("true", str(model.serializes).lower()), strict=True)),
    }
    ET.SubElement(root, "CoSimulation", capabilities)
    units = ET.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        base = {unit: str(power) for unit, power in exponents.items()}
        ET.SubElement(ET.SubElement(units, "Unit", name=name), "BaseUnit", base)
    categories = ET.SubElement(root, "LogCategories")
    ET.SubElement(categories, "Category", name="logStatusError", description="rejected files with the reasons")
    ET.SubElement(root, "DefaultExperiment", startTime="0", stepSize=repr(model.step))
    offered = [(number, variable) for number, variable in enumerate(model.variables) if variable.offered]
    variables = ET.SubElement(root, "ModelVariables")
    for number, exported in offered:
        attributes = {
            "name": exported.name,
            "valueReference": str(number),
            "description": exported.about,
            "causality": exported.causality,
            "variability": "fixed" if exported.causality == "parameter" else "continuous",
        }
        value = {"unit": exported.unit}
        if exported.causality in ("parameter", "input"):
            value["start"] = repr(exported.start)
        if fmi == 2:
            ET.SubElement(ET.SubElement(variables, "ScalarVariable", attributes), "Real", value)
        else:
            ET.SubElement(variables, "Float64", attributes | value)
    structure = ET.SubElement(root, "ModelStructure")
    for kind in ("Output", "InitialUnknown"):  # by position from 1 (FMI 2.0) or by value reference (FMI 3.0)
        listing = ET.SubElement(structure, f"{kind}s") if fmi == 2 else structure
        for place, (number, exported) in enumerate(offered, start=1):
            if exported.causality == "output" and fmi == 2:
                ET.SubElement(listing, "Unknown", index=str(place))
            elif exported.causality == "output":
                ET.SubElement(listing, kind, valueReference=str(number))
    ET.indent(root)
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="utf-8") + b"\n"
