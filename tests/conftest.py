import gc
import os
import shutil
import signal

import compiled_code  # noqa: F401 - before what it keeps compiled
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


def pytest_collection_finish():
    gc.set_threshold(GARBAGE_THRESHOLD)
    gc.enable()


def pytest_collection_modifyitems(config, items):
    """Leave out what a usual run does not try; the first worker begins with what takes long."""
    if not IS_THOROUGH:
        kept = list(sample(items))
        known = set(kept)
        config.hook.pytest_deselected(items=[item for item in items if item not in known])
        items[:] = kept
    items.sort(key=lambda item: item.get_closest_marker("early") is None)


def pytest_unconfigure(config):
    """Remove what the processes of the run shared; the last one to end is the one that started the workers."""
    from shared_analyses import FOLDER

    if not hasattr(config, "workerinput"):
        shutil.rmtree(FOLDER, ignore_errors=True)
