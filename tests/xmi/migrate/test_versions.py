"""The version that a file declares is found without reading the file."""

import pytest
from migration import model

from amalthea_uros import ReadError, load
from amalthea_uros.xmi.emf.versions import version_of


@pytest.mark.parametrize("version", ["0.7.2", "3.3.0"])
def test_behind_a_long_comment(version):
    declaration, content = model(version, "").split("\n", 1)
    assert version_of(f"{declaration}\n<!-- {'long ' * 100_000} -->\n{content}".encode()) == version


@pytest.mark.parametrize(
    "text", ["", "<", "<a", "<a/>", "no XML", "<a:b xmlns:a='http://www.omg.org/XMI'/>", "<!-- only a comment -->"]
)
def test_none_in_what_is_no_model(text):
    assert version_of(text.encode()) == ""


def test_a_document_type_is_refused_before_an_entity_is_expanded(tmp_path):
    path = tmp_path / "m.amxmi"
    entities = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10 if n else "x" * 100}">' for n in range(9))
    declaration, content = model("0.7.2", "").split("\n", 1)
    expanded = content.replace("xmi:version", 'x="&e8;" xmi:version')
    path.write_text(f"{declaration}\n<!DOCTYPE a [{entities}]>\n{expanded}")
    assert version_of(path.read_bytes()) == ""
    with pytest.raises(ReadError) as refused:
        load(path)
    assert [finding.rule for finding in refused.value.findings] == ["XMI003"]


@pytest.mark.parametrize(
    ("namespace", "spelled"),
    [
        ("http://www.amalthea.itea2.org/model/1.0.0/central", "ITEA 1.0.0"),
        ("http://www.amalthea.itea2.org/model/next", "http://www.amalthea.itea2.org/model/next"),
    ],
)
def test_a_version_of_itea_that_was_never_published(tmp_path, namespace, spelled):
    path = tmp_path / "m.amxmi"
    path.write_text(f'<central:AMALTHEA xmlns:central="{namespace}"/>')
    with pytest.raises(ReadError) as refused:
        load(path)
    assert [(finding.rule, finding.message) for finding in refused.value.findings] == [
        ("XMI006", f"{spelled} is no known version of AMALTHEA")
    ]
