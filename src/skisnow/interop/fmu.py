"""Functional mock-up units (FMI 2.0 and 3.0) for co-simulation, without Python in them.

``write_contact_fmu``: rigid skis in the snow of a scenario, pose and motion in, force and moment out.
``write_sledge_fmu``: its whole sledge on flexible skis, a push in, motion and forces on the boots out.

An FMU is a file with modelDescription.xml, the core as a library, and the data from which the core builds the model.
"""

from __future__ import annotations

import hashlib
import io
import itertools
import platform
import sys
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy.spatial.transform import Rotation

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.staging import require_ending, write_file
from ..compiled import core
from ..contact import Runner, SnowContact, SnowField, c_library
from ..geometry.surfaces import Grid
from ..scenario import Plane, Scenario
from ..simulation.run_setup import AT_REST, laid_out
from ..skier import BalancedSkier

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


SIDES: Final = ("left", "right")


@dataclass(frozen=True, slots=True)
class Model:
    """Variables and data of an FMU before it is written.

    name, about: name and description that the importing program shows.
    variables: in the order of their references.
    data: text that the compiled core reads.
    step: default step of the importing program (s).
    serializes: True if its states can be stored as bytes.
    """

    name: str
    about: str
    variables: tuple[Variable, ...]
    data: str
    step: float
    serializes: bool = True


def axes_of(scenario: Scenario) -> str:
    """Sentence on the axes of places and forces of an FMU."""
    if isinstance(scenario.slope, Plane):
        return "Axes of the slope: x down the fall line, y to the left, z out of the snow."
    return "Axes: x horizontal down the slope, y to the left, z upwards."


def contact_model(scenario: Scenario, *, skis: int, step: float) -> Model:
    """FMU model of rigid skis in the snow of a scenario; they start where its sledge would be set down."""
    setup = laid_out(scenario)
    _require_builtin_laws(setup.snow)
    sides = SIDES if skis == len(SIDES) else ("ski",)
    runner = Runner.of(scenario.ski)
    contact = SnowContact(setup.snow, [runner] * skis, spacing=setup.numbers["line_spacing_m"])
    dynamics, inputs, outputs = setup.dynamics, list[Variable](), list[Variable]()
    for ski, side in zip(dynamics.body.skis, sides, strict=False):
        place = dynamics.position + dynamics.rotation @ ski.boot
        inputs += _pose_variables(f"{side}.", place, dynamics.rotation @ ski.axes.T)
    for side in sides:
        outputs += vector(f"{side}.force", "output", "N", "load of the snow on the ski", np.zeros(3))
        outputs += vector(f"{side}.moment", "output", "N.m", "load of the snow on the ski, about its boot", np.zeros(3))
    variables = (TIME, *_snow_parameters(setup.snow), *inputs, *outputs)
    starts = np.array([variable.start for variable in variables])
    data = core.contact_data(setup.snow.compiled, contact.compiled, starts)
    about = (
        f"Snow on {'a rigid ski' if skis == 1 else 'two rigid skis'}: poses and motions at a step's beginning in, "
        f"forces and moments there out. {axes_of(scenario)}"
    )
    return Model("skisnow contact", about, variables, data, step)


def sledge_model(scenario: Scenario, *, step: float) -> Model:
    """FMU model of a scenario's sledge on its flexible skis; with a skier the boots' poses are inputs."""
    if scenario.boots is not None:
        raise ParameterError("boots.file: an FMU gets the motion of its boots as inputs; remove boots.file").tag(
            "not_supported"
        )
    setup = laid_out(scenario)
    _require_builtin_laws(setup.snow)
    dynamics, outputs = setup.dynamics, list[Variable]()
    about = "w, x, y, z of the sledge's axes ahead, left, up"
    outputs += vector("position", "output", "m", "state of the middle between the boots", dynamics.position)
    outputs += vector("quaternion", "output", "1", about, _quaternion(dynamics.rotation))
    outputs += vector("velocity", "output", "m/s", "state of the middle between the boots", np.zeros(3))
    outputs += vector("angular_velocity", "output", "rad/s", "of the sledge", np.zeros(3))
    for side in SIDES:
        about = "load of the ski on its boot: ahead, left across the base, off the base"
        outputs += vector(f"{side}.boot_force", "output", "N", about, np.zeros(3))
        outputs += vector(f"{side}.boot_moment", "output", "N.m", about, np.zeros(3))
    moving = [] if scenario.skier is None else BalancedSkier(scenario).posture.poses()
    poses = [_pose_variables(f"{SIDES[k]}.boot_", moving[k].place, moving[k].axes.T) for k in range(len(moving))]
    inputs = (
        *vector("push.force", "input", "N", "a force besides on the sledge", np.zeros(3)),
        *vector("push.place", "input", "m", "where it acts, from the boots' middle in the sledge's axes", np.zeros(3)),
        *itertools.chain(*poses),
    )
    speed = Variable("start.speed", "parameter", "m/s", "ahead, at the start", scenario.start.speed)
    variables = (TIME, speed, *inputs, *outputs)
    inertia = np.array([ski.inertia for ski in dynamics.body.skis])
    starts = np.array([variable.start for variable in variables])
    data = core.sledge_data(
        setup.snow.compiled, dynamics.contact.compiled, dynamics.compiled, inertia, AT_REST, starts, len(moving)
    )
    about = f"A sledge on two flexible skis over snow. {axes_of(scenario)}"
    if moving:
        about += " Poses and motions of the boots at a step's end, in the sledge's axes, in."
    step = step if scenario.skier is None else scenario.skier.control_period
    return Model("skisnow sledge", about, variables, data, step, serializes=not moving)


