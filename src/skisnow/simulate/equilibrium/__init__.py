"""A flexible ski at rest in snow, or carving steadily: the discrete equations and their solution."""
