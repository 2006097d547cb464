import gc
import os
import shutil
import signal
import sys
from contextlib import suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import compiled_code  # noqa: F401 - before what it keeps compiled
import pytest
from effort import IS_THOROUGH, PROFILE, THOROUGH, USUAL, sample
from hypothesis import HealthCheck, Phase, settings

from amalthea_uros.cli.process import GARBAGE_THRESHOLD

settings.register_profile(
    "default",
    deadline=None,
    max_examples=USUAL,
    # A part of the examples can be filtered out by chance.
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    # Shrinking a whole model takes minutes and makes it no easier to read.
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
)
settings.register_profile("ci", settings.get_profile("default"), derandomize=True)
settings.register_profile("thorough", settings.get_profile("default"), max_examples=THOROUGH)
settings.load_profile(PROFILE)

# Programs that a shell starts in the background ignore Ctrl-C, and so would all that the tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Colours and widths are what their tests ask for; Python's `readline` states the size of a terminal for the workers.
for name in ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "LINES"):
    os.environ.pop(name, None)


# Collecting tests makes many objects and no garbage. Later, garbage is collected as rarely as by the command. The objects are not
# frozen: whoever reads a model counts frozen objects, which takes 40 ms for those of all tests.
gc.disable()


def pytest_sessionstart(session):
    """Let the second worker import all tests from the last one on: each compiles what the other one has not yet compiled."""
    config = session.config
    if os.environ.get("PYTEST_XDIST_WORKER") == "gw1" and config.args == config.getini("testpaths"):
        for path in sorted(Path(__file__).parent.rglob("test_*.py"), reverse=True):
            if sys.path[0] != str(path.parent):
                sys.path.insert(0, str(path.parent))
            with suppress(pytest.skip.Exception):
                import_module(path.stem)


def pytest_collection_finish():
    gc.set_threshold(GARBAGE_THRESHOLD)
    gc.enable()


@pytest.fixture(autouse=True, scope="session")
def young_garbage():
    """A campaign ends with a collection of garbage, which takes a second for the objects of all tests; its own ones are young."""
    from amalthea_uros.design.campaign import executors

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(executors, "gc", SimpleNamespace(collect=partial(gc.collect, 1)))
        yield


def pytest_collection_modifyitems(config, items):
    """Leave out what a usual run does not try; the first worker begins with what takes long."""
    if not IS_THOROUGH:
        kept = list(sample(items))
        known = set(kept)
        config.hook.pytest_deselected(items=[item for item in items if item not in known])
        items[:] = kept
    items.sort(key=lambda item: item.get_closest_marker("early") is None)


def pytest_sessionfinish():
    """Let pytest search no garbage, five times among all objects, in a process that ends."""
    gc.freeze()


def pytest_unconfigure(config):
    """Remove what the processes of the run shared; the last one to end is the one that started the workers."""
    from shared_analyses import FOLDER

    if not hasattr(config, "workerinput"):
        shutil.rmtree(FOLDER, ignore_errors=True)
