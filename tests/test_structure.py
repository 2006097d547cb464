"""How the code stays small and clear: lines of a room, imports of a file, one owner of a class name, folders without circles.

A change may raise a limit of a table below only on purpose: for a capability that cannot be had by changing or removing what is there.
"""

import ast
import re
from collections import Counter, defaultdict
from functools import cache
from typing import NamedTuple

import networkx as nx
import pytest
from draw_rooms import PACKAGE, circles, module_imports, room_of
from support import ROOT

#: Room -> lines of code at most: neither blank lines nor comments nor docstrings.
LINES = {
    "__init__": 258,
    "__main__": 3,
    "_internal": 1267,
    "_version": 1,
    "am": 2,
    "analyze": 9335,
    "bridge": 2950,
    "cli": 2607,
    "compare": 3841,
    "design": 6724,
    "diagnostics": 43,
    "difference": 790,
    "editor": 653,
    "errors": 13,
    "executors": 2568,
    "findings": 535,
    "inchron": 538,
    "inchron_bridge": 3349,
    "judge": 613,
    "measure": 1140,
    "metamodel": 3388,
    "names": 17,
    "perf": 1838,
    "platforms": 0,
    "report": 8707,
    "services": 2716,
    "simulate": 8627,
    "source": 3719,
    "spec": 3026,
    "timing": 5821,
    "trace": 4785,
    "units": 210,
    "uros": 7878,
    "validate": 3268,
    "xmi": 8641,
}

#: Files may import from this many modules at most; those of the table do so still, and none more.
IMPORTS = 25
MORE_IMPORTS = {
    "analyze/response_times/propagation.py": 26,
    "cli/compare.py": 26,
    "cli/output.py": 26,
    "compare/calibration/calibration.py": 26,
    "report/records.py": 33,
    "services/analyze.py": 30,
    "services/check.py": 29,
    "services/report.py": 31,
    "services/simulate.py": 31,
    "timing/context.py": 28,
}
#: The public interface imports what it exports.
WITHOUT_LIMIT = {f"{PACKAGE}/__init__.py"}

#: The classes of a modelling language have the names of that language.
LANGUAGES = (f"{PACKAGE}/metamodel/classes",)

#: Rooms whose folders still import each other.
CIRCULAR: set[str] = set()

#: A tag of HTML, a row or a fence of Markdown.
IS_MARKUP = re.compile(r"</?(?:b|br|code|details|div|h[1-6]|li|p|pre|span|strong|t[dhr]|table|ul)\b[^>]*>|\| ?-{3}|\*\*\w|```")
#: Editors show Markdown; notebooks say below a table how many rows are left out.
MARKUP = {"editor/hover.py", "report/notebook.py"}

#: Each for callers that act differently.
EXCEPTIONS = {
    "AmurosError",
    "EndedError",
    "FileError",
    "InvalidArgumentError",
    "ReadError",
    "UnknownError",
    "UnlinkedError",
    "UnraisedError",
    "UnreadableError",
    "WriteError",
    "WrongValueError",
}


def files():
    """Each file of the package."""
    return sorted((ROOT / PACKAGE).rglob("*.py"))


def name_of(path):
    return str(path.relative_to(ROOT))


def room_of_file(path):
    return path.relative_to(ROOT / PACKAGE).parts[0].removesuffix(".py")


class Structure(NamedTuple):
    """What the tests ask of a file; its tree would be kept for nothing."""

    #: Those that are neither blank nor a comment nor part of a docstring.
    lines: int
    #: The modules from which it imports anywhere.
    imports: frozenset[str]
    #: Class -> its bases, of the classes that are in no other one.
    classes: dict[str, list[str]]
    #: Whether a text of it, other than a docstring, has markup.
    has_markup: bool


