"""From field records to snow parameters with uncertainty."""

from .analysis import Analysis, analyse
from .parts import campaign_notes
from .results import results_dict
from .screening import quality_flags

__all__ = ["Analysis", "analyse", "campaign_notes", "quality_flags", "results_dict"]
