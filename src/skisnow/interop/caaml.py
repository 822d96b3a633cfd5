"""Snow pits to CAAML 6.0.3, with H_V and S_f as custom data in a separate namespace."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final
from xml.sax.saxutils import escape, quoteattr

from .._support.errors import ParameterError
from .._support.staging import write_file
from .._support.units import CM, MM
from ..campaign.caaml import OWN_NAMESPACE
from ..campaign.snow_pit import DepthTemperature, ForceProfile, LayerDensity, PlateValue, SnowLayer, SnowPit

VERSION: Final = "6.0.3"
HAND_HARDNESSES: Final = (
    "F-", "F", "F+", "F-4F", "4F-", "4F", "4F+", "4F-1F", "1F-", "1F", "1F+", "1F-P", "P-", "P", "P+", "P-K",
    "K-", "K", "K+", "K-I", "I",
)  # fmt: skip
_GRAINS: Final = """
    PP PPco PPnd PPpl PPsd PPir PPgp PPhl PPip PPrm MM MMrp MMci DF DFdc DFbk RG RGsr RGlr RGwp RGxf FC FCso FCsf FCxr
    DH DHcp DHpr DHch DHla DHxr SH SHsu SHcv SHxr MF MFcl MFpc MFsl MFcr IF IFil IFic IFbi IFrc IFsc
"""
GRAIN_FORMS: Final = frozenset(_GRAINS.split())
"""Codes that the standard lists; others cannot be written in it."""
METHODS: Final = ("SnowMicroPen", "Ram Sonde", "Push-Pull Gauge", "other")
_NAMES: Final = (
    f'xmlns:caaml="http://caaml.org/Schemas/SnowProfileIACS/v{VERSION}" xmlns:gml="http://www.opengis.net/gml" '
    f'xmlns:skisnow="{OWN_NAMESPACE}"'
)
_CONTROL: Final = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML does not allow."""
_TIME: Final = re.compile(r"\d{4}-\d\d-\d\d(T\d\d:\d\d(:\d\d(\.\d+)?)?(Z|[+-]\d\d:\d\d)?)?")


def write_caaml(pit: SnowPit, path: str | Path) -> Path:
    """Write a snow pit as CAAML 6.0.3.

    Returns: the file.
    Raises ParameterError: the pit has no time, which CAAML demands, a snow temperature above 0 °C, or a code that CAAML
        does not have.
    Raises OutputError: the file cannot be written.

    See the page docs/files/campaign.md.
    """
    write_file(path, caaml_text(pit))
    return Path(path)


def caaml_text(pit: SnowPit) -> str:
    """Text of a CAAML file with a snow pit; rejects values that CAAML does not allow."""
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + "\n".join(_profile_xml(pit)) + "\n"


def _profile_xml(pit: SnowPit) -> Iterator[str]:
    """XML of a snow pit: time, observer, place and measurements."""
    pit_id = re.sub(r"[^\w.-]", "_", pit.name) or "pit"
    yield f"<caaml:SnowProfile {_NAMES} gml:id={quoteattr(f'skisnow-{pit_id}')}>"
    if pit.comment:
        yield _nested("metaData", _element_xml("comment", pit.comment))
    yield _nested("timeRef/recordTime/TimeInstant", _element_xml("timePosition", _timestamp(pit.time)))
    person = _element_xml("name", pit.observer or "unknown")
    yield f'<caaml:srcRef><caaml:Person gml:id="observer-{pit_id}">{person}</caaml:Person></caaml:srcRef>'
    yield f'<caaml:locRef gml:id="location-{pit_id}">'
    yield _element_xml("name", pit.name)
    yield _element_xml("obsPointSubType", "snow profile location")
    if pit.elevation is not None:
        yield _nested("validElevation/ElevationPosition", _element_xml("position", str(round(pit.elevation))), uom="m")
    if pit.aspect:
        yield _nested("validAspect/AspectPosition", _element_xml("position", pit.aspect))
    if pit.slope_angle_deg is not None:
        angle = _element_xml("position", str(round(pit.slope_angle_deg)))
        yield _nested("validSlopeAngle/SlopeAnglePosition", angle, uom="deg")
    if pit.latitude_deg is not None and pit.longitude_deg is not None:
        where = f"{_number(pit.latitude_deg)} {_number(pit.longitude_deg)}"
        point = f'<gml:Point gml:id="point-{pit_id}" srsName="urn:ogc:def:crs:EPSG::4326" srsDimension="2">'
        yield _nested("pointLocation", f"{point}<gml:pos>{where}</gml:pos></gml:Point>")
    if pit.country:
        yield _element_xml("country", pit.country)
    if pit.region:
        yield _element_xml("region", pit.region)
    yield "</caaml:locRef>"
    yield '<caaml:snowProfileResultsOf><caaml:SnowProfileMeasurements dir="top down">'
    yield from _measurements_xml(pit)
    yield "</caaml:SnowProfileMeasurements></caaml:snowProfileResultsOf>"
    yield _element_xml("application", "skisnow")
    yield "</caaml:SnowProfile>"


