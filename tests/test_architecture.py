"""Which room may import which: the rules of the design."""

import pytest
from pytest_archon import archrule
from support import ROOT

PACKAGE = "amalthea_uros"

#: What every room may import.
BASE = ("_internal", "_version", "diagnostics", "errors", "units")

ROOMS = {
    "diagnostics": (),
    "errors": ("diagnostics",),
    "_internal": (),
    "_version": (),
    "units": (),
    "findings": BASE,
    "perf": BASE,
    "timing": (*BASE, "perf"),
    "spec": BASE,
    "uros": (*BASE, "perf", "spec", "timing"),
    "metamodel": BASE,
    "xmi": (*BASE, "metamodel"),
    "bridge": (*BASE, "metamodel", "perf"),
    "difference": (*BASE, "metamodel"),
    "validate": (*BASE, "findings", "metamodel", "perf", "timing"),
    "analyze": (*BASE, "perf", "timing"),
}
INNER = tuple(ROOMS)
ROOMS["services"] = INNER
#: `report` shows the results of services; it neither reads files nor converts models.
ROOMS["report"] = tuple(room for room in (*INNER, "services") if room not in ("bridge", "spec", "xmi"))
ROOMS["am"] = ("metamodel",)
ROOMS["cli"] = (*INNER, "services", "report")


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_what_it_may(room):
    others = {name for name in ROOMS if name not in (*ROOMS[room], room)}
    forbidden = [pattern for name in others for pattern in (f"{PACKAGE}.{name}", f"{PACKAGE}.{name}.*")]
    (
        archrule(room)
        .match(f"{PACKAGE}.{room}", f"{PACKAGE}.{room}.*")
        .should_not_import(*forbidden)
        .check(PACKAGE, only_direct_imports=True)
    )


def test_every_room_has_a_rule():
    paths = [path for path in (ROOT / PACKAGE).iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()]
    without_rule = {"__init__", "__main__", "platforms"}
    assert {path.stem for path in paths} - without_rule == ROOMS.keys()


def test_no_room_imports_the_public_interface():
    (archrule("public").match(f"{PACKAGE}.*").should_not_import(PACKAGE).check(PACKAGE, only_direct_imports=True))
