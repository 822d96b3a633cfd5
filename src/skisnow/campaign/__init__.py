"""Field campaigns: records, files, screening, store, reference campaign."""

from .problems import QUALITY_FLAGS, AppliedCorrection, Problem, QualityFlag
from .reading.campaign import campaign_of_files, check_campaign, read_campaign
from .records import Campaign, DensitySamples, DropConeTests, PenetrationSeries, PenetrationTests, ShearTests
from .reference import ReferenceCampaign, ReferenceNoise, reference_campaign, write_reference
from .screening import flag_problems, screen_penetration, screen_shear
from .snow_micro_pen import SnowMicroPenProfile, read_snow_micro_pen

__all__ = [
    "QUALITY_FLAGS", "AppliedCorrection", "Campaign", "DensitySamples", "DropConeTests", "PenetrationSeries",
    "PenetrationTests", "Problem", "QualityFlag", "ReferenceCampaign", "ReferenceNoise", "ShearTests",
    "SnowMicroPenProfile", "campaign_of_files", "check_campaign", "flag_problems", "read_campaign",
    "read_snow_micro_pen", "reference_campaign", "screen_penetration", "screen_shear", "write_reference",
]  # fmt: skip
