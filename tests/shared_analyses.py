"""Analyses that processes share: each system is analysed once per run, however many commands of the pages and tests analyse it.

An analysis is a function of a frozen system and frozen settings, so that one that was kept is as good as a new one.
"""

import os
import pickle
import sys
from hashlib import sha256
from importlib import import_module
from io import BytesIO
from pathlib import Path
from tempfile import gettempdir

from amalthea_uros.metamodel.element import Element

#: The workers of a run have one folder, that of the process which started them.
FOLDER = Path(gettempdir(), f"amuros-analyses-{os.getppid() if 'PYTEST_XDIST_WORKER' in os.environ else os.getpid()}")


def sharing(original):
    """The function `analyze_system`, which takes analyses that are kept, and keeps new ones."""

    def analyze_system(system, settings=None):
        elements = {}
        key = sha256(pickled((system, settings), elements)).hexdigest()
        kept = FOLDER / key
        if kept.exists():
            return unpickled(kept.read_bytes(), [element for _, element in elements.values()])
        analysis = original(system, settings)
        new = FOLDER / f"{key}-{os.getpid()}"
        new.write_bytes(pickled(analysis, elements))
        new.replace(kept)
        return analysis

    return analyze_system


def pickled(found, elements):
    """An object as bytes; the elements of models are their numbers in a table, which is filled."""

    class Pickler(pickle.Pickler):
        def persistent_id(self, part):
            if not isinstance(part, Element):
                return None
            number, _ = elements.setdefault(id(part), (len(elements), part))
            return number

    stream = BytesIO()
    Pickler(stream).dump(found)
    return stream.getvalue()


def unpickled(data, elements):
    class Unpickler(pickle.Unpickler):
        def persistent_load(self, number):
            return elements[number]

    return Unpickler(BytesIO(data)).load()


def share(patch=setattr):
    """Let all modules of this process share analyses with other processes."""
    FOLDER.mkdir(exist_ok=True)
    original = import_module("amalthea_uros.analyze.system").analyze_system
    shared = sharing(original)
    for module in list(sys.modules.values()):
        if getattr(module, "__dict__", {}).get("analyze_system") is original:
            patch(module, "analyze_system", shared)
