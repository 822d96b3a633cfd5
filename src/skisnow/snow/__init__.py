"""Snow properties, published relations and values."""

from .properties import SnowProperties, snow_from_results

__all__ = ["SnowProperties", "snow_from_results"]
