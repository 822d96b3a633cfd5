"""Without Exudyn its chain of cables cannot be imported; the tests that use it are skipped with the reason."""

from importlib.util import find_spec

collect_ignore = [] if find_spec("exudyn") else ["exudyn_ski.py"]
