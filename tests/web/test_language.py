"""Languages of the lab, and reports on small screens."""

import io
from pathlib import Path
from typing import Final

import pytest
from PIL import Image

from skisnow._support.errors import FieldDataError
from skisnow.campaign import Problem, campaign_of_files
from skisnow.campaign.problems import lines_of
from skisnow.campaign.reference import reference_campaign
from skisnow.estimation import analyse
from skisnow.report import write_report
from skisnow.report.run.page import write_run

from ..report.runs import circle_run
from .browser_types import Page
from .conftest import Served
from .shown_texts import shown_texts

DATA: Final = {
    "read once more after waiting", "measured, entered in the lab", "the edited ski", "as in the scenario",
    "the sliders", "the numbers below",
    "{}, edited", "{} {} at {} m", "edited in the lab ({}) from: {}", "{} · skisnow",
    "the designed ski", "{}, designed", "designed in the lab from the ski {}", "NFKD",
}  # fmt: skip
"""Texts that are stored, values of menus, and the name of a Unicode form."""


def test_every_text_of_the_lab_is_a_message() -> None:
    assert {text: file for text, file in shown_texts().items() if text not in DATA} == {}


DESCRIBED = """load_steps_N = [20, 40]
tool = [{ name = "ski", shape = "ski", length_mm = 200, width_mm = 62 }]
plate = [{ name = "plate", length_mm = "100" }]
plaze = 1
"""
HEAD = "experiment,site,tool,edge_angle_deg,load_N,depth_mm"


def test_what_is_wrong_in_files_is_reported_with_their_own_names() -> None:
    table = f"{HEAD}\n1,A,ski,30,20,1\n".encode()
    with pytest.raises(FieldDataError) as caught:
        campaign_of_files({"campaign.toml": DESCRIBED.encode(), "penetration.csv": table})
    wrong = (each for each in caught.value.problems if isinstance(each, Problem))
    german = "\n".join(line.text("de") for line in lines_of(wrong))
    assert "Spalte plaze: gefunden 'plaze'; erlaubt: der Schlüssel plate." in german


def test_all_links_of_the_head_are_in_one_row_of_a_phone(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.set_extra_http_headers({"Accept-Language": "de"})
    page.goto(served.address)
    page.get_by_role("link", name="Simulieren").wait_for()
    links = page.locator(".lab-head nav")
    assert links.evaluate("each => each.scrollWidth - each.clientWidth") == 0
    assert links.locator("a").last.evaluate("each => each.getBoundingClientRect().right") <= 390


WIDER_THAN_THEIR_BOX = """() =>
    [...document.querySelectorAll("table, td, tbody th, caption, figure, img, dd, .key li, p")]
    .filter((each) => !each.closest(".scroll"))
    .filter((each) => each.getBoundingClientRect().width > 0)
    .filter((each) => each.scrollWidth > each.clientWidth + 1 && getComputedStyle(each).display !== "inline"
        || each.getBoundingClientRect().right > document.documentElement.clientWidth + 1)
    .map((each) => `${each.tagName} ${each.textContent.slice(0, 60)}`)"""
NAMES_THAT_RUN_OVER_THEIR_NUMBERS = """() =>
    [...document.querySelectorAll("td[data-name]")]
    .filter((each) => getComputedStyle(each, "::before").whiteSpace !== "normal")
    .map((each) => each.dataset.name)"""
A4_PX = 680
"""180 mm of text at 96 pixels an inch."""


@pytest.fixture(scope="module")
def reports(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("reports")
    analysis = analyse(reference_campaign(1).campaign(), n_resamples=100)
    return write_report(analysis, folder / "campaign"), write_run(circle_run(), folder / "run")


@pytest.mark.slow
@pytest.mark.parametrize("which", [0, 1], ids=["campaign", "run"])
def test_a_telephone_shows_figures_and_tables_whole(file_page: Page, reports: tuple[Path, Path], which: int) -> None:
    file_page.set_viewport_size({"width": 390, "height": 844})
    file_page.goto(reports[which].as_uri())
    assert file_page.evaluate("document.documentElement.scrollWidth") == 390
    assert file_page.evaluate(WIDER_THAN_THEIR_BOX) == []
    assert file_page.evaluate(NAMES_THAT_RUN_OVER_THEIR_NUMBERS) == []
    wide = file_page.locator("figure.wide img").first
    drawn = wide.evaluate("(each) => [each.naturalWidth, each.clientWidth]")
    assert drawn[1] > 0.9 * drawn[0]  # the words of the figure have their own size, within a tenth
    box = file_page.locator(".scroll").first
    assert box.evaluate("(each) => { each.scrollTo(1000, 0); return each.scrollLeft + each.clientWidth }") == drawn[1]


@pytest.mark.slow
def test_a_shadow_says_that_rows_of_a_long_table_follow(file_page: Page, reports: tuple[Path, Path]) -> None:
    """At the lower edge of its box, until the last row is in sight."""
    file_page.set_viewport_size({"width": 390, "height": 844})
    file_page.goto(reports[0].as_uri())
    table = file_page.locator(".table").filter(has_text="The nine candidate models").first
    table.scroll_into_view_if_needed()

    def lower_edge() -> int:
        """Grey value beside the words, a pixel above the edge."""
        picture = Image.open(io.BytesIO(table.screenshot())).convert("L")
        return int(picture.getpixel((picture.width // 2, picture.height - 2)))  # type: ignore[arg-type]

    table.evaluate(
        "(each) => { for (const row of each.querySelectorAll('table > *')) row.style.color = 'transparent' }"
    )
    assert lower_edge() < 240
    table.evaluate("(each) => each.scrollTo(0, each.scrollHeight)")
    assert lower_edge() == 255


@pytest.mark.slow
@pytest.mark.parametrize("which", [0, 1], ids=["campaign", "run"])
def test_a_report_prints_as_one_pdf(file_page: Page, reports: tuple[Path, Path], which: int, tmp_path: Path) -> None:
    """A PDF by Print, Save as PDF: pages of A4, no table wider than the paper."""
    file_page.set_viewport_size({"width": A4_PX, "height": 1000})
    file_page.emulate_media(media="print")
    file_page.goto(reports[which].as_uri())
    assert file_page.evaluate("document.documentElement.scrollWidth") <= A4_PX
    wide = file_page.evaluate(
        """() => [...document.querySelectorAll("table")].filter((each) => each.getBoundingClientRect().right > 682)
            .map((each) => each.textContent.slice(0, 60))"""
    )
    assert wide == []
    content = file_page.pdf(path=tmp_path / "report.pdf", prefer_css_page_size=True)
    assert content.startswith(b"%PDF")
    assert 2 <= content.count(b"/Type /Page\n") + content.count(b"/Type /Page ") + content.count(b"/Type /Page/") < 60
