"""The command line as a user meets it."""

import inspect
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import jsonschema
import pytest

from skisnow.cli import build_parser, main
from skisnow.cli.shell import json_schema

from ..campaign.conftest import FILES

CHECK_SCHEMA = json_schema("check")


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    folder = tmp_path / "campaign"
    folder.mkdir()
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def files_below(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_check_of_a_good_campaign(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = files_below(campaign.parent)
    assert main(["check", str(campaign), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    jsonschema.validate(found, CHECK_SCHEMA)
    assert all(problem["severity"] == "flag" for problem in found["problems"])
    assert (found["errors"], found["warnings"], found["flags"]) == (0, 0, len(found["problems"]))
    assert files_below(campaign.parent) == before


def test_check_lists_every_error_and_exits_1(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = campaign / "penetration.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    column = lines[0].split(",").index("depth_mm")
    for row, cell in ((3, "-1"), (5, "deep")):
        cells = lines[row - 1].split(",")
        cells[column] = cell
        lines[row - 1] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert main(["check", str(campaign), "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    jsonschema.validate(found, CHECK_SCHEMA)
    errors = [(p["code"], p["row"], p["column"], p["value"]) for p in found["problems"] if p["severity"] == "error"]
    assert errors == [("out_of_range", 3, "depth_mm", "-1"), ("not_a_number", 5, "depth_mm", "deep")]
    assert found["errors"] == 2
    assert main(["check", str(campaign)]) == 1
    text = capsys.readouterr().out
    assert "row 3" in text and "depth_mm" in text
    assert "errors: 2" in text


def test_check_of_a_ski_file_says_what_checks_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ski = tmp_path / "mine.toml"
    ski.write_text('name = "mine"\n', encoding="utf-8")
    assert main(["check", str(ski)]) == 1
    assert "carve --ski FILE" in capsys.readouterr().out
    assert main(["check", str(tmp_path / "nowhere")]) == 1
    assert "carve --ski" not in capsys.readouterr().out


def test_a_campaign_with_errors_is_rejected(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (campaign / "shear.csv").write_bytes(b"")
    assert main(["analyse", str(campaign), "--out", str(tmp_path / "out"), "--json"]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "empty_file" in printed.err
    assert not (tmp_path / "out").exists()


def test_analyse_without_out_prints_json(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = files_below(tmp_path)
    assert main(["analyse", str(campaign), "--json", "--resamples", "100", "--seed", "7"]) == 0
    results = json.loads(capsys.readouterr().out)
    assert results["provenance"]["seed"] == 7
    assert results["provenance"]["options"] == {"geometry": "extended", "n_resamples": 100, "difference_percent": 20.0}
    assert files_below(tmp_path) == before


@pytest.mark.usefixtures("undrawn")
def test_analyse_writes_the_report(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["analyse", str(campaign), "--out", str(out), "--resamples", "100", "--geometry", "paper"]) == 0
    assert "H_V" in capsys.readouterr().out
    written = files_below(out)
    assert {"results.json", "report.html"} <= written
    assert any(name.endswith(".svg") for name in written)
    assert any(name.startswith("tables/") for name in written)
    assert not [name for name in written if "partial" in name]
    results = json.loads((out / "results.json").read_text(encoding="utf-8"))
    assert results["provenance"]["options"]["geometry"] == "paper"


def test_reference_never_overwrites(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (campaign / "penetration.csv").read_bytes()
    assert main(["reference", str(campaign), "--seed", "4"]) == 1
    assert "campaign" in capsys.readouterr().err
    assert (campaign / "penetration.csv").read_bytes() == before


def test_no_words_print_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("usage: skisnow")
    assert "simulate" in printed


CARVE = ["carve", "--ski", "slalom", "--edge-angle-deg", "45", "--load-N", "800"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["simlate", "carved-46m"], "'simulate'"),
        (["store", "vrify"], "'verify'"),
        (["new", "campain", "x"], "'campaign'"),
        (["xxxxxxx"], "'simulate'"),
        (["simulate"], "--list names them"),
        (["simulate", "carved-46m", "--replay"], "--out"),
        (["export", "fmu", "carved-46m", "--out", "sledge.zip", "--skis", "1"], "--contact"),
        (["identify", "carved-46m", "cells.csv", "--free", "mu_0", "--resume"], "--out"),
        (["compare", "a", "b", "--slope-angle-deg", "10"], "--fall-line-azimuth-deg"),
        (["replay", "far/run", "--out", "far/film.HTML"], "--out far"),
        (["replay", "nowhere", "--starts-at-s", "2"], "--track"),
        (["replay", "nowhere", "--starts-at-s", "36001"], "from -36000 to 36000"),
        (["carve"], "--ski"),
        (["carve", *CARVE[3:]], "--ski"),
        ([*CARVE, "--groove", "sideways"], "'sideways'"),
        ([*CARVE, "--edge-angel-deg", "45"], " --edge-angle-deg?"),
        ([*CARVE, "--h-v-n-per-mm3=0.2"], " --H-V-N-per-mm3?"),
        ([*CARVE, "--colour", "red"], "--help"),
        ([*CARVE, "--load-N", "80kg"], " as 80\n"),
        ([*CARVE, "--H-V-N-per-mm3", "0,2"], " as 0.2\n"),
        ([*CARVE, "--unloading-ratio", "ten"], "'ten'"),
        ([*CARVE, "--elements", "8.5"], "'8.5'"),
        *((words.split(), "usage") for words in ("store", "no-such-command", "analyse", "analyse x --geometry flat")),
    ],
)
def test_wrong_words_exit_2(words: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(words)
    assert stop.value.code == 2
    assert told in capsys.readouterr().err


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys, skisnow.cli\n"
        "for words in ['--help'], ['store', '--help'], ['carve', '--help']:\n"
        "    try: skisnow.cli.main(words)\n"
        "    except SystemExit: pass\n"
        "unwanted = 'skisnow.compiled numpy scipy matplotlib sqlalchemy alembic jinja2'.split()\n"
        "heavy = set(unwanted) & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, env=os.environ)
    assert done.returncode == 0, done.stderr


def test_a_place_that_cannot_be_written(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file stands where the folder should be."""
    (tmp_path / "out").write_text("a file", encoding="utf-8")
    assert main(["analyse", str(campaign), "--out", str(tmp_path / "out"), "--resamples", "100"]) == 1
    assert "cannot be written" in capsys.readouterr().err
    assert (tmp_path / "out").read_text(encoding="utf-8") == "a file"


@pytest.mark.parametrize(
    ("words", "allowed"),
    [
        *((["analyse", "x", "--seed", seed], "whole number") for seed in ("-1", "1.5", "x", f"{2**63}")),
        (["analyse", "x", "--resamples", "0"], "100 to 100000"),
        (["analyse", "x", "--resamples", "9" * 20], "100 to 100000"),
        (["analyse", "x", "--resamples", "9" * 5000], "whole number"),
        (["serve", "--port", "99999"], "0 to 65535"),
        (["serve", "--port", "-1"], "0 to 65535"),
        (["study", "x", "--workers", "0"], "1 to 256"),
        (["identify", "x", "y", "--workers", "1000000"], "1 to 256"),
        (["identify", "x", "y", "--bootstrap", "39"], "40 to 100000"),
        (["identify", "x", "y", "--posterior", "-1"], "0 to 1000000"),
        (["identify", "x", "y", "--starts", "0"], "1 to 1000"),
        (["track", "x", "--window-s", "0"], "above 0 to 86400"),
        (["track", "x", "--noise-m", "nan"], "above 0 to 1000"),
        (["compare", "x", "y", "--slope-angle-deg", "76"], "from 0 to 75"),
        (["compare", "x", "y", "--fall-line-azimuth-deg=-1e9"], "from -360 to 360"),
    ],
)
def test_numbers_out_of_range_are_rejected(words: list[str], allowed: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(words)
    assert stop.value.code == 2
    said = " ".join(capsys.readouterr().err.split())
    option = next(word for word in words if word.startswith("--")).split("=")[0]
    assert allowed in said and option in said
    assert len(said) < 4000


def test_a_load_that_is_no_quantity_is_rejected(capsys: pytest.CaptureFixture[str]) -> None:
    words = "carve --ski slalom --edge-angle-deg 45 --published race-piste --unloading-ratio 10 --load-N 1e-320"
    assert main(words.split()) == 1
    told = "load_N is 1e-320, not a quantity; allowed are 0 and sizes from 1e-100 to 1e+100"
    assert told in capsys.readouterr().err


def replace_check(monkeypatch: pytest.MonkeyPatch, run: Callable[[object], int]) -> None:
    """Replace the command `check`, in a parser built for this test."""
    monkeypatch.setattr("skisnow.cli.campaign.check", run)
    monkeypatch.setattr("skisnow.cli.build_parser", inspect.unwrap(build_parser))


class TestLastResort:
    @pytest.fixture(autouse=True)
    def broken(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def run(_: object) -> int:
            raise ZeroDivisionError("an unforeseen error\nsecond line")

        replace_check(monkeypatch, run)

    def test_the_trace_and_a_sentence(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["check", "x"]) == 70
        lines = capsys.readouterr().err.splitlines()
        assert lines[0].startswith("Traceback")
        assert "ZeroDivisionError: an unforeseen error" in lines
        assert lines[-1].startswith("skisnow: ")


def test_too_little_memory_is_a_sentence(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def run(_: object) -> int:
        raise MemoryError

    replace_check(monkeypatch, run)
    assert main(["check", "x"]) == 1
    assert "memory" in capsys.readouterr().err


def run_program(*words: str, encoding: str = "utf-8", stdout: int | IO[bytes] = subprocess.PIPE) -> Any:
    environment = {**os.environ, "PYTHONIOENCODING": encoding}
    command = [sys.executable, "-m", "skisnow", *words]
    return subprocess.run(command, env=environment, stdout=stdout, stderr=subprocess.PIPE, check=False)


def test_json_is_utf_8_whatever_the_terminal(campaign: Path) -> None:
    toml = campaign / "campaign.toml"
    toml.write_text(toml.read_text(encoding="utf-8").replace("place = ", 'place = "Kühtai ϑ" # ', 1), encoding="utf-8")
    done = run_program("analyse", str(campaign), "--json", "--resamples", "100", encoding="ascii")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.decode("utf-8"))["campaign"]["place"] == "Kühtai ϑ"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_full_disk_behind_stdout_is_a_sentence() -> None:
    with Path("/dev/full").open("wb") as full:
        done = run_program("schema", "campaign", stdout=full)
    assert done.returncode == 1
    *before, last = done.stderr.decode("utf-8").splitlines()
    assert last.startswith("skisnow: No space")
    assert not [line for line in before if "skisnow" in line or "Traceback" in line]  # progress, on a busy machine


@pytest.mark.usefixtures("undrawn")
def test_an_interrupted_rewrite_keeps_reports(campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    assert main(["analyse", str(campaign), "--out", str(out), "--resamples", "100"]) == 0
    before = {name: (out / name).read_bytes() for name in files_below(out)}

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("skisnow.report.campaign.page.page", interrupted)
    words = ["analyse", str(campaign), "--out", str(out), "--resamples", "100", "--geometry", "paper", "--seed", "9"]
    assert main(words) == 130
    assert {name: (out / name).read_bytes() for name in files_below(out)} == before


def test_the_reference_campaign_has_a_seed_of_its_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reference", str(tmp_path / "a")]) == 0
    printed = capsys.readouterr().out
    assert "ynthetic" in printed and "seed 1" in printed
    assert main(["reference", str(tmp_path / "b"), "--seed", "1"]) == 0
    same = [(tmp_path / name / "penetration.csv").read_bytes() for name in ("a", "b")]
    assert same[0] == same[1]
