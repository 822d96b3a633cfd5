"""Campaigns of a few tests, as the texts of their files."""

from collections.abc import Mapping, Sequence

DESK = """name = "Desk"
tool = [{name = "ski piece", shape = "ski", length_mm = 200, width_mm = 62}]
"""
SHEARED = DESK + '[[plate]]\nname = "blade"\nlength_mm = 100\n'
SOFT, HARD = (1.5, 2.1, 2.6), (1.0, 1.4, 1.7)  # mm under 20, 40 and 60 N


def pressed(series: Mapping[str, tuple[str, Sequence[float]]], statuses: Mapping[str, str] | None = None) -> str:
    """A table of penetration tests: site and depths by name, and the column that cancels one, if any."""
    column = "" if statuses is None else ",status"
    rows = [
        f"{name},{site},ski piece,30,{20 * number},{depth}" + (f",{statuses.get(name, '')}" if statuses else "")
        for name, (site, depths) in series.items()
        for number, depth in enumerate(depths, start=1)
    ]
    return "\n".join([f"experiment,site,tool,edge_angle_deg,load_N,depth_mm{column}", *rows, ""])


def sheared(tests: Mapping[str, tuple[str, float]]) -> str:
    """A table of shear tests: site and moment (N m) by name."""
    rows = [f"{name},{site},blade,90,5,250,{moment}" for name, (site, moment) in tests.items()]
    return "\n".join(["experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm", *rows, ""])
