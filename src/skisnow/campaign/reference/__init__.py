"""The synthetic reference campaign: its design, its noise, its truth, its files."""

from .campaign import ReferenceCampaign, reference_campaign, write_reference
from .design import ReferenceNoise

__all__ = ["ReferenceCampaign", "ReferenceNoise", "reference_campaign", "write_reference"]
