"""Snow pressed by a tool (`PenetrationLaw`) or at one place (`PointLaw`), with the list of the rivals of each."""

from typing import Final

from .area import AreaLaw
from .bilinear import BilinearLaw
from .depth import DepthLaw
from .elastic_point import ElasticPoint
from .element_count import ElementCountLaw
from .hypoplastic_point import HypoplasticPoint
from .law import PenetrationLaw
from .layered_point import LayeredPoint, ProfilePoint
from .mean_pressure import MeanPressureLaw
from .mean_pressure_point import MeanPressurePoint
from .point_law import PointLaw
from .volume import VolumeLaw
from .volume_with_angle import VolumeWithAngleLaw
from .volume_with_angle_point import VolumeWithAnglePoint

LAWS: Final[tuple[type[PenetrationLaw], ...]] = (
    VolumeLaw,
    VolumeWithAngleLaw,
    BilinearLaw,
    DepthLaw,
    AreaLaw,
    MeanPressureLaw,
    ElementCountLaw,
)
"""Every law for the force of a tool: one set of tests runs over all of them."""

POINT_LAWS: Final[tuple[type[PointLaw], ...]] = (
    ElasticPoint,
    HypoplasticPoint,
    VolumeWithAnglePoint,
    MeanPressurePoint,
    LayeredPoint,
    ProfilePoint,
)
"""Every law for one place on the snow."""

__all__ = [
    "LAWS",
    "POINT_LAWS",
    "AreaLaw",
    "BilinearLaw",
    "DepthLaw",
    "ElasticPoint",
    "ElementCountLaw",
    "HypoplasticPoint",
    "LayeredPoint",
    "MeanPressureLaw",
    "MeanPressurePoint",
    "PenetrationLaw",
    "PointLaw",
    "ProfilePoint",
    "VolumeLaw",
    "VolumeWithAngleLaw",
    "VolumeWithAnglePoint",
]
