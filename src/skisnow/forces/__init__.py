"""Force laws of snow on a tool or ski, one per file."""
