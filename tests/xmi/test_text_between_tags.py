"""Text between the elements is found, and a `>` in values is not taken for the end of a tag."""

from xml.parsers import expat

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import model_text

from amalthea_uros import load
from amalthea_uros.xmi.emf import handlers
from amalthea_uros.xmi.emf.handlers import has_character_data

VALUE = '<swModel>\n\t<!-- nothing -->\n<labels xmi:id="a%3Eb?type=Label" name="a>b"/></swModel>'


@pytest.mark.parametrize("text", ['<a name="Size > 3" b="x">\n  <b name="c>"/>\n</a>\n', '<a name=">"/>', VALUE])
def test_models_have_white_space_only_whatever_their_values_contain(text, tmp_path):
    assert not has_character_data(text.encode())
    if text is VALUE:
        path = tmp_path / "m.amxmi"
        path.write_text(model_text(text))
        assert not load(path).findings


@pytest.mark.parametrize(("version", "rule"), [("3.3.0", "XMI015"), ("0.7.2", "XMI009")])
@pytest.mark.parametrize(
    "text",
    [
        "<swModel>word</swModel>",
        "<swModel> <labels name='L'/> word</swModel>",
        "<swModel><labels name='\"'/>word</swModel>",
        "<swModel><![CDATA[word]]></swModel>",
        '<swModel>\n  <!-- say "hello --> word\n</swModel>',
        '<swModel><!-- <b name="c -->word</swModel>',
        "<swModel>&#119;ord</swModel>",
        '<swModel><?say "hello?>word</swModel>',
    ],
)
def test_text_is_found_after_tags_comments_and_instructions_and_reported(text, version, rule, tmp_path):
    assert has_character_data(text.encode())
    path = tmp_path / "m.amxmi"
    path.write_text(model_text(text, version))
    assert [finding.rule for finding in load(path).findings if finding.rule == rule] == [rule]


PIECES = [
    *("<b/>", '<b c="d"/>', '<b c=">"/>', "<b c='\"'/>", """<b c="'>x"/>"""),
    *('<!-- " -->', "<!-- > < ' -->", '<?d "?>', " ", "text", '"', "'", ">"),
]


@given(st.lists(st.sampled_from(PIECES), max_size=8))
def test_no_text_is_missed(pieces):
    text = f"<a>{''.join(pieces)}</a>"
    found = []
    parser = expat.ParserCreate()
    parser.CharacterDataHandler = lambda data: found.append(data.strip())
    parser.Parse(text, True)
    assert has_character_data(text.encode()) or not any(found)


def test_many_values_with_such_characters_are_not_all_looked_at(monkeypatch):
    looked_at = []
    monkeypatch.setattr(handlers, "_is_in_value", lambda *place: looked_at.append(place) or True)
    assert has_character_data(b'<b c=">d"/>' * 100_000)
    assert len(looked_at) <= 2_000
