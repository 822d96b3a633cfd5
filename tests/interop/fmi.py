"""An importer of FMUs for co-simulation in a page: unpacks, loads the library, calls it by either standard."""

from __future__ import annotations

import ctypes
import itertools
import os
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from skisnow._support.arrays import FloatArray

OK, DISCARD, ERROR = 0, 2, 3
LOGGER_2 = ctypes.CFUNCTYPE(
    None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p
)  # what follows the message is not looked at
LOGGER_3 = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
_NUMBERS = itertools.count()


class Callbacks(ctypes.Structure):
    _fields_ = (("logger", LOGGER_2), *((name, ctypes.c_void_p) for name in ("take", "free", "finished", "place")))


class Fmu:
    """An FMU that is unpacked and loaded."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.folder = folder / f"unpacked {next(_NUMBERS)} %"  # URIs are to be decoded
        with zipfile.ZipFile(path) as archive:
            archive.extractall(self.folder)
        self.description = ET.parse(self.folder / "modelDescription.xml").getroot()
        self.fmi = int(self.description.attrib["fmiVersion"][0])
        self.token = self.description.attrib["guid" if self.fmi == 2 else "instantiationToken"]
        variables = self.description.find("ModelVariables")
        assert variables is not None
        self.references = {each.attrib["name"]: int(each.attrib["valueReference"]) for each in variables}
        self.starts = {
            each.attrib["name"]: float((each[0] if self.fmi == 2 else each).attrib.get("start", "nan"))
            for each in variables
        }
        (library,) = self.folder.glob("binaries/*/skisnow.so")
        self.library: Any = ctypes.CDLL(os.fspath(library))

    def call(self, name: str, *given: Any) -> int:
        return int(self.library[f"fmi{self.fmi}{name}"](*given))

    def instance(self, token: str | None = None) -> Instance:
        return Instance(self, self.token if token is None else token)


class Instance:
    """One instance; every call that is not OK is an AssertionError with the log."""

    def __init__(self, fmu: Fmu, token: str) -> None:
        self.fmu, self.words = fmu, list[str]()
        resources = fmu.folder / "resources"
        if fmu.fmi == 2:
            self._log: Any = LOGGER_2(lambda *said: self.words.append(said[4].decode()))
            self._callbacks = Callbacks(logger=self._log)
            make = fmu.library.fmi2Instantiate
            given: tuple[Any, ...] = (
                b"one", 1, token.encode(), resources.as_uri().encode(), ctypes.byref(self._callbacks), 0, 1
            )  # fmt: skip
        else:
            self._log = LOGGER_3(lambda *said: self.words.append(said[3].decode()))
            make = fmu.library.fmi3InstantiateCoSimulation
            no, none = ctypes.c_bool(False), ctypes.c_void_p(None)
            given = (
                b"one", token.encode(), f"{resources}/".encode(), no, no, no, no, none, ctypes.c_size_t(0), none,
                self._log, none,
            )  # fmt: skip
        make.restype = ctypes.c_void_p
        self.at = ctypes.c_void_p(make(*given))

    def __del__(self) -> None:
        if self.at.value is not None:
            self.fmu.library[f"fmi{self.fmu.fmi}FreeInstance"](self.at)

    def call(self, name: str, *given: Any) -> None:
        code = self.fmu.call(name, self.at, *given)
        assert code == OK, self.words[-1:]

    def begin(self, time: float = 0.0, values: Mapping[str, float] | None = None) -> None:
        """Initialize at a time with these values."""
        start, no = (ctypes.c_double(time), ctypes.c_double(0.0)), ctypes.c_bool(False)
        if self.fmu.fmi == 2:
            self.call("SetupExperiment", 0, start[1], start[0], 0, start[1])
            self.call("EnterInitializationMode")
        else:
            self.call("EnterInitializationMode", no, start[1], start[0], no, start[1])
        self.set(values or {})
        self.call("ExitInitializationMode")

    def step(self, now: float, length: float) -> None:
        at = ctypes.c_double(now), ctypes.c_double(length)
        if self.fmu.fmi == 2:
            self.call("DoStep", *at, 1)
            return
        said, last = [ctypes.c_bool(True) for _ in range(3)], ctypes.c_double(-1.0)
        self.call("DoStep", *at, ctypes.c_bool(True), *map(ctypes.byref, said), ctypes.byref(last))
        assert not any(each.value for each in said)
        assert last.value == now + length

    def set(self, values: Mapping[str, float]) -> None:
        self._exchange("Set", list(values), (ctypes.c_double * len(values))(*values.values()))

    def get(self, names: Sequence[str]) -> FloatArray:
        found = (ctypes.c_double * len(names))()
        self._exchange("Get", list(names), found)
        return np.array(found)

    def _exchange(self, what: str, names: list[str], values: ctypes.Array[ctypes.c_double]) -> None:
        count = ctypes.c_size_t(len(names))
        references = (ctypes.c_uint * len(names))(*(self.fmu.references[name] for name in names))
        if self.fmu.fmi == 2:
            self.call(f"{what}Real", references, count, values)
        else:
            self.call(f"{what}Float64", references, count, values, count)

    def state(self) -> ctypes.c_void_p:
        kept = ctypes.c_void_p()
        self.call("GetFMUstate" if self.fmu.fmi == 2 else "GetFMUState", ctypes.byref(kept))
        return kept

    def to_bytes(self, kept: ctypes.c_void_p) -> bytes:
        size, name = ctypes.c_size_t(), "FMUstate" if self.fmu.fmi == 2 else "FMUState"
        self.call(f"Serialized{name}Size", kept, ctypes.byref(size))
        room = ctypes.create_string_buffer(size.value)
        self.call(f"Serialize{name}", kept, room, size)
        return room.raw

    def from_bytes(self, data: bytes) -> ctypes.c_void_p:
        kept = ctypes.c_void_p()
        name = "DeSerializeFMUstate" if self.fmu.fmi == 2 else "DeserializeFMUState"
        self.call(name, data, ctypes.c_size_t(len(data)), ctypes.byref(kept))
        return kept

    def restore(self, kept: ctypes.c_void_p) -> None:
        self.call("SetFMUstate" if self.fmu.fmi == 2 else "SetFMUState", kept)

    def forget(self, kept: ctypes.c_void_p) -> None:
        self.call("FreeFMUstate" if self.fmu.fmi == 2 else "FreeFMUState", ctypes.byref(kept))
        assert kept.value is None
