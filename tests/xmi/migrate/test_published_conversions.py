"""Every step against what the converters of APP4MC make of small and of published models; each difference is an intended one."""

import difflib
import json
import re
from pathlib import Path

import pytest
import yaml
from migration import meaning, migrated, opened
from support import SHARED

from amalthea_uros import diff, load
from amalthea_uros.xmi.emf.versions import is_older, position
from amalthea_uros.xmi.migrate import steps

VECTORS = SHARED / "vectors" / "migration"
CORPUS = SHARED / "corpus"

if not (VECTORS.exists() and CORPUS.exists()):
    pytest.skip("the models are not here", allow_module_level=True)

CASES = json.loads((VECTORS / "index.json").read_text())
INVENTORY = json.loads((CORPUS / "inventory.json").read_text())
VERSIONS = {entry["file"]: entry["version"] for entry in INVENTORY}
OLDER = sorted(file for file, version in VERSIONS.items() if is_older(version))
PAIRS = {entry["file"]: entry["pair"] for entry in INVENTORY if "pair" in entry and "/input/" in entry["file"]}
SERIES = [
    (series["members"][link["from"]]["file"], series["members"][link["to"]]["file"])
    for series in json.loads((CORPUS / "series.json").read_text())
    for link in series["links"]
    if link["to"] == link["from"] + 1 and link["official"].startswith("exact")
]

#: Files of which the published result is not that of the whole conversion, or not of these files.
OTHER_RESULTS = {
    "110.test/TestModels/input/mapping/mapping.amxmi": "refers to a file that was not published",
    "110.test/TestModels/input/mapping/os.amxmi": "was converted together with that file",
    "110.test/TestModels/input/mapping_uri_fragments/mapping.amxmi": "refers to a file that was not published",
    "111.test/TestModels/input/stimuli/stimuli_2.amxmi": "modes are numbered over several files, in no certain order",
    "071.test/TestModels/input/nonAmaltheaRootTag/": "only the root was converted",
    "072.test/TestModels/input/namespace/AMALTHEA_Democar.amxmi": "the OS model was not converted",
    "072.test/TestModels/input/propertyConstraints/": "the OS model was not converted",
}

#: What is found in older files without being a matter of the migration: references to nowhere, and names that several objects have.
OF_THE_FILE = {"XMI020", "XMI021", "XMI025"}

DIFFERENCES = yaml.safe_load((Path(steps.__file__).parent / "differences.yaml").read_text())


def unintended(ours, theirs, before, after):
    """The lines that differ without an entry for a step between two versions."""
    patterns = {"+": [], "-": []}
    for entry in DIFFERENCES:
        if position(before) < position(entry["step"]) <= position(after):
            patterns["+"] += entry.get("ours", ())
            patterns["-"] += entry.get("theirs", ())
    lines = [line for line in difflib.unified_diff(theirs, ours, n=0, lineterm="") if not line.startswith(("---", "+++", "@@"))]
    return [line for line in lines if not any(re.match(pattern, line[1:]) for pattern in patterns[line[0]])]


def lines_of(models):
    """Without blanks, which the converters of APP4MC leave in references."""
    return [line.replace(" ", "") for line in meaning(models)]


def first_file(models):
    models.trees = models.trees[:1]
    return lines_of(models)


def files(folder):
    return sorted(path for path in folder.iterdir() if ".amxmi" in path.name)


def better(case):
    """The expected files of a case: those that a good migration produces in the place of those of APP4MC."""
    folder = VECTORS / case["id"]
    expected = {path.name: path for path in files(folder / "after")}
    if case["sensible"]:
        expected |= {path.name: path for path in files(folder / "sensible")}
    return [expected[name] for name in sorted(expected)]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_a_step_loses_nothing_and_differs_only_where_intended(case):
    models, _ = migrated(files(VECTORS / case["id"] / "before"), case["to"])
    assert meaning(models) == meaning(opened(*better(case)))
    published = opened(*files(VECTORS / case["id"] / "after"))
    assert unintended(lines_of(models), lines_of(published), case["from"], case["to"]) == []


@pytest.mark.parametrize("file", sorted(PAIRS))
def test_a_published_model_differs_from_its_published_result_only_where_intended(file):
    reason = next((reason for part, reason in OTHER_RESULTS.items() if part in file), "")
    after = VERSIONS[PAIRS[file]]
    result, _ = migrated([CORPUS / file], after)
    found = unintended(first_file(result), first_file(opened(CORPUS / PAIRS[file])), VERSIONS[file], after)
    assert (found == []) is not bool(reason), reason


@pytest.mark.parametrize(("before", "after"), SERIES)
def test_a_model_is_the_same_in_its_next_version(before, after):
    result, _ = migrated([CORPUS / before], VERSIONS[after])
    assert unintended(first_file(result), first_file(opened(CORPUS / after)), VERSIONS[before], VERSIONS[after]) == []
    changes = [change for change in diff(CORPUS / before, CORPUS / after).changes if change.feature != "AMALTHEA version"]
    assert [change for change in changes if not is_better(change)] == []


def is_better(change):
    """Whether a difference is that the converters of APP4MC lose something."""
    return (
        change.class_name == "CustomProperty"
        or (change.class_name, change.qualified_name) == ("HwFeatureCategory", "Instructions")
        or (change.class_name, change.feature) == ("PeriodicActivation", "recurrence")
    )


@pytest.mark.parametrize("file", OLDER)
def test_all_content_has_a_place_in_the_newest_version(file):
    found = {finding.rule for finding in load(CORPUS / file).findings}
    assert found - {"XMI008", "XMI009"} <= OF_THE_FILE
