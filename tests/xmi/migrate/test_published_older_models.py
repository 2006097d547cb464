"""Published models of older versions: nothing of their content is lost, and the results are those of the official converters."""

import json

import pytest
from migration import meaning, migrated, opened
from support import SHARED

from amalthea_uros import diff, load
from amalthea_uros.xmi.migrate.versions import is_older

CORPUS = SHARED / "corpus"

if not CORPUS.exists():
    pytest.skip("the published models are not at hand", allow_module_level=True)

INVENTORY = json.loads((CORPUS / "inventory.json").read_text())
VERSIONS = {entry["file"]: entry["version"] for entry in INVENTORY}
OLDER = sorted(file for file, version in VERSIONS.items() if is_older(version))
PAIRS = {entry["file"]: entry["pair"] for entry in INVENTORY if "pair" in entry and "/input/" in entry["file"]}
SERIES = [
    (series["members"][link["from"]], series["members"][link["to"]], link["official"])
    for series in json.loads((CORPUS / "series.json").read_text())
    for link in series["links"]
    if link["to"] == link["from"] + 1
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


@pytest.mark.parametrize("file", OLDER)
def test_all_content_has_a_place_in_the_newest_version(file):
    found = {finding.rule for finding in load(CORPUS / file).findings}
    assert found - {"XMI008", "XMI009"} <= OF_THE_FILE


def lines_of(models):
    """The first file; without blanks, which the official converters leave in references."""
    models.trees = models.trees[:1]
    return [line.replace(" ", "") for line in meaning(models)]


@pytest.mark.parametrize("file", sorted(PAIRS))
def test_official_gives_the_published_result(file):
    reason = next((reason for part, reason in OTHER_RESULTS.items() if part in file), "")
    result, _ = migrated([CORPUS / file], VERSIONS[PAIRS[file]], official=True)
    assert (lines_of(result) == lines_of(opened(CORPUS / PAIRS[file]))) is not bool(reason), reason


@pytest.mark.parametrize(
    ("before", "after"), [(a["file"], b["file"]) for a, b, official in SERIES if official.startswith("exact")]
)
def test_a_model_is_the_same_in_its_next_version(before, after):
    result, _ = migrated([CORPUS / before], VERSIONS[after], official=True)
    assert lines_of(result) == lines_of(opened(CORPUS / after))
    changes = [change for change in diff(CORPUS / before, CORPUS / after).changes if change.feature != "AMALTHEA version"]
    assert [change for change in changes if not is_better(change)] == []


def is_better(change):
    """Whether a difference is that the official converter loses something."""
    return change.class_name == "CustomProperty" or (change.class_name, change.qualified_name) == (
        "HwFeatureCategory",
        "Instructions",
    )
