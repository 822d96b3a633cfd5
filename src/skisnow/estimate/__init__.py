"""From field records to snow parameters with uncertainty."""

from .analysis import Analysis, analyse
from .remarks import remarks
from .results import results_dict
from .screening import marks_of

__all__ = ["Analysis", "analyse", "marks_of", "remarks", "results_dict"]
