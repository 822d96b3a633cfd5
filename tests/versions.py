"""What the oldest versions that pyproject.toml allows cannot: `make test-minimum` leaves it out, with the reason."""

from importlib.metadata import version

import pytest
from packaging.version import Version

EXACT_QUANTILES = pytest.mark.skipif(
    Version(version("scipy")) < Version("1.17"),
    reason="quantiles of Student's t of an older SciPy are exact to 4e-10 only",
)
SAME_PIXELS = pytest.mark.skipif(
    Version(version("matplotlib")) < Version("3.11"),
    reason="the pictures were drawn by a newer Matplotlib, which places letters otherwise",
)
