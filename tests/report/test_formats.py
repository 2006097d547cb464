"""Each format has its writer, each result can be shown, and changes of files are exact for programs such as `patch`."""

from dataclasses import is_dataclass
from importlib import import_module
from io import StringIO
from pathlib import Path
from pkgutil import iter_modules

import pytest

from amalthea_uros import services
from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.report import fields, formats
from amalthea_uros.report.documents import DOCUMENTS
from amalthea_uros.report.fields.declaration import ALSO, TIME_SUFFIX, declared
from amalthea_uros.report.wording.findings import findings_text
from amalthea_uros.services.files import FileChange, FilesDiff

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


for module in iter_modules(fields.__path__):
    import_module(f"{fields.__name__}.{module.name}")


def attributes(kind):
    """The attributes of a class: fields of data classes and named tuples, and properties."""
    found = set(dir(kind))
    for base in kind.__mro__:
        found.update(getattr(base, "__annotations__", {}), getattr(base, "_fields", ()))
    return found


@pytest.mark.parametrize("kind", declared(), ids=lambda kind: kind.__name__)
def test_each_field_comes_from_an_attribute(kind):
    sources = [field.removesuffix(TIME_SUFFIX) if isinstance(field, str) else field[1] for field in declared()[kind]]
    first = {source.partition(".")[0] for source in sources if isinstance(source, str)}
    assert first - attributes(kind) == set()


@pytest.mark.parametrize("kind", declared(), ids=lambda kind: kind.__name__)
def test_each_name_is_given_once(kind):
    names = [field if isinstance(field, str) else field[0] for field in declared()[kind]]
    named = [name for name in names if name != ALSO]
    assert len(named) == len(set(named))


class Screen(StringIO):
    def isatty(self):
        return True


def written(before, after, stream, name="m.amxmi"):
    formats.write("text", FilesDiff((FileChange(Path(name), before, after),), "canonical"), stream)
    return stream.getvalue()


def test_a_pipe_gets_the_characters_of_the_file():
    assert written("\t\x1b[31mold\r\n", "new\n", StringIO()).endswith("@@ -1 +1 @@\n-\t\x1b[31mold\r\n+new\n")


def test_a_terminal_gets_escapes_of_hidden_characters_except_tabs():
    assert written("\t\x1b[31mold\r\n", "new\n", Screen()).endswith("@@ -1 +1 @@\n-\t\\x1b[31mold\\r\n+new\n")


def test_only_a_line_feed_ends_a_line():
    """As for `patch`: a line separator or form feed in a comment is part of its line."""
    assert "@@ -1,2 +1,2 @@\n a\u2028b\x0cc\n-old\n+new\n" in written(
        "a\u2028b\x0cc\nold\n", "a\u2028b\x0cc\nnew\n", StringIO()
    )


def test_a_last_line_without_a_line_end_is_marked():
    """As in POSIX.1-2017, diff, "Diff Default Output Format"."""
    assert written("old", "new\n", StringIO()).endswith("-old\n\\ No newline at end of file\n+new\n")


def test_the_name_of_a_file_stays_in_its_line():
    assert "--- a\\nb.amxmi\n" in written("old\n", "new\n", StringIO(), "a\nb.amxmi")
