"""A campaign that was imported is corrected: with reasons, undo and history; its files stay, its export says all."""

import io
import zipfile

import pytest

from .browser_types import Page
from .conftest import Served, follow, ready

FILES = {
    "campaign.toml": """name = "From <a> drawer"
observers = ["Ada", "Bo"]
tool = [{name = "ski piece", shape = "ski", length_mm = 200, width_mm = 62}]
plate = [{name = "plate", length_mm = 100}]
""",
    "penetration.csv": """experiment;site;tool;edge_angle_deg;load_N;depth_mm
1;A;ski piece;30;20;1,5
1;A;ski piece;30;40;22,5
1;A;ski piece;30;60;2,6
2;A;ski piece;30;20;1,4
2;A;ski piece;30;40;2,0
2;A;ski piece;30;60;2,5
3;B;ski piece;30;20;1,9
3;B;ski piece;30;40;2,7
3;B;ski piece;30;60;3,3
""",
    "shear.csv": "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm\n1,A,plate,90,6,250,30\n",
}


def imported(page: Page, served: Served) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, text in FILES.items():
            archive.writestr(f"drawer/{name}", text)
    page.goto(served.address)
    page.get_by_label("Files or zip").set_input_files(
        {"name": "drawer.zip", "mimeType": "application/zip", "buffer": packed.getvalue()}
    )
    ready(page)
    page.get_by_role("button", name="Import files or zip").press("Enter")
    page.get_by_text("The campaign is imported.").wait_for()


@pytest.mark.parametrize("has_icons", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_the_pages_fit_a_phone(page: Page, served: Served, has_icons: bool) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    if not has_icons:  # the icons' font comes late, or never: an icon is then its name, which is longer
        page.route("**/*.woff*", lambda route: route.abort())
    imported(page, served)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    follow(page, "Correct")
    page.get_by_text("A: 2").click()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    follow(page, "1", exact=True)
    page.get_by_text("below the one before it").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
