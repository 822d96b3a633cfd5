"""Maps of a study."""
