"""Models that are migrated in memory: what a rule says of the file is about the version that the file has."""

import pytest
from inline_models import written

from amalthea_uros import CheckSettings, check_files
from amalthea_uros.services.fix import fix_files

_ITEA = (
    '<central:AMALTHEA xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" '
    'xmlns:central="http://www.amalthea.itea2.org/model/1.2.0/central"><swModel/></central:AMALTHEA>'
)


def test_the_importer_does_not_read_the_old_file(tmp_path):
    (path,) = written(tmp_path, "0.9.5", "<swModel/>")
    findings = check_files([path], CheckSettings(select=["INC-IO-VERSION"])).findings
    assert [finding.message for finding in findings if finding.rule == "INC-IO-VERSION"] == [
        "AMALTHEA 0.9.5 is not supported by am2inc"
    ]


@pytest.mark.parametrize("rule", ["INC-IO-VERSION", "XSD000"])
def test_versions_of_itea_are_not_called_versions_of_app4mc(tmp_path, rule):
    path = tmp_path / "m.amxmi"
    path.write_text(_ITEA)
    (message,) = [finding.message for finding in check_files([path]).findings if finding.rule == rule]
    assert "ITEA 1.2.0" in message
    assert "AMALTHEA ITEA" not in message


def test_a_model_of_itea_is_not_repaired(tmp_path):
    path = tmp_path / "m.amxmi"
    path.write_text(_ITEA)
    assert fix_files([path]).older == ((path, "ITEA 1.2.0"),)
    assert path.read_text() == _ITEA
