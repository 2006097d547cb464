"""Every id of a finding has an entry, and every entry is the one of a finding."""

import ast
import re
from collections import defaultdict
from functools import cache

import pytest
from state_charts import check_trace
from support import MODEL, ROOT

from amalthea_uros import build, describe, load, measure
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.bridge.extract import extract
from amalthea_uros.errors import ReadError
from amalthea_uros.findings import catalogue
from amalthea_uros.services.generate import check_colcon_meta
from amalthea_uros.services.import_code import import_code
from amalthea_uros.validate import registry
from amalthea_uros.validate.settings import project_settings

ALL_KINDS = [kind for family in catalogue.FAMILIES for kind in catalogue.kinds(family)]
KINDS = {kind.id: kind for kind in ALL_KINDS}
ID = re.compile(r"[A-Z]{2,}\d{3}|(?:INC|TIM|AM|EMF|TA|DOC)-[A-Za-z/.-]+")


@cache
def emitted():
    """The ids in calls of the source, each with the severities in the same call."""
    found = defaultdict(set)
    for path in (ROOT / "amalthea_uros").rglob("*.py"):
        if "rules" in path.parts or "findings" in path.parts:
            continue
        text = path.read_text()
        for node in ast.walk(ast.parse(text)) if ID.search(text) else ():
            if isinstance(node, ast.Call):
                for value in node.args[:4]:
                    if isinstance(value, ast.Constant) and isinstance(value.value, str) and ID.fullmatch(value.value):
                        found[value.value] |= set(re.findall(r"Severity\.([A-Z]+)", ast.unparse(node)))
            elif isinstance(node, ast.IfExp):
                for value in (node.body, node.orelse):
                    if isinstance(value, ast.Constant) and isinstance(value.value, str) and ID.fullmatch(value.value):
                        found[value.value] |= set()
    return found


def test_every_finding_is_in_the_catalogue_or_of_a_rule_and_every_entry_is_used():
    assert emitted().keys() - set(registry.ids()) == KINDS.keys()


def test_the_severity_is_that_of_the_finding():
    stated = {identifier: severities for identifier, severities in emitted().items() if identifier in KINDS and severities}
    assert len(stated) > 20
    # Several findings in one expression cannot be told apart.
    for identifier, severities in stated.items():
        assert KINDS[identifier].severity.name in severities


def test_ids_are_unique_and_belong_to_their_family():
    assert len(KINDS) == len(ALL_KINDS)
    assert not KINDS.keys() & set(registry.ids())
    for family in catalogue.FAMILIES:
        assert all(kind.id.startswith(family) for kind in catalogue.kinds(family))
        assert [kind.id for kind in catalogue.kinds(family)] == sorted(kind.id for kind in catalogue.kinds(family))


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.id)
def test_an_entry_reads_like_one_of_a_rule(kind):
    assert kind.title[0].islower() or kind.title.startswith(("AMALTHEA", "IPC", "xmi:id"))
    assert not kind.title.endswith(".")
    assert kind.rationale.endswith(".")
    assert kind.remedy.endswith(".")
    assert registry.kind(kind.id) is kind


@pytest.mark.parametrize("identifier", [kind.id for kind in KINDS.values() if kind.fails])
def test_the_example_has_the_finding(identifier, tmp_path):
    kind = KINDS[identifier]
    findings = [finding for finding in reported(kind.fails, identifier[:3], tmp_path) if finding.rule == identifier]
    assert findings
    assert {finding.severity for finding in findings} == {kind.severity}


def reported(example, family, folder):
    """The findings of reading, building or extracting an example."""
    try:
        match family:
            case "CFG":
                (folder / "amuros.toml").write_text(example)
                project_settings(folder / "model.amxmi")
                return []
            case "YML" | "APP":
                path = folder / "app.yaml"
                path.write_text(example)
                return build(path).assembly.findings
            case "GEN":
                (folder / "colcon.meta").write_text(example)
                return check_colcon_meta(ROOT / "samples" / "rclc-in-executor.yaml", folder / "colcon.meta").findings
            case "CHN" | "EXE" | "HST":
                path = folder / "app.yaml"
                path.write_text(example)
                described = describe(path)
                return [*described.findings, *analyze_system(described.system).findings]
            case "CAN" | "MEA" | "TRC":
                return found_in_trace(example, folder)
            case "IMP" if not example.startswith("amuros:"):
                (folder / "main.c").write_text(example)
                return import_code([folder / "main.c"]).findings
            case "IMP":
                (folder / "app.yaml").write_text(example)
                return build(folder / "app.yaml").assembly.findings
        path = folder / "model.amxmi"
        whole = example.lstrip().startswith(("<am:", "<!"))
        path.write_text(example.lstrip() if whole else MODEL.format(example))
        model = load(path)
        return [*model.findings, *extract(model).findings]
    except ReadError as error:
        return error.findings


def found_in_trace(example, folder):
    """The findings of measuring in an example: a file of markers, or a trace whose format its text shows."""
    if example.startswith("Task:"):
        (folder / "markers.yaml").write_text(example)
        return measure(ROOT / "samples" / "bodas-test-measured.log", markers=folder / "markers.yaml").findings
    suffix = "log" if example.startswith("(") else "csv" if example.startswith("object") else "btf"
    path = folder / f"run.{suffix}"
    path.write_text(example)
    if suffix == "btf":
        return check_trace(path)
    return measure(path, **({"start": "123#11", "end": "123#12"} if suffix == "log" else {})).findings


def test_ids_of_nothing():
    assert catalogue.find("XMI999") is None
    assert catalogue.find("ABC001") is None
    assert registry.kind("nothing") is None
