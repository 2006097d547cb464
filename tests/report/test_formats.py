"""Each format has its writer, and each result can be shown."""

from dataclasses import is_dataclass
from importlib import import_module
from pkgutil import iter_modules

import pytest

from amalthea_uros import services
from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.report import formats
from amalthea_uros.report.documents import DOCUMENTS
from amalthea_uros.report.wording.findings import findings_text

MODULES = [import_module(f"{services.__name__}.{module.name}") for module in iter_modules(services.__path__)]
RESULTS = {
    value
    for module in MODULES
    for value in vars(module).values()
    if is_dataclass(value) and value.__module__ == module.__name__ and value.__name__.endswith("Result")
}


@pytest.mark.parametrize("result", sorted(RESULTS, key=lambda result: result.__name__))
def test_every_result_can_be_shown_as_text(result):
    assert formats.formats_for(result.__name__)[0] == "text"


def test_a_command_offers_the_formats_that_can_write_its_result():
    assert formats.formats_for("CheckResult") == ["text", "github", "json", "junit", "sarif"]
    assert formats.formats_for("InfoResult") == ["text", "json"]


@pytest.mark.parametrize(("name", "function"), [(name, function) for name, (function, _) in formats.FORMATS.items()])
def test_every_format_has_its_writer(name, function):
    module, _, function = function.partition(".")
    assert callable(getattr(import_module(f"amalthea_uros.report.writers.{module}"), function))


@pytest.mark.parametrize("made_by", sorted(DOCUMENTS.values()))
def test_every_result_has_its_document(made_by):
    module, _, function = made_by.partition(".")
    assert callable(getattr(import_module(f"amalthea_uros.report.documents.{module}"), function))


def test_numbers_in_sentences():
    found = [Finding("X", severity, "x") for severity in (Severity.WARNING, Severity.INFO, Severity.WARNING, Severity.ERROR)]
    assert findings_text(found) == "4 findings: 1 error, 2 warnings, 1 info"
    assert findings_text(found[:1]) == "1 finding: 1 warning"
    assert findings_text([]) == "no findings"
    assert (counted(1, "unresolved reference"), counted(1200, "object")) == ("1 unresolved reference", "1,200 objects")
