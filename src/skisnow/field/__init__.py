"""Field campaigns: records, files, screening, store, reference campaign."""

from .density_records import DensityLayers, read_density_layers
from .marks import MARKS, Mark
from .problems import Problem
from .reading import campaign_of_files, check_campaign, read_campaign
from .records import (
    AppliedCorrection,
    Campaign,
    DensitySamples,
    DropConeTests,
    PenetrationSeries,
    PenetrationTests,
    ShearTests,
)
from .reference import ReferenceCampaign, ReferenceNoise, reference_campaign, write_reference
from .screening import mark_problems, screen_penetration, screen_shear
from .snow_micro_pen import SnowMicroPenProfile, read_snow_micro_pen

__all__ = [
    "MARKS",
    "AppliedCorrection",
    "Campaign",
    "DensityLayers",
    "DensitySamples",
    "DropConeTests",
    "Mark",
    "PenetrationSeries",
    "PenetrationTests",
    "Problem",
    "ReferenceCampaign",
    "ReferenceNoise",
    "ShearTests",
    "SnowMicroPenProfile",
    "campaign_of_files",
    "check_campaign",
    "mark_problems",
    "read_campaign",
    "read_density_layers",
    "read_snow_micro_pen",
    "reference_campaign",
    "screen_penetration",
    "screen_shear",
    "write_reference",
]
