"""The laws of the cases, in words and formulas."""

from __future__ import annotations

from typing import Final

PRESSURE: Final = (
    "At each place of the snow surface, by itself: pressure = max(0, H d_max - k (d_max - d)) along the snow's normal, "
    "d the depth of the base there below the undisturbed surface, d_max the largest d so far, this one included; "
    "H = snow_hardness_N_per_m3, k = unloading_ratio_1 * H. Where d <= 0 there is no pressure. Side walls do not count."
)
SHEAR: Final = (
    "Where the edge crosses a line across its way, the snow holds it across its direction in the surface: "
    "failure_shear_stress_N_per_m2 * d_edge * max(-1, min(1, (a - y) / shear_displacement_m)) per metre of edge, "
    "d_edge the depth of the deeper edge, y its place on that line and a an anchor: the place where it came through "
    "the surface, drawn along so that a - y never exceeds shear_displacement_m in size (elastic, perfectly plastic)."
)
FRICTION: Final = (
    "Glide friction: friction_1 times the pressure's force, against the motion along the edge. Compaction: the "
    "pressure does the work of pressing snow down, so on a base whose depth d falls by c per metre in the direction of "
    "motion it also pushes back with c times its force."
)
CARVE: Final = (
    "Every place of the snow meets the ski's sections from tip to tail: d_max at a section is the largest depth "
    "of the sections before it at the same distance from the edge. Forces along the ski there are none.",
    "Balance. d_edge(s) = b0 + b1 s - cos(angle) (h + w) + width/2 sin(angle + twist); across, at the distance "
    "x from the edge in the surface, d = d_edge - x tan(angle + twist), as far as x <= width cos(angle + twist). "
    "With f the pressure per length: integral of f = load, integral of f s = 0; the edge draws t d_edge per "
    "length towards the inside of the turn, integral of it = load tan(angle). The ski is clamped straight over "
    "clamp_length_m about s = 0. (EI w'')'' = f cos(angle) + t d_edge sin(angle); -(GJ twist')' = - integral of "
    "p (width/2 cos(angle + twist) - x) dx - t d_edge (width/2) sin(angle + twist). Ends are free.",
    "Edge line in the surface, towards the inside: width/2 cos(angle + twist) + (h + w) sin(angle). Its radius "
    "at the boot: the circle through s = 0.4, 0 and -0.4 m. The contact: where d_edge > 0.",
)
