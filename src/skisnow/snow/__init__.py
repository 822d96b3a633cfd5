"""Snow properties, published relations and values."""
