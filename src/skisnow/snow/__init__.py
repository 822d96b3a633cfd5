"""Snow properties, published relations and values."""

from .from_results import published_names, published_snow, snow_from_results
from .measured_range import MeasuredRange
from .properties import SnowProperties

__all__ = ["MeasuredRange", "SnowProperties", "published_names", "published_snow", "snow_from_results"]
