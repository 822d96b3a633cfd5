"""Programs are run and scored: what is right, what is wrong in words, and an answer that is wrong."""

import json
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from openbench.programs import command_of, compiler, shipped, why_not
from openbench.reading import case_names, read_answer, read_case
from openbench.running import Asked, run
from openbench.scoring import error_of, score, spread_of
from openbench.words import OpenbenchError

from openbench import CASES, __main__, checking, sand, scoring, table
from tests.present import present

from .test_files import schema

PLATE = ("01-plate",)
AGAIN = ("02-edge", "04-glide", "07-turn")
"""Of which the scores of a second run are compared."""
DATA = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "plates-in-sand"


def quiet(_: str) -> None:
    pass


@pytest.fixture(scope="module", autouse=True)
def _short_loop() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("openbench.calibration.STEPS", 10_000)
        yield


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of the entry in plain Python on two cases."""
    out = tmp_path_factory.mktemp("runs")
    run("plain-python", command_of("plain-python", out), out, Asked(("01-plate", "02-edge")), quiet)
    return out


NONE = [0.0] * 12


def plate(name: str = "01-plate", **values: Any) -> str:
    return json.dumps({"openbench": "v1", "case": name, "values": values})


def test_fifty_lines_of_python_are_right(plain: Path) -> None:
    found = {each.case: each for each in score(plain)}
    assert found["01-plate"].error == pytest.approx(0.0, abs=1e-10)
    assert found["02-edge"].error == pytest.approx(0.0, abs=1e-4)
    assert found["02-edge"].spread == 0.0
    assert present(found["01-plate"].cost) > 0.0
    for name in ("01-plate", "02-edge"):
        written = json.loads((plain / "plain-python" / name / "result.json").read_text(encoding="utf-8"))
        jsonschema.validate(written, schema("result"))


def test_a_missing_case_is_reported(plain: Path) -> None:
    missing = [each for each in score(plain) if each.outcome == "missing"]
    assert len(missing) == 6
    words = "case 03-cycles is missing from the run of plain-python: run it, or let the program decline it"
    assert words in [each.problems[0] for each in missing]


def test_scores_are_the_same_again(plain: Path, tmp_path: Path) -> None:
    run("plain-python", command_of("plain-python", tmp_path), tmp_path, Asked(PLATE), quiet)
    first, second = (next(each for each in score(runs) if each.case == "01-plate") for runs in (plain, tmp_path))
    assert first.quantities == second.quantities


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (plate(force_kN=NONE, depth_m=None), "'force_kN'"),
        (plate(force_N=None, depth_mm=NONE), "'depth_mm'"),
        (plate(force_N=NONE), "'depth_m' is missing"),
        (plate(force_N=NONE[:-1], depth_m=None), "it has 11"),
        (plate(force_N=[float("nan")] * 12, depth_m=None), "nan at place 0"),
        (plate(force_N=["1"] * 12, depth_m=None), "'1' at place 0"),
        (plate("02-edge", force_N=None, depth_m=None), "'02-edge'"),
        ('{"openbench": "v1", "case": "01-plate", "values": {"force_N": [nan]}}', "is no JSON"),
        (plate(force_N=None, depth_m=None, colour_1=[1.0]), "'colour_1'"),
        ('{"openbench": "v1", "case": "01-plate"}', "'declined'"),
    ],
)
def test_a_fault_is_reported(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "result.json").write_text(text, encoding="utf-8")
    found = checking.problems(read_case("01-plate"), tmp_path / "result.json")
    assert any(words in each for each in found), found


def test_a_program_that_fails_is_reported_with_its_last_line(tmp_path: Path) -> None:
    command = [sys.executable, "-c", "raise SystemExit('no snow today')"]
    record = run("broken", command, tmp_path, Asked(PLATE), quiet)
    told = "; ".join(record["cases"]["01-plate"]["problems"])
    assert "result.json" in told and "with 1: " in told
    assert __main__.main(["score", str(tmp_path)]) == 1


def test_an_error_planted_in_an_answer_is_found(plain: Path, tmp_path: Path) -> None:
    """An angle in an answer that is off by one part in a hundred: a program that is right scores wrong."""
    cases = tmp_path / "cases"
    shutil.copytree(CASES, cases)
    answer = read_answer("01-plate")
    answer["values"]["force_N"][9] *= 1.01
    (cases / "01-plate" / "answer.json").write_text(json.dumps(answer), encoding="utf-8")
    right, wrong = (
        next(each for each in score(plain, cases=folder) if each.case == "01-plate") for folder in (CASES, cases)
    )
    assert wrong.error is not None
    assert present(right.error) < 1e-10
    assert wrong.quantities["force_N"] > 5e-3
    assert wrong.quantities["depth_m"] == right.quantities["depth_m"]


def test_error_and_spread_by_hand() -> None:
    assert error_of([3.0, 4.0], [0.0, 0.0], 10.0) == pytest.approx((25.0 / 2.0) ** 0.5 / 10.0)
    assert spread_of([1.0, 3.0, 5.0, 5.0], 2) == pytest.approx(0.5 * (2.0 / 2.0 + 0.0))


def test_table_says_what_was_not_done() -> None:
    scores = [
        scoring.Score("a", "01-plate", "done", 0.0123, 0.0, {}, None, 10.0, 1.0),
        scoring.Score("a", "02-edge", "declined: no edges"),
        scoring.Score("b", "01-plate", "done", 1e-4, 1e-3, {}, None, 2.0, 1.0),
        scoring.Score("b", "02-edge", "done", 0.5, 0.0, {}, 0.07, 3.0, 1.0),
    ]
    told = table.table(scores, {"a": 5.0, "b": 1.0})
    assert "| a | 1.2 % / 10 | declined | – | 5 |" in told
    assert "| b | ≤ 0.1 % / 2 | 50 % / 3 | 7 % | 1 |" in told
    assert table.reasons(scores) == "- a, 02-edge: declined: no edges\n"


def test_what_cannot_run_here_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("openbench.programs.find_spec", lambda _: None)
    monkeypatch.setattr("openbench.programs.compiler", lambda: None)
    assert "mujoco" in str(why_not("mujoco"))
    assert "gcc" in str(why_not("c"))
    assert why_not("plain-python") is None


@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_fifty_lines_of_c_are_right(tmp_path: Path) -> None:
    run("c", command_of("c", tmp_path / "build"), tmp_path / "runs", Asked(("01-plate", "08-crossing")), quiet)
    found = {each.case: each for each in score(tmp_path / "runs")}
    assert found["01-plate"].error == pytest.approx(0.0, abs=1e-12)
    assert found["08-crossing"].outcome == "declined: plates alone"


@pytest.mark.skipif(not DATA.exists(), reason="no ../shared")
def test_sand_is_split_and_nothing_held_back_is_shown() -> None:
    case = read_case("05-sand")
    shown, values = sand.split(case, DATA)
    assert {name: len(rows) for name, rows in shown.items()} == {
        "plates": 28, "held_back_plates": 35, "wheel": 108, "held_back_wheel": 81,
    }  # fmt: skip
    assert all("load_N" not in row for row in shown["held_back_plates"])
    assert all("side_force_N" not in row for row in shown["held_back_wheel"])
    assert (shown["plates"][0], values["load_N"][0]) == (
        {"diameter_m": 0.06, "depth_m": 0.010962, "load_N": 23.745},
        14.499,
    )
    assert sand.fingerprints(case, DATA) == read_answer("05-sand")["values_from"]["sha256"]
    jsonschema.validate(shown, schema("given"))


def test_data_that_are_not_there_are_reported(tmp_path: Path) -> None:
    with pytest.raises(OpenbenchError, match=r"level\.csv"):
        sand.split(read_case("05-sand"), tmp_path)


def test_no_run_and_no_case_are_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert __main__.main(["score", str(tmp_path)]) == 1
    assert "openbench run" in capsys.readouterr().err
    with pytest.raises(OpenbenchError, match="01-plate"):
        read_case("09-moon")


def assert_planted_errors_are_found(runs: Path) -> None:
    """Each quantity of each answer 5 % off in turn: the reference's error in it grows beyond 2 %."""
    for name in case_names():
        case, answer = read_case(name), read_answer(name)
        if "values" not in answer:
            continue
        written = json.loads((runs / "runs" / "numpy-reference" / name / "result.json").read_text(encoding="utf-8"))
        for key, row in answer["values"].items():
            planted = answer["values"] | {key: [1.05 * value for value in row]}
            before = scoring.score_case(case, answer, answer["values"], written["values"])[2][key]
            after = scoring.score_case(case, answer, planted, written["values"])[2][key]
            assert before < 0.01, (name, key)
            assert after > 0.02, (name, key)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in shipped() if name not in {"plain-python", "c"}])
