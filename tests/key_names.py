"""Names of scenario keys, columns and codes that tests of several packages use."""

from typing import Final

EDGE_ANGLE: Final = "sledge.edge_angle_deg"
SHEAR_DISPLACEMENT: Final = "snow.shear_displacement_mm"
DAMPING: Final = "snow.damping_N_s_per_mm3"
LINE_SPACING: Final = "solver.line_spacing_mm"
DELAYED_SPACING: Final = "solver.delayed_spacing_mm"
WAIST_WIDTH: Final = "ski.waist_width_mm"
SNOW_DENSITY: Final = "snow_density_kg_per_m3"
DROP_CONE_DEPTH: Final = "drop_cone_depth_mm"
LEFT_EDGE_ANGLE: Final = "left_edge_angle_deg"
GREATEST_EDGE_DEPTH: Final = "greatest_edge_depth_mm"
FORCE_PER_LENGTH: Final = "force_per_length_N_per_m"
SHEAR_DISPLACEMENT_INTERVAL: Final = "shear_displacement_interval_mm"
WRONG_CELL_COUNT: Final = "wrong_number_of_cells"
IGNORE_RANGE_WARNING: Final = "ignore::skisnow._support.errors.RangeWarning"
