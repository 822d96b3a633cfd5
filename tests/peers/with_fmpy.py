"""FMPy's runs of FMUs: ``python -S with_fmpy.py PACKAGES FMU…``, without skisnow; the ends of runs as JSON.

FMPy's own check says nothing of an FMU without an interface, so that the model description is compared with the
standard's schema, too, which FMPy brings along.
"""

import importlib.util
import io
import json
import os
import sys
import zipfile
from pathlib import Path
from typing import Any

DURATION, STEP = 0.5, 0.01


def main(packages: str, *paths: str) -> None:
    """Check and simulate each."""
    sys.path += packages.split(os.pathsep)
    sys.modules["skisnow"] = None  # type: ignore[assignment]
    assert not any("skisnow" in name for name in sys.modules if sys.modules[name] is not None)
    import fmpy
    from fmpy.validation import validate_fmu
    from lxml import etree

    ends = []
    for path in paths:
        assert not validate_fmu(path)
        with zipfile.ZipFile(path) as archive:
            description = etree.parse(io.BytesIO(archive.read("modelDescription.xml")))
        fmi = description.getroot().attrib["fmiVersion"][0]
        schemas = Path(str(importlib.util.find_spec("fmpy").origin)).parent / "schema"  # type: ignore[union-attr]
        etree.XMLSchema(file=str(schemas / f"fmi{fmi}" / f"fmi{fmi}ModelDescription.xsd")).assertValid(description)
        require_same_after_bytes(fmpy, path)
        rows = fmpy.simulate_fmu(path, stop_time=DURATION, step_size=STEP, output_interval=STEP)
        ends.append(dict(zip(rows.dtype.names, rows[-1].tolist(), strict=True)))
    print(json.dumps(ends))


def require_same_after_bytes(fmpy: Any, path: str) -> None:
    """A state that FMPy has as bytes takes another instance on with the same bits."""
    folder, description = fmpy.extract(path), fmpy.read_model_description(path)
    one, other = (fmpy.instantiate_fmu(folder, description, fmi_type="CoSimulation") for _ in range(2))
    references = [each.valueReference for each in description.modelVariables if each.causality == "output"]
    for each in (one, other):
        if description.fmiVersion == "2.0":
            each.setupExperiment(startTime=0.0)
            each.enterInitializationMode()
        else:
            each.enterInitializationMode(startTime=0.0)
        each.exitInitializationMode()

    def stepped(instance: Any, first: int, last: int) -> list[float]:
        for number in range(first, last):
            instance.doStep(currentCommunicationPoint=number * STEP, communicationStepSize=STEP)
        return list((instance.getReal if description.fmiVersion == "2.0" else instance.getFloat64)(references))

    stepped(one, 0, 5)
    data = one.serializeFMUState(one.getFMUState())
    other.setFMUState(other.deserializeFMUState(data))
    assert stepped(other, 5, 15) == stepped(one, 5, 15)


if __name__ == "__main__":
    main(*sys.argv[1:])
