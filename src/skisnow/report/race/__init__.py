"""Report of a race."""
