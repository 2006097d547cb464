"""Older files with damage: unknown names, wrong types, missing and repeated parts, references to nowhere and in circles."""

import copy
import json
import random

import pytest
from effort import IS_THOROUGH
from lxml import etree
from support import SHARED

from amalthea_uros import ReadError, extract, load

VECTORS = SHARED / "vectors" / "migration"
CORPUS = SHARED / "corpus"
TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"

#: `python -m pytest tests/xmi/migrate/test_damaged_older_files.py` reads one file of every so many; all are 20 times as many.
SMALL = 60_000

if not VECTORS.exists():
    pytest.skip("the vectors are not here", allow_module_level=True)


def originals():
    """Older models: every construct of the vectors, and published ones."""
    inventory = json.loads((CORPUS / "inventory.json").read_text())
    published = [CORPUS / entry["file"] for entry in inventory if entry["size"] < SMALL and is_older(entry["version"])]
    return sorted(VECTORS.glob("*/before/*.amxmi*")) + published[::5]


def is_older(version):
    return version.startswith("ITEA") or tuple(map(int, version.split("."))) < (0, 9, 7)


def damaged(rng, root, others):
    """A copy with one to four defects."""
    root = copy.deepcopy(root)
    for _ in range(rng.randint(1, 4)):
        elements = [element for element in root.iter() if isinstance(element.tag, str)]
        rng.choice(DEFECTS)(rng, rng.choice(elements[1:] or elements), elements, others)
    return etree.tostring(root, xml_declaration=True, encoding="UTF-8")


def drop(_rng, element, _elements, _others):
    if element.getparent() is not None:
        element.getparent().remove(element)


def repeat(_rng, element, _elements, _others):
    if element.getparent() is not None:
        element.addnext(copy.deepcopy(element))


def move(rng, element, elements, _others):
    target = rng.choice(elements)
    if element.getparent() is not None and element not in target.iterancestors() and target is not element:
        target.append(element)


def rename(rng, element, elements, _others):
    if element.getparent() is not None:
        element.tag = rng.choice(["unknown", rng.choice(elements[1:]).tag])


def retype(rng, element, elements, _others):
    types = [other.get(TYPE) for other in elements if other.get(TYPE)]
    if rng.random() < 0.3:
        element.attrib.pop(TYPE, None)
    elif types:
        element.set(TYPE, rng.choice([*types, "am:Nothing", "x:y:z", ""]))


def change(rng, element, elements, _others):
    names = [name for name in element.attrib if name != TYPE]
    if names:
        values = [value for other in elements for name, value in other.attrib.items() if name != TYPE]
        odd = [
            "",
            " ",
            "-1",
            "1e400",
            "nan",
            "true",
            "x?type=Label",
            "?type=",
            "//@swModel/@tasks.99",
            "_x",
            "%",
            "%zz+?type=%",
            "a b",
        ]
        element.set(rng.choice(names), rng.choice([*odd, rng.choice(values)]))


def drop_attribute(rng, element, _elements, _others):
    names = [name for name in element.attrib if name != TYPE]
    if names:
        del element.attrib[rng.choice(names)]


def add_attribute(rng, element, elements, _others):
    donor = rng.choice(elements)
    for name, value in donor.attrib.items():
        element.set(name, value)


def refer(rng, element, elements, _others):
    element.set("href", rng.choice(["amlt:/#x?type=Task", "amlt://#y", "other.amxmi-sw#_z", "#//", "", "../..#/"]))


def graft(rng, element, _elements, others):
    element.append(copy.deepcopy(rng.choice(others)))


DEFECTS = [drop, repeat, move, rename, retype, change, change, drop_attribute, add_attribute, refer, graft]


def reads_or_refuses(path, analyses):
    """Whether the file is read; whatever is found has a place in it."""
    try:
        model = load(path)
    except ReadError as error:
        crashes = [finding.message for finding in error.findings if finding.rule == "XMI105"]
        if crashes:
            raise AssertionError(crashes[0]) from error
        return False
    for finding in model.findings:
        assert finding.location, finding
        assert finding.location.line, finding
    if analyses:
        extract(model)
    return True


def run(tmp_path, count, seed):
    rng = random.Random(seed)
    roots = [etree.parse(path).getroot() for path in originals()]
    others = [element for root in roots for element in root.iter() if isinstance(element.tag, str) and len(element) < 5][::7]
    path = tmp_path / "damaged.amxmi"
    read = 0
    for number in range(count):
        data = damaged(rng, roots[number % len(roots)], others)
        path.write_bytes(data)
        try:
            read += reads_or_refuses(path, analyses=True)
        except Exception as error:  # the file is part of the message
            kept = tmp_path / f"failed-{seed}-{number}.amxmi"
            kept.write_bytes(data)
            raise AssertionError(f"{kept}: {type(error).__name__}: {error}") from error
    return read


def test_nothing_ends_with_a_traceback(tmp_path):
    count = 1000 if IS_THOROUGH else 60
    assert run(tmp_path, count, seed=1) > count * 0.7
