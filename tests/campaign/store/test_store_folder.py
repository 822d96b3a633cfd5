"""Names of campaigns and paths that are safe to write."""

from pathlib import Path

import pytest

from skisnow.campaign.store.folder import FileState, campaign_name, changed_files, unsafe_because


@pytest.mark.parametrize(
    ("raw", "name"),
    [
        ('name = "Sölden"'.encode(), "Sölden"),
        ("\ufeffname = 'Sölden'\r\n".encode(), "Sölden"),
        ('name = "Sölden"'.encode("utf-16"), "Sölden"),
        ('name = "Sölden"'.encode("cp1252"), "Sölden"),
        (b'name = """\n two\n\tlines """', "two lines"),
        (b'name = "  "', "the folder"),
        (b"name = 3", "the folder"),
        (b"place = 'x'", "the folder"),
        (b"name = ", "the folder"),
        (b"\xff\xfe\x00", "the folder"),
        (b"\x00\x01\x02", "the folder"),
    ],
)
def test_name(raw: bytes, name: str, tmp_path: Path) -> None:
    folder = tmp_path / "the folder"
    folder.mkdir()
    assert campaign_name(folder) == "the folder"
    (folder / "campaign.toml").write_bytes(raw)
    assert campaign_name(folder) == name


@pytest.mark.parametrize("path", ["a", "a/b.csv", "...", "a b/ä", "back\\slash", "nul", "end.", "q?", "1:2"])
def test_paths_that_are_safe_here(path: str) -> None:
    assert unsafe_because(path, for_windows=False) is None


@pytest.mark.parametrize(
    "path", ["", ".", "..", "/", "/a", "//a", "a//b", "a/", "a/../b", "./a", "C:", "c:/a", "z:a", "a\0b", "\udcff"]
)
@pytest.mark.parametrize("for_windows", [False, True])
def test_paths_that_are_safe_nowhere(path: str, for_windows: bool) -> None:
    assert unsafe_because(path, for_windows=for_windows) is not None


@pytest.mark.parametrize(
    "path",
    [
        "nul",
        "NUL.txt",
        "a/Com1",
        "lpt9.csv",
        "COM¹",
        "con .txt",
        "CONIN$",
        "a./b",
        "a ",
        "q?",
        "ab:c",
        "a\\b",
        "a\tb",
        "a|b",
    ],
)
def test_paths_that_windows_forbids(path: str) -> None:
    assert unsafe_because(path, for_windows=True)


@pytest.mark.parametrize("path", ["null", "com10", "console.csv", "a.nul", ".hidden", "a.b/c d", "com", "ünï"])
def test_paths_that_windows_allows(path: str) -> None:
    assert unsafe_because(path, for_windows=True) is None


def test_changes_between_listings() -> None:
    before = {"same": FileState(1, 1), "grown": FileState(1, 1), "touched": FileState(1, 1), "went": FileState(1, 1)}
    after = {"same": FileState(1, 1), "grown": FileState(2, 1), "touched": FileState(1, 2), "came": FileState(1, 1)}
    assert changed_files(before, after) == ["came", "grown", "touched", "went"]
