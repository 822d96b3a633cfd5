"""From field records to snow parameters with uncertainty."""
