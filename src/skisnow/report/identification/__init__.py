"""Report of an identification."""
