"""Analyses that processes share: each system is analysed once per run, however many commands of the pages and tests analyse it.

An analysis is a function of a frozen system and frozen settings, so that one that was kept is as good as a new one. What would
shorten a latency is also a function of the text in which values are changed.
"""

import os
import pickle
import sys
from dataclasses import replace
from hashlib import sha256
from importlib import import_module
from io import BytesIO
from pathlib import Path
from tempfile import gettempdir

from amalthea_uros.metamodel.element import Element

_RUN = os.getppid() if "PYTEST_XDIST_WORKER" in os.environ else os.getpid()
#: The workers of a run have one folder, that of the process which started them, and so have the processes that they start.
FOLDER = Path(os.environ.setdefault("AMUROS_ANALYSES", str(Path(gettempdir(), f"amuros-analyses-{_RUN}"))))


def sharing(original, asked):
    """A function that takes results which are kept, and keeps new ones.

    Parameters
    ----------
    asked : what its result depends on, of its arguments
    """

    def shared(*arguments):
        elements = {}
        key = sha256(by_value((original.__name__, asked(*arguments)), elements)).hexdigest()
        kept = FOLDER / key
        if kept.exists():
            return unpickled(kept.read_bytes(), [element for _, element in elements.values()])
        result = original(*arguments)
        new = FOLDER / f"{key}-{os.getpid()}"
        new.write_bytes(pickled(result, elements))
        new.replace(kept)
        return result

    return shared


def of_a_system(system, settings=None):
    # A replaced system has no tables of names yet.
    return replace(system), settings


def of_improvements(analysis, explanation, offered=(), source=None):
    # The folder of a description matters by the files that it names, whose content is in the system.
    context, description = analysis.solution.context, source and replace(source, path=Path(source.path.name))
    return *of_a_system(context.system, context.settings), explanation.chain.name, explanation.quantity, offered, description


def by_value(asked, elements):
    """The bytes of equal objects, the same ones be a part of them one object or several, as after reading what was kept."""
    try:
        return pickled(asked, elements, is_fast=True)
    except ValueError:  # Objects of INCHRON's lead back to themselves.
        return pickled(asked, elements)


def pickled(found, elements, *, is_fast=False):
    """An object as bytes; the elements of models are their numbers in a table, which is filled.

    Parameters
    ----------
    is_fast : without looking for objects that occur several times
    """

    class Pickler(pickle.Pickler):
        def persistent_id(self, part):
            if not isinstance(part, Element):
                return None
            number, _ = elements.setdefault(id(part), (len(elements), part))
            return number

    stream = BytesIO()
    pickler = Pickler(stream)
    pickler.fast = is_fast
    pickler.dump(found)
    return stream.getvalue()


def unpickled(data, elements):
    class Unpickler(pickle.Unpickler):
        def persistent_load(self, number):
            return elements[number]

    return Unpickler(BytesIO(data)).load()


#: The module of each function that is shared, and what its results depend on.
FUNCTIONS = {
    "analyze_system": ("analyze.system", of_a_system),
    "improvements_of": ("design.improvements", of_improvements),
}


def share(patch=setattr):
    """Let all modules of this process share analyses with other processes."""
    FOLDER.mkdir(exist_ok=True)
    originals = {name: getattr(import_module(f"amalthea_uros.{module}"), name) for name, (module, _) in FUNCTIONS.items()}
    shared = {name: sharing(original, FUNCTIONS[name][1]) for name, original in originals.items()}
    for module in list(sys.modules.values()):
        names = getattr(module, "__dict__", {})
        for name, original in originals.items():
            if names.get(name) is original:
                patch(module, name, shared[name])
