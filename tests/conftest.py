"""What tests of several packages need."""

import functools
import gc
import os
import signal
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import pytest
from _pytest.doctest import DoctestItem, DoctestModule

# read when NumPy is loaded: small matrices in several threads wait for each other longer than they compute, and two
# processes test at once
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from build_backend.messages import compile_changed

from skisnow._support.errors import SkisnowError

if TYPE_CHECKING:
    from skisnow.report.figures.drawing import Drawing, Form

# what is collected stays until the end: looking for garbage among it takes four tenths of the collection
gc.disable()

# what is started in the background is told to ignore Ctrl-C, which tests of an interrupt would wait for
signal.signal(signal.SIGINT, signal.default_int_handler)

# translations that were edited since the package was built
compile_changed()


class FilesWithExamples:
    """Search modules for examples only if their text contains one: the search through all takes 3 s per process."""

    @pytest.hookimpl(wrapper=True)
    def pytest_collect_file(self, file_path: Path) -> Generator[None, list[pytest.Collector], list[pytest.Collector]]:
        collectors = yield
        return [each for each in collectors if not isinstance(each, DoctestModule) or b">>> " in file_path.read_bytes()]


def pytest_configure(config: pytest.Config) -> None:
    """Register what applies to src and docs, too."""
    config.pluginmanager.register(FilesWithExamples())
    start_in_another_folder(config)


def start_in_another_folder(config: pytest.Config) -> None:
    """Let each worker begin the collection in another folder of tests, if all are collected.

    In a new checkout pytest compiles every test module, which takes half of the collection. A worker reuses the
    modules that another one has compiled; if all began in the same folder, each would compile all of them.
    """
    worker: dict[str, Any] | None = getattr(config, "workerinput", None)
    if worker is None or config.args_source is not pytest.Config.ArgsSource.TESTPATHS:
        return
    tests = Path(__file__).parent
    entries = {path.relative_to(tests).parts[0] for path in tests.rglob("test_*.py")}
    places = [str(tests / entry) for entry in sorted(entries)]
    places += [name for name in config.getini("testpaths") if name != tests.name]
    first = len(places) * int(worker["workerid"].removeprefix("gw")) // int(worker["workercount"])
    config.args = places[first:] + places[:first]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what drives a browser, and begin with pages and files that wait for a server or a browser.

    The first worker gets them with the server and the browser that they share, and computing of others fills the waits.
    """
    waiting = set()
    for item in items:
        fixtures = {*getattr(item, "fixturenames", ())}
        if "chromium" in fixtures:
            item.add_marker(pytest.mark.browser)
        if (isinstance(item, DoctestItem) and item.path.suffix == ".md") or fixtures & {"chromium", "served"}:
            waiting.add(item.path)
    items.sort(key=lambda item: (item.path not in waiting, item.path))


def pytest_collection_finish() -> None:
    """Keep what tests share. Collect garbage only in objects made after this, and less often: it took 3 to 8 %."""
    # kept for all tests of a process: a command builds its parser, and a page compiles its templates, in some 10 ms
    from skisnow import cli
    from skisnow.report import sheet

    patch.object(cli, "build_parser", functools.cache(cli.build_parser)).start()
    patch.object(sheet, "_page_environment", functools.cache(sheet._page_environment)).start()
    gc.freeze()
    gc.set_threshold(50_000, 10, 10)
    gc.enable()


@pytest.fixture
def noted_errors(monkeypatch: pytest.MonkeyPatch) -> list[SkisnowError]:
    """Errors of skisnow in the order in which they are made: where only their text arrives, tests assert the code."""
    errors: list[SkisnowError] = []
    begin = SkisnowError.__init__

    def noted(error: SkisnowError, *given: Any, **named: Any) -> None:
        begin(error, *given, **named)
        errors.append(error)

    monkeypatch.setattr(SkisnowError, "__init__", noted)
    return errors


@pytest.fixture
def undrawn() -> Iterator[None]:
    """Empty pictures instead of figures."""
    with without_figures():
        yield


@contextmanager
def without_figures() -> Iterator[None]:
    """An empty picture, each another, in place of every figure: a figure takes a second, and these tests read words."""
    from matplotlib.figure import Figure

    from skisnow.report.figures.drawing import Picture
    from skisnow.report.run import drawings

    blank = {name: each._replace(draw=lambda _: Figure()) for name, each in drawings._FIGURES.items()}
    number = count()

    def empty(drawing: "Drawing") -> Picture:
        svg = f'<svg xmlns="http://www.w3.org/2000/svg"><!-- {next(number)} --></svg>'
        each = svg.encode()
        return Picture(drawing.name, drawing.whole_caption, drawing.alt, drawing.wide, svg, each, each)

    with patch("skisnow.report.figures.drawing.render", empty), patch.dict(drawings._FIGURES, blank):
        yield


@contextmanager
def without_png() -> Iterator[None]:
    """PNG and PDF take most of a figure's time: for tests of what SVG and words say."""
    with only_drawn("svg"):
        yield


@contextmanager
def only_drawn(*forms: "Form") -> Iterator[None]:
    """Pictures in these forms; the others are empty files."""
    from skisnow.report.figures import drawing as figure_drawing

    drawn_as = figure_drawing._render_as

    def drawn(form: "Form", drawing: "Drawing") -> bytes:
        return drawn_as(form, drawing) if form in forms else b""

    with patch.object(figure_drawing, "_render_as", drawn):
        yield


@pytest.fixture
def svg_alone() -> Iterator[None]:
    """Empty files in place of PNGs."""
    with without_png():
        yield
