"""Published models of all versions: no exception escapes, and a migrated model has no error that the old one has not."""

from collections import Counter

import pytest
from effort import every
from every_model import ARGUMENTS, models, run
from support import DATA, SHARED

from amalthea_uros import check_files
from amalthea_uros.diagnostics import Severity
from amalthea_uros.services.migrate import migrate_files

CORPUS = models(SHARED / "corpus") if (SHARED / "corpus").is_dir() else []
PATHS = [pytest.param(path, id=str(path.relative_to(SHARED))) for path in every(60, CORPUS)]
#: Of the processor, for a command; a usual one takes a hundredth.
SECONDS = 60


@pytest.mark.parametrize("path", every(3, PATHS))
def test_each_command_ends_in_words(path):
    for command in ARGUMENTS:
        outcome = run(command, path, SECONDS)
        assert (outcome.cause, outcome.code in (0, 1, 2)) == ("", True), outcome
        assert outcome.closing


def test_an_exception_that_escapes_is_reported_with_its_place(monkeypatch):
    def broken(*_):
        raise KeyError("surprise")

    monkeypatch.setattr("amalthea_uros.services.info.info", broken)
    outcome = run("info", DATA / "brake.amxmi", SECONDS)
    assert outcome.code == 70
    assert outcome.cause.startswith("KeyError")
    assert "surprise" in outcome.cause


def errors(path):
    """How often each rule finds an error; most old versions have no XML schema, so that an error of it is a new one."""
    found = check_files(path).presentation.shown
    return Counter(each.rule for each in found if each.severity is Severity.ERROR)


@pytest.mark.parametrize("path", PATHS)
def test_a_migrated_model_has_no_new_error(path, tmp_path):
    result = migrate_files(path, target=tmp_path / "migrated.amxmi")
    if (tmp_path / "migrated.amxmi").is_file():
        assert errors(tmp_path / "migrated.amxmi") - errors(path) == Counter(), result
