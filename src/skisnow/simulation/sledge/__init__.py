"""The sledge on two flexible skis as a body: its frames, and its mass matrix."""
