"""The software bill of materials, CycloneDX 1.6 in JSON: what is installed to run, and what is kept inside skisnow.

    python requirements/sbom.py ENVIRONMENT OUT

ENVIRONMENT is the Python of an environment into which requirements/run.txt was installed and nothing else. Needs
cyclonedx-bom; `make sbom` sees to both.
"""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
STATIC = ROOT / "src" / "skisnow" / "replay" / "static"


def three_js() -> dict[str, Any]:
    """The component that lies inside the package and comes from no index."""
    files = sorted(STATIC.glob("three.*.js"))
    (release,) = re.findall(r'^const \w+="(\d+)"', files[0].read_text(encoding="utf-8"), re.MULTILINE)
    version = f"0.{release}.0"
    return {
        "bom-ref": f"three@{version}",
        "type": "library",
        "name": "three",
        "version": version,
        "purl": f"pkg:npm/three@{version}",
        "licenses": [{"license": {"id": "MIT"}}],
        "components": [
            {
                "type": "file",
                "name": path.relative_to(ROOT).as_posix(),
                "hashes": [{"alg": "SHA-256", "content": hashlib.sha256(path.read_bytes()).hexdigest()}],
            }
            for path in files
        ],
    }


def with_three_js(bill: dict[str, Any]) -> dict[str, Any]:
    """The bill with that component, on which skisnow depends."""
    component, root = three_js(), bill["metadata"]["component"]["bom-ref"]
    ours = [{**each, "dependsOn": [*each.get("dependsOn", ()), component["bom-ref"]]} for each in bill["dependencies"]
            if each["ref"] == root]  # fmt: skip
    others = [each for each in bill["dependencies"] if each["ref"] != root]
    further = [*ours, *others, {"ref": component["bom-ref"]}]
    return {**bill, "components": [*bill["components"], component], "dependencies": further}


def main() -> None:
    """Write the bill."""
    environment, out = sys.argv[1:]
    words = [sys.executable, "-m", "cyclonedx_py", "environment", "--pyproject", str(ROOT / "pyproject.toml")]
    words += ["--sv", "1.6", "--of", "JSON", "--output-reproducible", "-o", "-", environment]
    told = subprocess.run(words, stdout=subprocess.PIPE, text=True, check=True).stdout
    bill = with_three_js(json.loads(told))
    Path(out).parent.mkdir(parents=True, exist_ok=True)
    Path(out).write_text(json.dumps(bill, indent=2) + "\n", encoding="utf-8")
    print(f"{len(bill['components'])} components: {out}")


if __name__ == "__main__":
    main()
