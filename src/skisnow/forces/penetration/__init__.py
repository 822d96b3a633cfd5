"""Snow pressed by a tool (`PenetrationLaw`) or at one place (`PointLaw`), with the list of the rivals of each."""

from typing import Final

from .geometry_laws import AreaLaw, DepthLaw, ElementCountLaw, MeanPressureLaw
from .law import PenetrationLaw, PointLaw
from .layered_point import LayeredPoint, ProfilePoint
from .point_laws import ElasticPoint, HypoplasticPoint, MeanPressurePoint, VolumeWithAnglePoint
from .volume_laws import BilinearLaw, VolumeLaw, VolumeWithAngleLaw

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
    "LAWS", "POINT_LAWS", "AreaLaw", "BilinearLaw", "DepthLaw", "ElasticPoint", "ElementCountLaw", "HypoplasticPoint",
    "LayeredPoint", "MeanPressureLaw", "MeanPressurePoint", "PenetrationLaw", "PointLaw", "ProfilePoint", "VolumeLaw",
    "VolumeWithAngleLaw", "VolumeWithAnglePoint",
]  # fmt: skip
