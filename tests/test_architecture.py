"""Which room may import which: the rules of the design."""

import pytest
from pytest_archon import archrule

PACKAGE = "amalthea_uros"


@pytest.mark.parametrize(
    ("room", "allowed"),
    [
        ("diagnostics", ()),
        ("errors", ("diagnostics",)),
        ("resources", ()),
        ("units", ()),
        ("perf", ("units", "diagnostics")),
        ("spec", ("units", "diagnostics", "errors", "resources")),
        ("uros", ("spec", "perf", "units", "diagnostics", "errors")),
        ("bridge", ("perf", "metamodel", "units", "diagnostics", "errors")),
        ("analyze", ("perf", "units", "diagnostics")),
        ("metamodel", ("diagnostics",)),
        ("difference", ("metamodel",)),
        ("xmi", ("diagnostics", "errors", "resources", "metamodel")),
        ("report", ("diagnostics", "metamodel", "difference")),
    ],
)
def test_a_room_imports_only_what_it_may(room, allowed):
    rooms = (
        "analyze",
        "bridge",
        "cli",
        "diagnostics",
        "difference",
        "errors",
        "metamodel",
        "perf",
        "report",
        "resources",
        "spec",
    )
    rooms += ("units", "uros", "xmi")
    forbidden = [f"{PACKAGE}.{other}*" for other in rooms if other not in (*allowed, room)]
    (archrule(room).match(f"{PACKAGE}.{room}*").should_not_import(*forbidden).check(PACKAGE, only_direct_imports=True))
