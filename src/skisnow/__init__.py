"""skisnow turns what was measured on a slope into what a ski does on it."""
