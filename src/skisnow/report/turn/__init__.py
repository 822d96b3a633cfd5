"""Report of a turn that was simulated on measured snow."""