@cache
def structure(path):
    source = path.read_text(encoding="utf-8")
    tree = ast.parse(source)
    without, modules, texts = set(), set(), []
    for node in ast.walk(tree):
        match node:
            case ast.Expr(value=ast.Constant(value=str())):
                without.update(range(node.lineno, node.end_lineno + 1))
            case ast.Constant(value=str(text)) if node.lineno not in without:
                texts.append(text)
            case ast.ImportFrom(module=module):
                modules.add(module)
            case ast.Import(names=names):
                modules.update(alias.name for alias in names)
    lines = (line.strip() for number, line in enumerate(source.splitlines(), 1) if number not in without)
    classes = {node.name: [ast.unparse(base) for base in node.bases] for node in tree.body if isinstance(node, ast.ClassDef)}
    count = sum(1 for line in lines if line and not line.startswith("#"))
    return Structure(count, frozenset(modules), classes, any(map(IS_MARKUP.search, texts)))


def test_no_room_grows_unnoticed():
    counts = Counter()
    for path in files():
        counts[room_of_file(path)] += structure(path).lines
    assert {room: count for room, count in counts.items() if count > LINES.get(room, 0)} == {}


@pytest.mark.parametrize("room", sorted({room_of_file(path) for path in files()}))
def test_no_limit_is_far_above_what_a_room_has(room):
    count = sum(structure(path).lines for path in files() if room_of_file(path) == room)
    assert LINES[room] <= count + max(40, count // 20)


def test_no_file_imports_from_too_many_modules():
    counts = {name_of(path): len(structure(path).imports) for path in files() if name_of(path) not in WITHOUT_LIMIT}
    allowed = {f"{PACKAGE}/{name}": count for name, count in MORE_IMPORTS.items()}
    assert {name: count for name, count in counts.items() if count > IMPORTS} == allowed


def test_a_class_name_exists_once():
    owners = defaultdict(list)
    for path in files():
        if not name_of(path).startswith(LANGUAGES):
            for name in structure(path).classes:
                owners[name.lstrip("_")].append(name_of(path))
    assert {name: paths for name, paths in owners.items() if len(paths) > 1} == {}


def test_exceptions_are_few():
    bases = {name: parents for path in files() for name, parents in structure(path).classes.items()}
    found = set()

    def is_exception(name):
        return name.endswith(("Exception", "Error")) if name not in bases else any(is_exception(base) for base in bases[name])

    for name in bases:
        if any(is_exception(base) for base in bases[name]):
            found.add(name)
    assert found == EXCEPTIONS


def test_only_writers_make_markup():
    # A result is described once, by a document; HTML, Markdown and tables of text follow from that.
    makers = (f"{PACKAGE}/report/writers/", f"{PACKAGE}/report/pictures/")
    found = {name_of(path) for path in files() if not name_of(path).startswith(makers) and structure(path).has_markup}
    assert found == {f"{PACKAGE}/{name}" for name in MARKUP}
    assert structure(ROOT / PACKAGE / "report" / "writers" / "fragment.py").has_markup


@pytest.mark.parametrize("folder", ["basics", "documents", "fields", "wording"])
def test_what_describes_a_result_imports_no_writer(folder):
    writers = (f"{PACKAGE}.report.writers", f"{PACKAGE}.report.formats", "html", "jinja2", "rich")
    for path in (ROOT / PACKAGE / "report" / folder).glob("*.py"):
        assert [module for module in structure(path).imports if f"{module}.".startswith(tuple(f"{w}." for w in writers))] == []


@pytest.mark.parametrize(
    "room", sorted({room_of_file(path) for path in files() if len(path.relative_to(ROOT / PACKAGE).parts) > 1})
)
def test_no_folders_of_a_room_import_each_other(room):
    # A module in the room itself is in no folder; it is above or below a folder like any other.
    graph = nx.DiGraph()
    for module, target in module_imports().edges:
        if room_of(module) == room_of(target) == room and folder(module) != folder(target):
            graph.add_edge(folder(module), folder(target))
    assert bool(circles(graph)) is (room in CIRCULAR)


def folder(module):
    """The folder of a module: `amalthea_uros.timing.dataflow` for `amalthea_uros.timing.dataflow.links`."""
    is_package = (ROOT / module.replace(".", "/")).is_dir()
    return module if is_package else module.rpartition(".")[0]
