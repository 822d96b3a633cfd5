"""A series that is being entered: what its readings say, corrections, undo, cancel, history, the next one."""

import math

import pytest
from nicegui import ui

from skisnow.campaign.store import NewEntry
from skisnow.report.formatting import significant
from skisnow.web.words import result_words

from ..desk import Sheet, values
from .conftest import (
    CANCEL,
    NAME,
    OTHER_LOAD,
    PENETRATION,
    Entered,
    after_waiting,
    back,
    enter,
    leave,
    selected,
    undo_button,
)


def test_the_hardness_follows_the_readings(entered: Entered) -> None:
    """A wedge at ϑ = 30°: V = 200 mm · e²/(2 tan ϑ), and H_V = F/V where all readings give the same."""
    page = entered.begun_series()
    enter(page, "Depth under 20 N (mm)", str(2.6 * math.sqrt(20 / 60)))
    enter(page, "Depth under 40.5 N (mm)", str(2.6 * math.sqrt(40.5 / 60)))
    enter(page, "Depth under 60 N (mm)", "2.6")
    by_hand = 60.0 / (200.0 * 2.6**2 / (2.0 * math.tan(math.radians(30.0))))
    row = entered.session().quick_results("A").experiments["penetration.csv", "1"]
    assert result_words(row).startswith(f"H_V = {significant(by_hand)} N/mm³, [")
    page.shows(f"[value] {result_words(row)}")
    assert "[quiet] Test 1" in page.outline()
    (value,) = (each for each in page.of(ui.label) if "value" in each.classes)
    assert value.props["role"] == "status"
    panel = page.charts()["Load (N)"]
    assert (panel["x"], panel["from_zero"]) == ("Depth (mm)", "xy")
    assert [(line["style"], line["points"]) for line in panel["lines"]] == [(0, True), (0, False)]
    assert panel["lines"][0]["y"] == [20, 40.5, 60]


def test_too_few_loads_are_reported_when_the_series_is_left(entered: Entered) -> None:
    page = entered.begun_series()
    enter(page, "Depth under 20 N (mm)", "1.5")
    enter(page, "Depth under 40.5 N (mm)", "2.15")
    page.shows("H_V = ")
    few = "The series has fewer than 3 load steps."
    assert not any(few in line for line in page.outline())
    page.press("Next series")
    page.shows(few)
    assert "h2 New series" in page.outline()
    assert page.focused() is page.field("Edge angle (°)")
    entered.add_series("2", ("20", "1.5"))
    page = entered.series_page()  # another one was begun since
    page.shows(few)
    enter(page, "Depth under 60 N (mm)", "2.6")
    page.until(lambda: not any(few in line for line in page.outline()))


def asked_to_correct(entered: Entered) -> Sheet:
    entered.add_series("1", ("20", "1.5"), ("40.5", "22.5"))
    page = entered.series_page()
    enter(page, "Depth under 40.5 N (mm)", "2,25", number=1)
    return page


def test_another_depth_asks_for_a_reason(entered: Entered) -> None:
    page = asked_to_correct(entered)
    assert page.field("Why").value == "typing error"
    why = page.field("Why")
    assert page.focused() is why
    assert selected(page)[-1] is why
    assert "wide" in why.classes
    assert page.scripts[-1] == "lab.answered(1, true)"
    page.fill("Why", "misread")
    leave(page, "Depth under 40.5 N (mm)")  # one question is enough
    assert page.field("Why") is why
    page.press("Correct it")
    assert page.outcome() == "good"
    assert entered.depths() == [("20", "1.5"), ("40.5", "2.25")]
    entry = entered.history()[-1]
    assert (entry.action, entry.about, entry.why, entry.who) == (
        "correct",
        entered.history()[1].sequence,
        "misread",
        "Ada",
    )
    assert entry.cells == {"depth_mm": "2.25"}
    page.shows(" 22.5")
    assert page.field("Depth under 20 N (mm)").value == "1.5"
    assert not any("field Why" in line for line in page.outline())
    assert "misread" in undo_button(page)


