"""Record the answers of another version's resolver: python -m tests.scenario.layers.record CHECKOUT/src

The answers of commit 58cc12bf are in ``58cc12bf.json``: one line for each combination, null where it rejected it.
"""

import json
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

from .combinations import answer, combinations, write_files


def main() -> None:
    """Print the answers as JSON."""
    sys.path.insert(0, sys.argv[1])
    import skisnow
    from skisnow.scenario.contact import Contact

    if not hasattr(Contact, "hardness_at"):
        Contact.hardness_at = lambda contact, x, y: (  # type: ignore[assignment]
            contact.snow.snow_hardness
            if contact.snow_map is None or contact.snow_map.hardness is None
            else float(contact.snow_map.hardness.values_at(x, y))
        )
    load: Any = skisnow.load_scenario if hasattr(skisnow, "load_scenario") else skisnow.scenario
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as folder:
        write_files(Path(folder))
        lines = [json.dumps(answer(each, Path(folder), load, ValueError)) for each in combinations()]
    print("[\n" + ",\n".join(lines) + "\n]")


if __name__ == "__main__":
    main()
