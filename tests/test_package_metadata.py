"""What the package says of itself outside: the page on the index, the citation, the paper, the workflow."""

from __future__ import annotations

import re
import runpy
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def text_of(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


PROVIDER = runpy.run_path(str(ROOT / "build_backend" / "pypi_readme.py"))


def test_pictures_and_links_of_the_index_page_lead_to_the_source() -> None:
    """No relative link is left, and each leads to a file of the repository, pictures to the file itself."""
    source, tag = "https://github.com/us/skisnow", f"v{PROJECT['version']}"
    page = PROVIDER["absolute"](text_of("README.md"), source, PROJECT["version"])
    targets = re.findall(r"(!?)\[[^\]]*\]\(([^)]+)\)", page)
    assert len(targets) > 15
    for picture, target in targets:
        start = (
            f"{source.replace('github.com', 'raw.githubusercontent.com')}/{tag}/"
            if picture
            else f"{source}/blob/{tag}/"
        )
        assert target.startswith(start), target
        assert (ROOT / target.removeprefix(start).partition("#")[0]).exists(), target


def test_the_index_page_has_no_relative_links() -> None:
    page = PROVIDER["dynamic_metadata"]("readme")["text"]
    targets = re.findall(r"\]\(([^)]+)\)", page)
    assert all(target.startswith(("https://", "#")) for target in targets)


def test_version_and_address_are_the_same_everywhere() -> None:
    citation = text_of("CITATION.cff")
    assert f"version: {PROJECT['version']}\n" in citation
    address = re.search(r"^repository-code: (.*)$", citation.partition("references:")[0], re.MULTILINE)
    assert (address and address[1]) == PROJECT.get("urls", {}).get("Source")


def test_paper_cites_what_its_bibliography_has() -> None:
    paper, bibliography = text_of("paper/paper.md"), text_of("paper/paper.bib")
    cited = set(re.findall(r"@(\w+)", paper.partition("---\n\n#")[2]))
    assert cited == set(re.findall(r"^@\w+\{(\w+),", bibliography, re.MULTILINE))


def test_paper_is_as_long_as_its_journal_asks() -> None:
    """250 to 1,500 words, with a summary and a statement of need."""
    body = text_of("paper/paper.md").partition("---\n\n#")[2]
    assert 250 <= len(body.split()) <= 1500
    assert "# Statement of need" in body


def test_workflow_runs_what_was_promised() -> None:
    workflow = text_of(".github/workflows/ci.yml")
    assert "os: [ubuntu-latest, windows-latest, macos-latest]" in workflow
    assert 'python: ["3.11", "3.14"]' in workflow
    assert all(word in workflow for word in ("cibuildwheel", "make lint", "make test-minimum"))
    makefile = text_of("Makefile")
    for target in re.findall(r"run: make ([\w-]+)", workflow):
        assert f"\n{target}: " in makefile
