"""Pages stay short and name what there is, their pictures exist and say in words what they show."""

import doctest
import importlib
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from skisnow.carving.question import CARVE_KEYS
from skisnow.cli.shell import NAMES
from skisnow.scenario.keys import SCENARIO_KEYS

from .page_text import INCLUDED

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = sorted(
    path.relative_to(DOCS).as_posix()
    for path in DOCS.rglob("*.md")
    if not {"_build", "_generated"} & set(path.relative_to(DOCS).parts)
)
MOST_WORDS = 1500
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")


def text_of(page: str) -> str:
    return (DOCS / page).read_text(encoding="utf-8")


def test_no_more_words_than_one_reads_at_a_time() -> None:
    """Tables, code, equations and marks are looked up, not read."""
    for page in PAGES:
        text = text_of(page)
        for block in (r"```.*?```", r"<!--.*?-->", r"\$\$.*?\$\$"):
            text = re.sub(block, "", text, flags=re.DOTALL)
        assert len(re.sub(r"^\|.*$", "", text, flags=re.MULTILINE).split()) <= MOST_WORDS, page


def test_pictures_exist_and_have_words() -> None:
    for page in PAGES:
        for words, place in PICTURE.findall(text_of(page)):
            assert words, place
            assert place.startswith("http") or (DOCS / page).parent.joinpath(place).exists(), place


def test_chart_of_the_benchmarks_has_every_row_with_a_goal() -> None:
    """A table by hand: 20 ms of 10 ms is twice the goal, 50 times real time of 100 as well."""
    chart: Any = importlib.import_module("figure_of_benchmarks")
    times = "what,time,goal\nslow,20 ms,10 ms\nquick,0.5 s,1 s\nfree,3 s,\n"
    speed = "run,times real time,to reach\ndefault,50,100 on 2 cores\n"
    named = "64 runs,default,fast,to reach (fast)\nsimulated seconds per second,10,40,80\n"
    found = {row.what: row.share for row in chart.rows([times, speed, named])}
    shares = {"slow": 2.0, "quick": 0.5, "turn: default": 2.0, "simulated seconds per second": 2.0}
    assert found == pytest.approx(shares)
    assert len(list(chart.rows(chart.page_tables()))) > 40


README = Path(__file__).resolve().parents[2] / "README.md"


def test_the_python_of_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    failures, tried = doctest.testfile(str(README), module_relative=False, encoding="utf-8")
    assert tried == 6
    assert failures == 0


def test_the_links_of_the_readme_lead_somewhere() -> None:
    import re

    targets = re.findall(r"\]\(([^)#]+)\)", README.read_text(encoding="utf-8"))
    missing = [target for target in targets if "://" not in target and not (README.parent / target).exists()]
    assert not missing


ROOT = Path(__file__).parents[2]


def test_the_layers_are_those_that_are_held() -> None:
    """Names and order of the contract, but for packages that are not built."""
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    told = next(block for block in re.findall(r"```\n(.*?)```", page, re.DOTALL) if "cli\n" in block)
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    layers = next(each for each in contracts["contracts"] if each["type"] == "layers")["layers"]
    source = ROOT / "src" / "skisnow"
    held = []
    for layer in layers:
        packages = [name.strip(" ()") for name in layer.split("|")]
        built = [name for name in packages if (source / name).is_dir() or (source / f"{name}.py").is_file()]
        if built:
            held.append(" | ".join(built))
    assert told.splitlines() == held


tables: Any = importlib.import_module("key_tables")


def test_the_build_writes_every_schema(tmp_path: Path) -> None:
    tables.write_schemas(tmp_path / "schemas")
    assert {path.name for path in (tmp_path / "schemas").iterdir()} == {f"{name}.schema.json" for name in NAMES}


def test_tables_have_a_row_for_each_key(tmp_path: Path) -> None:
    tables.write_tables(tmp_path / "tables")
    written = {path.stem: path.read_text(encoding="utf-8") for path in (tmp_path / "tables").iterdir()}
    assert all(f"`{key}`" in written["scenario"] for key in SCENARIO_KEYS)
    assert all(f"`{key}`" in written["carve"] for key in CARVE_KEYS)
    pages = "".join(path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md"))
    included = INCLUDED.findall(pages)
    assert sorted(included) == sorted(written)


def test_every_table_file_is_shown_on_its_page() -> None:
    shown = {
        (DOCS / page).parent / name
        for page in PAGES
        for name in re.findall(r"^:file: (\S+)$", text_of(page), re.MULTILINE)
    }
    assert shown == {*DOCS.glob("tables/*.csv"), *DOCS.glob("*/tables/*.csv")}
