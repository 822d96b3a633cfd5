"""Summary and figures of skis in snow."""