def test_each_entry_runs_and_is_as_near_as_it_should_be(name: str, tmp_path: Path) -> None:
    """The two of hypoplastic snow within 2 %; an elastic foundation and a grid are off, and seen to be."""
    missing = why_not(name)
    if missing:
        pytest.skip(missing)
    data = DATA if DATA.exists() else None
    how = Asked(tuple(case_names()), data, limit_s=7200.0)
    run(name, command_of(name, tmp_path), tmp_path / "runs", how, quiet)
    found = {each.case: each for each in score(tmp_path / "runs", data=data)}
    assert not [each.problems for each in found.values() if each.problems]
    run(name, command_of(name, tmp_path), tmp_path / "again", Asked(AGAIN, limit_s=7200.0), quiet)
    again = {each.case: each.quantities for each in score(tmp_path / "again") if each.error is not None}
    for case, quantities in again.items():
        assert quantities == pytest.approx(found[case].quantities, rel=0.01)
    errors = {case: each.error for case, each in found.items() if each.error is not None and case != "05-sand"}
    if name == "numpy-reference":
        assert_planted_errors_are_found(tmp_path)
    if name in {"skisnow", "skisnow-fast", "numpy-reference", "mujoco"}:
        assert max(errors.values()) < 0.02, errors
    elif name == "elastic":
        assert errors["03-cycles"] > 0.5
        assert errors["01-plate"] > 0.1
    else:
        assert present(found["02-edge"].spread) > 0.005


@pytest.mark.slow
def test_twins_agree_within_the_uncertainty_that_is_reported(tmp_path: Path) -> None:
    """Both programs at their finest, again; each half of their difference from the answer."""
    from openbench.making.__main__ import FINEST, TWIN_CASES

    for name, command in FINEST.items():
        run(name, command, tmp_path, Asked(TWIN_CASES, limit_s=7200.0), quiet)
        for case in TWIN_CASES:
            answer = read_answer(case)
            values = json.loads((tmp_path / name / case / "result.json").read_text(encoding="utf-8"))["values"]
            for key, row in answer["values"].items():
                off = max(abs(a - b) for a, b in zip(values[key], row, strict=True))
                assert off <= 0.55 * answer["uncertainty"][key], (name, case, key)
