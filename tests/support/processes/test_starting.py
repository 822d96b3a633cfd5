"""How worker processes start."""

import sys

import pytest

from skisnow._support.processes.starting import worker_context


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each worker loads skisnow itself")
def test_a_worker_has_the_modules_of_its_parent_and_not_its_threads() -> None:
    context = worker_context()
    hears, tells = context.Pipe(duplex=False)
    script = "import sys, threading; tells.send((module in sys.modules, threading.active_count()))"
    process = context.Process(target=exec, args=(script, {"tells": tells, "module": worker_context.__module__}))
    process.start()
    assert hears.recv() == (True, 1)
    process.join()
    assert process.exitcode == 0