def test_a_depth_that_is_left_with_another_number_asks_without_taking_the_focus(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"), ("40.5", "22.5"))
    page = entered.series_page()
    leave(page, "Depth under 40.5 N (mm)", "2.25")
    assert page.field("Why").value == "typing error"
    assert page.focused() is page.field("Depth under 60 N (mm)")
    assert selected(page) == []
    why = page.field("Why")
    leave(page, "Depth under 40.5 N (mm)", "2.26")  # another number is another question
    assert "Depth under 40.5 N (mm): 22.5 becomes 2.26." in page.outline()
    assert page.field("Why") is not why
    leave(page, "Depth under 20 N (mm)", "2.26")  # one question about both
    lines = page.between("Depth under 20 N (mm): 1.5 becomes 2.26.")
    assert lines[1] == "Depth under 40.5 N (mm): 22.5 becomes 2.26."
    page.press("Correct it")
    assert entered.depths() == [("20", "2.26"), ("40.5", "2.26")]


def test_what_is_no_depth_is_no_correction(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"))
    page = entered.series_page()
    name = "Depth under 20 N (mm)"
    enter(page, name, "", number=1)
    assert page.outcome() == "bad"
    assert page.refusals() == page.faults(name)
    assert page.scripts[-1] == "lab.answered(1, false)"
    page.fill("Operator", "Bo")
    enter(page, "Depth under 60 N (mm)", "3")
    leave(page, name)
    assert page.outcome() == "good"
    assert entered.history()[-1].who == "Bo"


def test_a_correction_after_another_persons_is_rejected(entered: Entered) -> None:
    page = asked_to_correct(entered)
    first = entered.history()[0].sequence
    cells = {"depth_mm": "1.6"}
    entered.write(NewEntry(action="correct", file=PENETRATION, test="1", about=first, cells=cells, why="slip"))
    page.press("Correct it")
    assert page.outcome() == "bad"
    assert entered.depths() == [("20", "1.6"), ("40.5", "22.5")]
    assert page.field("Why").value == "typing error"
    page.press("Leave it as it was")
    assert page.field("Depth under 20 N (mm)").value == "1.6"
    enter(page, "Depth under 40.5 N (mm)", "2.25")
    page.press("Correct it")
    assert entered.depths() == [("20", "1.6"), ("40.5", "2.25")]


def test_a_series_is_cancelled_with_a_reason(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"))
    page = entered.series_page()
    page.press(CANCEL)
    assert page.field("Why").value == ""
    assert page.focused() is page.field("Why")
    assert selected(page) == []
    page.press("Leave it as it was")
    assert page.focused().text == CANCEL
    assert not any("field Why" in line for line in page.outline())
    page.press(CANCEL)
    page.press("Cancel the test")
    assert page.outcome() == "bad"
    page.fill("Why", " the tool  slipped ")
    assert page.sends("Cancel the test", 1)
    assert page.outcome() == "good"
    entry = entered.history()[-1]
    assert (entry.action, entry.why, entry.who, entry.test) == ("cancel", "the tool slipped", "Ada", "1")
    page.shows("[quiet] Test 1")
    lines = page.between("h2 Series 1", "[quiet] Test 1")
    assert all(line.endswith("readonly") for line in lines if line.startswith("field"))
    assert any("the tool slipped" in line for line in lines)
    assert set(values(lines).values()) == {"1.5", ""}
    assert page.focused().text == "Next series"
    assert OTHER_LOAD not in page.outline()
    assert "the tool slipped" in undo_button(page)


def test_a_test_that_somebody_wrote_about_is_not_cancelled(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"))
    page = entered.series_page()
    page.press(CANCEL)
    entered.add_series("1", ("60", "3"))
    page.fill("Why", "slip")
    assert not page.sends("Cancel the test", 1)
    assert page.outcome() == "bad"
    assert entered.session().test(PENETRATION, "1").cancelled == ""


def test_the_last_entry_is_undone_and_stays_in_the_history(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"))
    entered.add_series("1", ("60", "3"), who="")
    page = entered.series_page()
    page.press("Undo: entered 3 mm under 60 N")
    assert page.outcome() == "good"
    _, second, undo = entered.history()
    assert (undo.action, undo.about, undo.who) == ("undo", second.sequence, "Ada")
    assert page.field("Depth under 60 N (mm)").value == ""
    assert "1.5 mm" in undo_button(page)
    assert len([line for line in page.outline() if line.endswith("(undone)")]) == 1
    assert page.focused() is page.field("Depth under 40.5 N (mm)")
    page.press(undo_button(page))
    assert entered.depths() == []
    assert page.between("h2 Series 1")[1] == "[quiet] A · ski piece · 30°"
    assert f"button {CANCEL}" not in page.outline()
    assert undo_button(page) == ""
    assert any("&site=A" in each for each in page.scripts)


def test_a_series_is_left_when_all_that_was_typed_is_stored(entered: Entered) -> None:
    page = entered.begun_series()
    page.fill("Depth under 20 N (mm)", "x")
    page.fill(back("40.5"), "2.5")
    assert not page.sends("Next series", 1)
    assert page.outcome() == "bad"
    assert page.focused() is page.field("Depth under 20 N (mm)")
    assert selected(page) == [page.field("Depth under 20 N (mm)")]
    page.fill("Depth under 20 N (mm)", "")
    page.fill(back("40.5"), "")
    page.fill(after_waiting("40.5"), "2.2")
    page.fill(after_waiting("60"), "2.7")
    assert not page.sends("Next series", 2)
    assert page.outcome() == "bad"
    assert page.focused() is page.field(after_waiting("40.5"))
    page.fill(after_waiting("40.5"), "")
    page.fill(after_waiting("60"), " ")
    assert page.sends("Next series", 3)
    assert page.field(NAME).value == "1"


# What is not confirmed


def changed_states(page: Sheet) -> list[str]:
    return [each.text for each in page.of(ui.label) if "changed" in each.classes]


def test_a_change_is_never_shown_as_stored(entered: Entered) -> None:
    page = asked_to_correct(entered)
    assert len(changed_states(page)) == 1
    assert "good" not in page.status()
    states = [each.text for each in page.of(ui.label) if "stored" in each.classes]
    assert states.count("stored") == 1  # of 20 N
    enter(page, "Depth under 40.5 N (mm)", "22.5")  # as it was: nothing is asked any more
    assert changed_states(page) == []
    assert not any("field Why" in line for line in page.outline())


@pytest.mark.parametrize("act", ["Next series", CANCEL, "Undo"])
def test_an_unanswered_correction_holds_what_would_lose_it(entered: Entered, act: str) -> None:
    page = asked_to_correct(entered)
    assert not page.sends(act, 7)
    assert page.field("Depth under 40.5 N (mm)").value == "2,25"
    assert page.focused() is page.field("Why")
    assert "Depth under 40.5 N (mm): 22.5 becomes 2.25." in page.outline()
    assert len(changed_states(page)) == 1
    assert len(entered.history()) == 2
    page.press("Correct it")
    assert entered.depths() == [("20", "1.5"), ("40.5", "2.25")]
    page.press("Next series")
    assert "h2 New series" in page.outline()


def test_a_change_outlives_another_reading(entered: Entered) -> None:
    page = asked_to_correct(entered)
    enter(page, "Depth under 60 N (mm)", "3")
    page.fill("Further load (N)", "80")
    page.fill("Its depth (mm)", "4")
    page.press("Store it")  # draws the series again
    assert page.field("Depth under 40.5 N (mm)").value == "2,25"
    assert len(changed_states(page)) == 1
    assert "Depth under 40.5 N (mm): 22.5 becomes 2.25." in page.outline()
    page.press("Leave it as it was")
    assert page.field("Depth under 40.5 N (mm)").value == "22.5"
    assert changed_states(page) == []
    assert entered.depths() == [("20", "1.5"), ("40.5", "22.5"), ("60", "3"), ("80", "4")]
