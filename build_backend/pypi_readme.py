"""The README as the package index shows it: links and pictures lead to the repository that [project.urls] names.

Until it names one, pictures are left out and links are plain text.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
LINK = re.compile(r"(!?)\[([^\]]*)\]\((?!https?://|#)([^)\s]+)\)")
RAW = {"github.com": "raw.githubusercontent.com"}


def absolute(text: str, source: str | None, version: str) -> str:
    """The text with every relative link made absolute, at the tag of this version.

    >>> absolute("![a ski](docs/ski.png), [more](docs/ski.md)", None, "0.1.0")
    ', more'
    >>> absolute("![a ski](docs/ski.png), [more](docs/ski.md)", "https://github.com/us/skisnow", "0.1.0")
    '![a ski](https://raw.githubusercontent.com/us/skisnow/v0.1.0/docs/ski.png), [more](https://github.com/us/skisnow/blob/v0.1.0/docs/ski.md)'
    """
    if source is None:
        return LINK.sub(lambda link: "" if link[1] else link[2], text)
    raw = source
    for host, of_files in RAW.items():
        raw = raw.replace(host, of_files)

    def led(found: re.Match[str]) -> str:
        place = f"{raw}/v{version}" if found[1] else f"{source}/blob/v{version}"
        return f"{found[1]}[{found[2]}]({place}/{found[3]})"

    return LINK.sub(led, text)


def dynamic_metadata(field: str, _settings: Mapping[str, Any] | None = None, *_more: object) -> dict[str, str]:
    """What scikit-build-core asks for."""
    if field != "readme":
        raise ValueError(f"{field} is not what this provider gives: it gives the readme")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return {
        "content-type": "text/markdown",
        "text": absolute(text, project.get("urls", {}).get("Source"), project["version"]),
    }
