"""How worker processes start."""

import sys
from pathlib import Path

import pytest

from skisnow._support.processes.starting import load_for_workers, worker_context

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each worker loads skisnow itself")


def test_a_worker_has_the_modules_of_its_parent_and_not_its_threads() -> None:
    context = worker_context()
    hears, tells = context.Pipe(duplex=False)
    script = "import sys, threading; tells.send((module in sys.modules, threading.active_count()))"
    process = context.Process(target=exec, args=(script, {"tells": tells, "module": worker_context.__module__}))
    process.start()
    assert hears.recv() == (True, 1)
    process.join()
    assert process.exitcode == 0


def test_what_workers_need_is_loaded_before_the_first_one() -> None:
    load_for_workers()
    children = [child for file in Path("/proc/self/task").glob("*/children") for child in file.read_text().split()]
    assert any("forkserver" in Path(f"/proc/{child}/cmdline").read_text() for child in children)
