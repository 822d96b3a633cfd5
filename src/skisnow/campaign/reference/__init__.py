"""The synthetic reference campaign: its design, its noise, its truth, its files."""

from .campaign import ReferenceCampaign, reference_campaign
from .design import ReferenceNoise
from .files import write_reference

__all__ = ["ReferenceCampaign", "ReferenceNoise", "reference_campaign", "write_reference"]
