"""Metadata and pinned requirements of the package."""

import re
import runpy
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.version import Version

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
LOCKS = {
    name: (ROOT / "requirements" / f"{name}.txt").read_text(encoding="utf-8")
    for name in ("build", "run", "dev", "tools")
}
TESTED = ("web", "pandas", "xarray", "racing")
"""Extras that the tests need."""
PYTHONS = ("3.11.7", "3.12.1", "3.13.0", "3.14.0")


def pins(name: str) -> list[Requirement]:
    return [Requirement(line.rstrip(" \\")) for line in LOCKS[name].splitlines() if not line.startswith(" ")]


def on_linux(python: str) -> dict[str, str]:
    short = ".".join(python.split(".")[:2])
    return {
        "python_version": short, "python_full_version": python, "sys_platform": "linux", "platform_system": "Linux",
        "os_name": "posix", "platform_machine": "x86_64", "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
    }  # fmt: skip


def chosen(name: str, python: str) -> dict[str, str]:
    """Package and version on this Python, each once."""
    of = [pin for pin in pins(name) if pin.marker is None or pin.marker.evaluate(on_linux(python))]
    versions = {bare(pin.name): str(pin.specifier).removeprefix("==") for pin in of}
    assert len(versions) == len(of)
    return versions


def bare(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def asked(*extras: str) -> Iterator[Requirement]:
    """What pyproject.toml asks for with these extras."""
    project = PROJECT["project"]
    lines = [*project["dependencies"], *(line for extra in extras for line in project["optional-dependencies"][extra])]
    yield from map(Requirement, lines)


def of_group(name: str) -> Iterator[Requirement]:
    """What a group of pyproject.toml asks for, and the groups that it includes."""
    for each in PROJECT["dependency-groups"][name]:
        if isinstance(each, str):
            yield Requirement(each)
        else:
            yield from of_group(each["include-group"])


@pytest.mark.parametrize("name", LOCKS)
def test_each_file_is_named_by_its_hashes_and_no_place(name: str) -> None:
    blocks = re.split(r"\n(?! )", LOCKS[name].rstrip("\n"))
    assert len(blocks) > 5
    form = r"[\w.-]+==[\w.!+]+( ; [^\\\n]+)?( \\\n    --hash=sha256:[0-9a-f]{64})+"
    assert [block.splitlines()[0] for block in blocks if not re.fullmatch(form, block)] == []


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize(("name", "extras", "groups"), [("run", ("web",), ()), ("dev", TESTED, ("dev",))])
def test_what_is_requested_is_locked(name: str, extras: tuple[str, ...], groups: tuple[str, ...], python: str) -> None:
    locked = chosen(name, python)
    in_groups = [each for group in groups for each in of_group(group)]
    build = [Requirement(line) for line in PROJECT["build-system"]["requires"]]
    missing = [
        str(each)
        for each in [*asked(*extras), *in_groups, *build]
        if not each.specifier.contains(locked.get(bare(each.name), "0"))
    ]
    assert missing == []


def test_what_builds_the_package_is_requested_in_one_way() -> None:
    lines = (ROOT / "requirements" / "build.in").read_text(encoding="utf-8").splitlines()
    asked_for = [line for line in lines if not line.startswith("#")]
    # CMake and Ninja are asked for by scikit-build-core, where the machine has none
    assert [line for line in asked_for if not line.startswith(("cmake", "ninja"))] == PROJECT["build-system"][
        "requires"
    ]


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("name", ["build", "run"])
def test_what_builds_and_runs_is_what_is_tested(name: str, python: str) -> None:
    found, dev = chosen(name, python), chosen("dev", python)
    assert {package: version for package, version in found.items() if dev.get(package) != version} == {}


def test_every_dependency_and_every_bound_is_explained() -> None:
    page = (ROOT / "docs" / "contributing.md").read_text(encoding="utf-8").lower()
    for each in [*asked(*TESTED, "posterior", "peers", "geotiff", "postgresql"), *of_group("dev")]:
        assert bare(each.name) in page.replace("_", "-"), each
        for bound in each.specifier:
            if bound.operator == "<":
                assert f"`{bare(each.name)}{bound}`" in page, each


def test_the_bill_of_materials_has_what_lies_inside_the_package() -> None:
    """One component more, on which the root depends, with the release that the page on dependencies says."""
    sbom = runpy.run_path(str(ROOT / "requirements" / "sbom.py"))
    bill = {
        "metadata": {"component": {"bom-ref": "root"}},
        "components": [{"name": "numpy"}],
        "dependencies": [{"ref": "numpy"}, {"ref": "root", "dependsOn": ["numpy"]}],
    }
    found = sbom["with_three_js"](bill)
    (ours,) = [each for each in found["dependencies"] if each["ref"] == "root"]
    three = found["components"][-1]
    assert ours["dependsOn"] == ["numpy", three["bom-ref"]]
    assert f"three.js r{Version(three['version']).minor} " in (ROOT / "docs" / "contributing.md").read_text(
        encoding="utf-8"
    )
    assert {file["name"].rsplit("/", 1)[1] for file in three["components"]} == {
        "three.core.min.js",
        "three.module.min.js",
    }


def text_of(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


PROVIDER = runpy.run_path(str(ROOT / "build_backend" / "pypi_readme.py"))


def test_pictures_and_links_of_the_index_page_lead_to_the_source() -> None:
    """No relative link is left, and each leads to a file of the repository, pictures to the file itself."""
    source, tag = "https://github.com/us/skisnow", f"v{PROJECT['project']['version']}"
    page = PROVIDER["absolute"](text_of("README.md"), source, PROJECT["project"]["version"])
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
    assert f"version: {PROJECT['project']['version']}\n" in citation
    address = re.search(r"^repository-code: (.*)$", citation.partition("references:")[0], re.MULTILINE)
    assert (address and address[1]) == PROJECT["project"].get("urls", {}).get("Source")


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
    assert all(f"{name}-latest" in workflow for name in ("ubuntu", "windows", "macos"))
    assert 'python: ["3.11", "3.14"]' in workflow
    assert all(word in workflow for word in ("cibuildwheel", "make lint", "make test-minimum"))
    makefile = text_of("Makefile")
    for target in re.findall(r"run: make ([\w-]+)", workflow):
        assert f"\n{target}: " in makefile
