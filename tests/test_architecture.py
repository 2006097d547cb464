"""Which room may import which: the rules of the design."""

import pytest
from pytest_archon import archrule
from support import ROOT

PACKAGE = "amalthea_uros"


@pytest.mark.parametrize(
    ("room", "allowed"),
    [
        ("_internal", ()),
        ("diagnostics", ()),
        ("errors", ("diagnostics",)),
        ("resources", ()),
        ("garbage", ()),
        ("units", ()),
        ("findings", ("diagnostics", "errors", "units")),
        ("perf", ("units", "diagnostics")),
        ("spec", ("units", "diagnostics", "errors", "resources")),
        ("uros", ("spec", "perf", "units", "diagnostics", "errors")),
        ("bridge", ("perf", "metamodel", "units", "diagnostics", "errors")),
        ("metamodel", ("units", "diagnostics")),
        ("difference", ("metamodel",)),
        ("xmi", ("diagnostics", "errors", "garbage", "resources", "metamodel")),
        ("validate", ("units", "metamodel", "perf", "timing", "graphs", "diagnostics", "errors", "findings")),
        ("analyze", ("perf", "units", "diagnostics", "compiled")),
        ("pipeline", ("bridge", "diagnostics", "garbage", "metamodel", "perf", "spec", "uros", "xmi")),
        ("checking", ("diagnostics", "findings", "garbage", "metamodel", "pipeline", "validate", "xmi")),
        (
            "report",
            ("diagnostics", "findings", "metamodel", "difference", "perf", "units", "uros", "pipeline", "analyze", "validate"),
        ),
    ],
)
def test_a_room_imports_only_what_it_may(room, allowed):
    paths = [path for path in (ROOT / PACKAGE).iterdir() if path.suffix == ".py" or path.is_dir()]
    rooms = sorted(path.stem for path in paths if not path.name.startswith("_"))
    forbidden = [f"{PACKAGE}.{other}*" for other in rooms if other not in (*allowed, room)]
    (archrule(room).match(f"{PACKAGE}.{room}*").should_not_import(*forbidden).check(PACKAGE, only_direct_imports=True))
