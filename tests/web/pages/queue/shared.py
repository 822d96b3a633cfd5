"""Helpers that the tests of this folder share."""

from __future__ import annotations

from skisnow.web.study_fields import CARVE, Range, StudyQuestion

TURN = {"ski": "carver", "load_N": 800.0, "H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5, "unloading_ratio": 10.0}
TURNS = StudyQuestion(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN, unit_s=0.03)
