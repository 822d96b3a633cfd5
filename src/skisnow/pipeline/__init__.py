"""From a campaign to a turn in one call: analysis, the snow of a site, a turn with each contact, a band, one page."""
