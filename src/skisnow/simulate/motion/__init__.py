"""Motion of a sledge on two flexible skis over snow that remembers: compiled loops over plain arrays."""
