"""What a change of a scenario replaces: the other ways of saying the same."""

from __future__ import annotations

from typing import Final

_SNOW_WAYS: Final = {
    "snow.H_V_N_per_mm3": ("snow.results", "snow.site", "snow.published"),
    "snow.results": ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.published", "snow.map_file"),
    "snow.published": ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.results", "snow.site", "snow.map_file"),
}
_REPLACED: Final = {
    **_SNOW_WAYS,
    "ski.name": ("ski.file",),
    "ski.file": ("ski.name",),
    "course.name": ("course.file",),
    "course.file": ("course.name",),
}
KEYS_OF_KIND: Final = {
    "plane": ("slope.angle_deg",),
    "profile": ("slope.profile", "slope.profile_gap"),
    "grid": ("slope.grid", "slope.smooth_m", "slope.origin_x_m", "slope.origin_y_m"),
}
"""By the kind of a slope, the keys that no other kind has."""
_REPLACED_BY_VALUE: Final = {
    ("slope.kind", kind): tuple(name for other, names in KEYS_OF_KIND.items() if other != kind for name in names)
    for kind in KEYS_OF_KIND
} | {
    ("snow.penetration", "elastic"): ("snow.unloading_ratio",),
}


def replaced(name: str, value: object) -> tuple[str, ...]:
    """The keys that give room when a key gets a value.

    >>> replaced("ski.file", "mine.toml"), replaced("snow.penetration", "elastic")
    (('ski.name',), ('snow.unloading_ratio',))
    """
    by_value = _REPLACED_BY_VALUE.get((name, value), ()) if isinstance(value, str) else ()
    return (*_REPLACED.get(name, ()), *by_value)