def _measurements_xml(pit: SnowPit) -> Iterator[str]:
    """XML of air temperature, snow height, layers, temperatures, densities, forces, H_V and S_f, if known."""
    if pit.air_temperature_C is not None:
        yield _nested("weatherCond", _element_xml("airTempPres", _number(pit.air_temperature_C), uom="degC"))
    if pit.snow_height is not None:
        yield _nested("snowPackCond/hS/Components", _cm_xml("height", pit.snow_height))
    if pit.layers:
        yield _nested("stratProfile", "<caaml:stratMetaData/>" + "".join(map(_layer_xml, pit.layers)))
    if pit.temperatures:
        yield _nested("tempProfile", "<caaml:tempMetaData/>" + "".join(map(_temperature_xml, pit.temperatures)))
    if pit.densities:
        method = _nested("densityMetaData", _element_xml("methodOfMeas", "other"))
        samples = (
            _nested("Layer", _extent(sample) + _element_xml("density", _number(sample.snow_density), uom="kgm-3"))
            for sample in pit.densities
        )
        yield _nested("densityProfile", method + "".join(samples))
    yield from map(_forces_xml, pit.forces)
    values = (("snowHardness", "N mm-3", pit.snow_hardness), ("failureShearStress", "N mm-2", pit.failure_shear_stress))
    if elements := "".join(_plate_value(name, unit, value) for name, unit, value in values if value is not None):
        yield _nested("customData", elements)


def _layer_xml(layer: SnowLayer) -> str:
    """XML of a layer with comment, extent, grains and hand hardness; rejects unknown grain forms and hardnesses."""
    parts = [_nested("metaData", _element_xml("comment", layer.comment)) if layer.comment else ""]
    parts.append(_extent(layer))
    if layer.grain_form:
        _require_choice("grain form", layer.grain_form, GRAIN_FORMS)
        parts.append(_element_xml("grainFormPrimary", layer.grain_form))
    if layer.grain_size is not None:
        average = _nested("Components", _element_xml("avg", _number(layer.grain_size / MM)))
        parts.append(_nested("grainSize", average, uom="mm"))
    names = ("hardnessTop", "hardnessBottom") if layer.hardness_bottom else ("hardness",)
    for name, hardness in zip(names, (layer.hardness, layer.hardness_bottom), strict=False):
        if hardness:
            _require_choice("hand hardness", hardness, HAND_HARDNESSES)
            parts.append(_element_xml(name, hardness, uom=""))
    return _nested("Layer", "".join(parts))


def _temperature_xml(observed: DepthTemperature) -> str:
    """XML of a snow temperature at a depth; rejects one above 0 °C."""
    if observed.temperature_C > 0.0:
        raise ParameterError("snow at {temperature_c:g} °C cannot be written: CAAML allows up to 0 °C").tag(
            "cannot_write", temperature_c=observed.temperature_C
        )
    temperature = _element_xml("snowTemp", _number(observed.temperature_C), uom="degC")
    return _nested("Obs", _cm_xml("depth", observed.depth) + temperature)


def _extent(layer: SnowLayer | LayerDensity) -> str:
    """XML of the depth of the top and, if known, of the thickness."""
    return _cm_xml("depthTop", layer.top) + ("" if layer.thickness is None else _cm_xml("thickness", layer.thickness))


def _forces_xml(profile: ForceProfile) -> str:
    """XML of a profile of penetration forces (N) over the depth (cm)."""
    method = profile.method if profile.method in METHODS else "other"
    pairs = zip((profile.depth / CM).tolist(), profile.force.tolist(), strict=True)
    rows = " ".join(f"{_number(depth)},{_number(force)}" for depth, force in pairs)
    components = _element_xml("depth", "template") + _element_xml("penRes", "template")
    return _nested(
        "hardnessProfile",
        _nested("hardnessMetaData", _element_xml("methodOfMeas", method))
        + _nested("MeasurementComponents", components, uomDepth="cm", uomHardness="N")
        + _nested("Measurements", _element_xml("tupleList", rows)),
    )


def _plate_value(name: str, unit: str, value: PlateValue) -> str:
    """XML of a mean value with its number of tests and, if known, its interval."""
    ends = "" if value.interval is None else ' low="{}" high="{}"'.format(*map(_number, value.interval))
    return f'<skisnow:{name} uom="{unit}" n="{value.n}"{ends}>{_number(value.value)}</skisnow:{name}>'


def _nested(path: str, inner: str, **attributes: str) -> str:
    """XML elements within each other, by the names in the path; the innermost has the attributes."""
    *outer, last = path.split("/")
    words = "".join(f" {name}={quoteattr(value)}" for name, value in attributes.items())
    element = f"<caaml:{last}{words}>{inner}</caaml:{last}>"
    for name in reversed(outer):
        element = f"<caaml:{name}>{element}</caaml:{name}>"
    return element


def _element_xml(name: str, text: str, *, uom: str | None = None) -> str:
    """XML element with an escaped text and, if given, a unit; control characters become spaces."""
    unit = "" if uom is None else f" uom={quoteattr(uom)}"
    allowed = _CONTROL.sub(" ", text)
    return f"<caaml:{name}{unit}>{escape(allowed)}</caaml:{name}>"


def _cm_xml(name: str, length: float) -> str:
    """XML element with a length (m) converted to cm."""
    return _element_xml(name, _number(length / CM), uom="cm")


def _number(value: float) -> str:
    """Number with twelve digits, which removes the rounding of a unit conversion."""
    return f"{value:.12g}"


def _require_choice(what: str, value: str, allowed: frozenset[str] | tuple[str, ...]) -> None:
    """Reject a value that CAAML does not allow; `what` names the field."""
    if value not in allowed:
        raise ParameterError("{field}: {value!r} cannot be written: CAAML allows {allowed}").tag(
            "cannot_write", field=what, value=value, allowed=sorted(allowed)
        )


def _timestamp(time: str) -> str:
    """Time of a pit in CAAML's form, with seconds; rejects another text than a day or a time."""
    if not _TIME.fullmatch(time):
        raise ParameterError(
            "CAAML demands a day such as 2026-11-23 or a time such as 2026-11-23T09:10; the pit has {time!r}: give it "
            "with --time"
        ).tag("missing", time=time)
    return f"{time}:00" if re.fullmatch(r"[^T]+T\d\d:\d\d", time) else time
