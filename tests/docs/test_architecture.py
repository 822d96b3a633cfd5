"""The page on the house names files that are there, and its picture shows the packages as they stand."""

import re
import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")


def test_the_picture_is_of_these_packages() -> None:
    drawn = runpy.run_path(str(ROOT / "docs" / "figure_of_house.py"))
    assert drawn["PICTURE"].read_text(encoding="utf-8") == drawn["picture"]()
    packages = {package for floor in drawn["floors"]() for package in floor}
    assert set(drawn["INSIDE"]) | set(drawn["READING"]) | set(drawn["TURN"]) <= packages


def test_every_file_is_there() -> None:
    """A name without a folder is of the folder that was named before it, or of one that its step has named."""
    named = re.findall(r"`([\w/*]+\.(?:py|cpp|hpp))`", PAGE)
    assert len(named) > 50
    source = {path.relative_to(ROOT / "src" / "skisnow").as_posix() for path in (ROOT / "src/skisnow").rglob("*.py")}
    core = {path.relative_to(ROOT / "src/core").as_posix() for path in (ROOT / "src/core").rglob("*.?pp")}
    missing = [
        name
        for name in named
        if not (
            any(each == name or each.endswith(f"/{name}") for each in source)
            or any(Path(each).match(name) for each in core)
        )
    ]
    assert missing == []


def test_every_number_of_the_picture_is_told() -> None:
    """As many numbered steps as the picture has, for each of the two paths, and each package is named in its step."""
    drawn = runpy.run_path(str(ROOT / "docs" / "figure_of_house.py"))
    paths = [part.split("\n## ")[0] for part in re.split(r"\n## From a \w+ to \w+ \w+\n", PAGE)[1:]]
    for path, packages in zip(paths, (drawn["READING"], drawn["TURN"]), strict=True):
        steps = re.findall(r"(?m)^\d+\. (.*(?:\n   .*)*)", path)
        assert len(steps) == len(packages)
        for step, package in zip(steps, packages, strict=True):
            assert re.search(rf"`{package}\b", step) or package == "compiled", (package, step)
