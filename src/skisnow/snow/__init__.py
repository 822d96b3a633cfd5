"""Snow properties, published relations and values."""

from .from_results import snow_from_results
from .measured_range import MeasuredRange
from .properties import SnowProperties
from .published_snow import published_names, published_snow

__all__ = ["MeasuredRange", "SnowProperties", "published_names", "published_snow", "snow_from_results"]
