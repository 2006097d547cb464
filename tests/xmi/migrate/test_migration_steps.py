"""Every step against pairs of small models: what the official converter makes of them, and what is better where it loses something."""

import json

import pytest
from migration import meaning, migrated, opened
from support import SHARED

VECTORS = SHARED / "vectors" / "migration"

if not VECTORS.exists():
    pytest.skip("the vectors are not here", allow_module_level=True)

CASES = json.loads((VECTORS / "index.json").read_text())


def files(folder):
    return sorted(path for path in folder.iterdir() if ".amxmi" in path.name)


def better(case):
    """The expected files of a case: those that a good migration produces in the place of the official ones."""
    folder = VECTORS / case["id"]
    expected = {path.name: path for path in files(folder / "after")}
    if case["sensible"]:
        expected |= {path.name: path for path in files(folder / "sensible")}
    return [expected[name] for name in sorted(expected)]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_the_default_loses_nothing(case):
    models, _ = migrated(files(VECTORS / case["id"] / "before"), case["to"])
    assert meaning(models) == meaning(opened(*better(case)))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_official_is_what_the_official_converter_does(case):
    models, _ = migrated(files(VECTORS / case["id"] / "before"), case["to"], official=True)
    assert meaning(models) == meaning(opened(*files(VECTORS / case["id"] / "after")))
