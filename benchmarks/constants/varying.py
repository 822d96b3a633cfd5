"""One build whose constants are read at the start, and what each moves there: the ends of four runs."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from .collecting import PACKAGE, REMARK, ROOT, Constant, constants, split_at_commas

FACTORS: Final = (0.5, 2.0)
CASES: Final[dict[str, tuple[str, dict[str, object]]]] = {
    "edge of 1°": ("carved-46m", {"sledge.edge_angle_deg": 1.0, "start.heading_deg": 0.0}),
    "carve": ("carved-46m", {}),
    "skid": ("carved-46m", {"snow.H_V_N_per_mm3": 0.2, "snow.S_f_N_per_mm2": 0.1}),
    "skier": ("slalom-20-gates", {"run.duration_s": 6.0}),
}
"""Built-in scenarios with changes."""
STARTS: Final = 16
"""Speeds at the start, from 0.999 to 1.001 of 7 m/s, of which the ends are averaged."""
VARIABLE: Final = "SKISNOW_TUNED"
"""``KEY=FACTOR`` in the environment: the constant that is varied."""
_HEADER: Final = """#pragma once
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <type_traits>
namespace skisnow {
template <class T>
T tuned(const char* key, T value) {
  const char* given = std::getenv("SKISNOW_TUNED");
  const std::size_t length = std::strlen(key);
  if (given == nullptr || std::strncmp(given, key, length) != 0 || given[length] != '=') return value;
  const double changed = double(value) * std::atof(given + length + 1);
  return std::is_integral_v<T> ? T(std::llround(changed)) : T(changed);
}
}
"""
_MODULE: Final = """import os


def tuned(key, value):
    given, _, factor = os.environ.get("SKISNOW_TUNED", "").rpartition("=")
    return value if given != key else type(value)(value * float(factor))
"""
_RUN: Final = """
import json, sys, warnings
warnings.simplefilter("ignore")
import skisnow
from skisnow import load_scenario, simulate
out = {"package": skisnow.__file__}
for case, (name, changes) in json.loads(sys.argv[1]).items():
    try:
        run = simulate(load_scenario(name, changes=changes))
        out[case] = [run.outcome, float(run.place[-1, 0]), float(run.place[-1, 1])]
    except Exception as error:
        out[case] = [f"{type(error).__name__}: {error}"[:80], None, None]
print(json.dumps(out))
"""


@dataclass(frozen=True, slots=True)
class TunableBuild:
    """A copy of the package in a folder, with a core of its own."""

    folder: Path

    def make(self, varied: Iterable[Constant]) -> None:
        """Copy the sources, let these constants be read at the start, and build."""
        by_file: dict[str, list[Constant]] = {}
        for each in varied:
            by_file.setdefault(each.file, []).append(each)
        tree = self.folder / "tree"
        shutil.copytree(ROOT / "src/core", tree / "src/core", dirs_exist_ok=True)
        (tree / "src/skisnow/compiled").mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / "src/skisnow/compiled/sources.py", tree / "src/skisnow/compiled")
        shutil.copy(ROOT / "CMakeLists.txt", tree)
        shutil.copy(ROOT / "src/exported.map", tree / "src")
        shutil.copytree(
            PACKAGE, self.package / "skisnow", ignore=shutil.ignore_patterns("_core*.so"), dirs_exist_ok=True
        )
        (tree / "tuned.hpp").write_text(_HEADER, encoding="utf-8")
        (self.package / "skisnow" / "tuned_constants.py").write_text(_MODULE, encoding="utf-8")
        for file, inside in by_file.items():
            top = tree / "src" if file.startswith("core/") else self.package
            text = (ROOT / "src" / file).read_text(encoding="utf-8")
            (top / file).write_text(rewritten(text, inside), encoding="utf-8")
        flags = [f"-DCMAKE_CXX_FLAGS=-include {tree / 'tuned.hpp'}", f"-DPython_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", "-S", tree, "-B", tree / "build", "-G", "Ninja", *flags], check=True)
        subprocess.run(["cmake", "--build", tree / "build", "--target", "_core"], check=True)
        for library in (tree / "build").glob("_core*.so"):
            shutil.copy(library, self.package / "skisnow/compiled")

    @property
    def package(self) -> Path:
        """The folder to import it from."""
        return self.folder / "package"

    def ends(
        self, key: str = "", factor: float = 1.0, cases: Mapping[str, tuple[str, dict[str, object]]] = CASES
    ) -> dict[str, tuple[str, float | None, float | None]]:
        """Outcome and end (m) of each case with a constant times a factor."""
        import numpy as np

        paths = os.pathsep.join([str(self.package), str(Path(np.__file__).parents[1])])
        environment = {**os.environ, "PYTHONPATH": paths, VARIABLE: f"{key}={factor}"}
        command = [sys.executable, "-S", "-c", _RUN, json.dumps(cases)]
        said = subprocess.run(command, check=False, env=environment, capture_output=True, cwd=self.package, text=True)
        if said.returncode != 0:
            return dict.fromkeys(cases, (f"ends the program ({said.returncode})", None, None))
        found = json.loads(said.stdout)
        if not Path(found.pop("package")).is_relative_to(self.package):
            raise SystemExit("another package ran than the one that was built")
        return {case: tuple(end) for case, end in found.items()}

    def ends_of_starts(self, case: str, key: str = "", factor: float = 1.0) -> list[complex]:
        """End x + i y (m) of a case for each speed at the start, with a constant times a factor."""
        name, changes = CASES[case]
        speeds = [7.0 + 7e-3 * (2.0 * n / (STARTS - 1) - 1.0) for n in range(STARTS)]
        cases = {str(speed): (name, changes | {"start.speed_m_per_s": speed}) for speed in speeds}
        return [complex(x or 0.0, y or 0.0) for _, x, y in self.ends(key, factor, cases).values()]


def rewritten(text: str, varied: Iterable[Constant]) -> str:
    """A source whose constants of these are read at the start."""
    inside = sorted(varied, key=lambda each: each.start, reverse=True)
    if inside and inside[0].kind == "python":
        for each in inside:
            value = text[each.start : each.end]
            text = f'{text[: each.start]}_tuned("{each.key}", {value}){text[each.end :]}'
        return text.replace(
            "from __future__ import annotations\n",
            "from __future__ import annotations\nfrom skisnow.tuned_constants import tuned as _tuned\n",
            1,
        )
    for start, end in dict.fromkeys((each.start, each.end) for each in inside):
        keys = {each.name: each.key for each in inside if each.start == start}
        text = text[:start] + _read_at_start(text[start:end], keys) + text[end:]
    return text


def _read_at_start(declaration: str, keys: dict[str, str]) -> str:
    """``constexpr double A = 1.0, B = 2.0;`` with the values of those that have a key read at the start."""
    words, _, rest = REMARK.sub("", declaration).strip().rstrip(";").partition("constexpr ")
    kind, _, names = rest.removeprefix("static ").partition(" ")
    parts = []
    for each in split_at_commas(names):
        name, _, value = (part.strip() for part in each.partition("="))
        parts.append(f'{name} = skisnow::tuned<{kind}>("{keys[name]}", {value})' if name in keys else each.strip())
    return f"{'static inline' if 'static' in words else 'static'} const {kind} {', '.join(parts)};"


def varied_constants(reasons: Iterable[str]) -> list[Constant]:
    """Those without a reason not to be varied."""
    known = set(reasons)
    return [each for each in constants() if each.key not in known]