def _require_builtin_laws(snow: SnowField) -> None:
    """Reject a snow with a law in Python."""
    if snow.penetration is not None or snow.friction_in_python is not None or snow.shear_in_python is not None:
        raise ParameterError("an FMU contains no Python: it accepts the built-in laws, not a user-defined one").tag(
            "no_data"
        )


def _quaternion(rotation: FloatArray) -> FloatArray:
    """Quaternion (w, x, y, z) of a rotation matrix."""
    return np.roll(Rotation.from_matrix(rotation).as_quat(canonical=True), 1)


def _snow_parameters(snow: SnowField) -> tuple[Variable, ...]:
    """Parameters of the snow; a hardness or strength that varies over the place is listed, but not `offered`."""
    hardness, stress = (float(grid.at(0.0, 0.0)[0]) for grid in (snow.compiled.hardness, snow.compiled.strength))
    one_hardness = not isinstance(snow.snow_hardness, Grid)
    one_stress = not isinstance(snow.failure_shear_stress, Grid) and not isinstance(snow.strength_share, Grid)
    friction = snow.compiled.friction.constant
    return (
        Variable("snow.hardness", "parameter", "N/m3", "H_V", hardness, one_hardness),
        Variable("snow.failure_shear_stress", "parameter", "N/m2", "S_f", stress, one_stress),
        Variable("snow.unloading_ratio", "parameter", "1", "k_u/H_V", snow.unloading_ratio),
        Variable("snow.friction", "parameter", "1", "coefficient of friction at rest", friction),
    )


def _pose_variables(name: str, place: FloatArray, axes: FloatArray) -> list[Variable]:
    """Inputs with this prefix: place (m) of a boot, quaternion of the ski's axes (columns), and velocities."""
    about = "w, x, y, z: ahead, left across the base, off it"
    return [
        *vector(f"{name}position", "input", "m", "of the boot", place),
        *vector(f"{name}quaternion", "input", "1", about, _quaternion(axes)),
        *vector(f"{name}velocity", "input", "m/s", "of the boot", np.zeros(3)),
        *vector(f"{name}angular_velocity", "input", "rad/s", "of the ski", np.zeros(3)),
    ]


Causality: TypeAlias = Literal["independent", "parameter", "input", "output"]

UNITS: Final[dict[str, dict[str, int]]] = {
    "s": {"s": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N/m2": {"kg": 1, "m": -1, "s": -2},
    "N/m3": {"kg": 1, "m": -2, "s": -2},
    "1": {},
}
"""Units of the variables, by exponents of the base units."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A number that the FMU exchanges with the importing program.

    name: by the standards' structured convention: ``left.force[1]``.
    causality: time, parameter, input or output.
    unit: a key of `UNITS`.
    about: description.
    start: its value before anything is set.
    offered: True if the model description lists it; it has a reference number in either case.
    """

    name: str
    causality: Causality
    unit: str
    about: str
    start: float = 0.0
    offered: bool = True


def vector(name: str, causality: Causality, unit: str, about: str, start: Iterable[float]) -> Iterator[Variable]:
    """A variable for each number of a vector, counted from 1."""
    for number, value in enumerate(start, start=1):
        yield Variable(f"{name}[{number}]", causality, unit, about, float(value))


TIME: Final = Variable("time", "independent", "s", "time")
