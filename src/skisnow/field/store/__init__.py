"""The embedded store that keeps campaigns byte for byte."""

from .store import AddedCampaign, Finding, Store, StoredCampaign, StoredFile, default_path

__all__ = ["AddedCampaign", "Finding", "Store", "StoredCampaign", "StoredFile", "default_path"]
