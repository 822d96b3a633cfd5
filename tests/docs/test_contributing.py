"""The page for those who change the code says what is so."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_layers_are_those_that_are_held() -> None:
    """Names and order of the contract, but for packages that are not built."""
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    told = next(block for block in re.findall(r"```\n(.*?)```", page, re.DOTALL) if "cli\n" in block)
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    layers = next(each for each in contracts["contracts"] if each["type"] == "layers")["layers"]
    source = ROOT / "src" / "skisnow"
    held = []
    for layer in layers:
        packages = [name.strip(" ()") for name in layer.split("|")]
        built = [name for name in packages if (source / name).is_dir() or (source / f"{name}.py").is_file()]
        if built:
            held.append(" | ".join(built))
    assert told.splitlines() == held
