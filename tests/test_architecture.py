"""Which room may import which, and in which order data pass through them: the rules of docs/architecture.md."""

import re
import shutil
import sys
from importlib import import_module

import pytest
from draw_rooms import BASE, PACKAGE, PAGE, circles, main, module_imports, room_imports, room_of
from support import ROOT

from amalthea_uros import Settings, analyze_files

ROOMS = {
    "_internal": (),
    "diagnostics": ("_internal",),
    "errors": ("diagnostics",),
    "names": ("_internal", "errors"),
    "_version": (),
    "units": ("_internal",),
    "findings": BASE,
    "perf": BASE,
    "timing": (*BASE, "perf"),
    "executors": (*BASE, "perf", "timing"),
    "spec": BASE,
    "trace": BASE,
    "uros": (*BASE, "executors", "perf", "spec", "timing", "trace"),
    "source": BASE,
    "metamodel": BASE,
    "xmi": (*BASE, "metamodel"),
    "bridge": (*BASE, "metamodel", "perf"),
    "inchron": (*BASE, "metamodel", "xmi"),
    "inchron_bridge": (*BASE, "bridge", "inchron", "metamodel", "perf", "timing"),
    "difference": (*BASE, "metamodel"),
    "validate": (*BASE, "findings", "metamodel", "perf", "timing"),
    "judge": (*BASE, "perf", "timing"),
    "analyze": (*BASE, "executors", "judge", "perf", "timing"),
    "measure": (*BASE, "timing", "trace"),
    "simulate": (*BASE, "executors", "judge", "perf", "timing", "trace"),
}
ROOMS["design"] = tuple(ROOMS)
ROOMS["compare"] = tuple(ROOMS)
INNER = tuple(ROOMS)
ROOMS["services"] = INNER
NOT_SHOWN = ("bridge", "inchron_bridge", "spec", "xmi")
#: `report` shows the results of services; it neither reads files nor converts models.
ROOMS["report"] = tuple(room for room in (*INNER, "services") if room not in NOT_SHOWN)
ROOMS["editor"] = (*INNER, "services", "report")
ROOMS["cli"] = (*ROOMS["editor"], "editor")
ROOMS["am"] = ("metamodel",)


def test_a_room_imports_only_what_it_may():
    rooms = room_imports(for_types=True)
    assert {room: found for room in ROOMS if (found := set(rooms[room]) - set(ROOMS[room]))} == {}


def test_every_room_has_a_rule():
    paths = [path for path in (ROOT / PACKAGE).iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()]
    without_rule = {"__init__", "__main__", "platforms"}
    assert {path.stem for path in paths} - without_rule == ROOMS.keys()


def test_no_room_imports_the_public_interface():
    assert list(module_imports(for_types=True).predecessors(PACKAGE)) == []


def test_every_room_imports_only_rooms_that_the_table_has_above_it():
    order = list(ROOMS)
    for room, imported in room_imports().adjacency():
        assert all(order.index(other) < order.index(room) for other in imported), room


def test_no_modules_import_each_other():
    # AMALTHEA objects answer for themselves, e.g. `task.qualified_name`, by functions that need the classes of all objects.
    modules = module_imports()
    modules.remove_nodes_from([module for module in modules if room_of(module) == "metamodel"])
    assert circles(modules) == []


def test_the_page_has_the_table_of_rooms():
    rows = re.findall(r"^\| (`\w+`(?:, `\w+`)*) \| .* \| (.*) \|$", PAGE.read_text(), re.MULTILINE)
    rooms, imports = {}, {}
    for names, cell in rows:
        stated = set(re.findall(r"`(\w+)`", cell))
        allowed = rooms.keys() - BASE - stated if cell.startswith("everything above") else stated
        for name in re.findall(r"`(\w+)`", names):
            rooms[name] = cell
            imports[name] = allowed
    assert imports == {room: set(allowed) - set(BASE) for room, allowed in ROOMS.items()}


@pytest.mark.parametrize("page", [PAGE, ROOT / "CONTRIBUTING.md"], ids=lambda page: page.name)
def test_everything_that_a_page_names_exists(page):
    names = re.findall(r"`([\w./<>-]+)`", page.read_text())
    paths = [name for name in names if "/" in name and "<" not in name]
    assert [path for path in paths if not (ROOT / path).exists()] == []
    objects = [name for name in names if "." in name and "/" not in name and name.split(".")[0] in ROOMS]
    assert [name for name in objects if not is_defined(name)] == []
    assert len(paths) + len(objects) > 20


def is_defined(name):
    """Whether the package has a module, object, or field of a class, e.g. `units` or `spec.processes.Process.period`."""
    # A room first: the public interface has a function with the name of one, `simulate`.
    room, *parts = name.split(".")
    found = import_module(f"{PACKAGE}.{room}")
    for part in parts:
        if part in getattr(found, "__annotations__", {}) or any(part in vars(base) for base in getattr(found, "__mro__", ())):
            return True
        if not hasattr(found, part):
            try:
                import_module(f"{found.__name__}.{part}")
            except ImportError:
                return False
        found = getattr(found, part)
    return True


def test_the_picture_shows_the_imports(tmp_path):
    page = tmp_path / PAGE.name
    shutil.copy(PAGE, page)
    main(page)
    assert page.read_text() == PAGE.read_text()


@pytest.mark.parametrize(
    ("file", "rooms"),
    [
        ("executor.amxmi", ["xmi", "bridge", "design", "analyze", "findings"]),
        ("bodas-test-advanced.yaml", ["uros", "design", "analyze", "findings"]),
    ],
)
def test_from_a_file_to_a_response_time_each_room_is_entered_once(file, rooms):
    def analyze():
        analyze_files(ROOT / "samples" / file, settings)

    settings = Settings()
    analyze()  # imports everything
    assert rooms_entered_from("services", analyze) == rooms


def rooms_entered_from(origin, action):
    """The rooms whose functions those of a room call, in order, without the basics; calls in a row of one room count once."""
    entered = []

    def note(frame, event, _argument):
        caller = frame.f_back
        if (
            event == "call"
            and caller is not None
            and room(caller) == origin
            and room(frame) not in (origin, None, *BASE, *entered[-1:])
        ):
            entered.append(room(frame))

    sys.setprofile(note)
    try:
        action()
    finally:
        sys.setprofile(None)
    return entered


def room(frame):
    """The room of the code of a frame; None for code outside the package."""
    module = frame.f_globals.get("__name__", "")
    return room_of(module) if module.startswith(f"{PACKAGE}.") else None
