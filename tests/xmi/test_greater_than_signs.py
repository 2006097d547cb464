"""Text between the elements is found, and a `>` in values is not taken for the end of a tag."""

from xml.parsers import expat

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.xmi.emf import handlers
from amalthea_uros.xmi.emf.handlers import has_character_data


@pytest.mark.parametrize(
    "text",
    [
        '<a name="Size > 3" b="x">\n  <b name="c>"/>\n</a>\n',
        '<a name=">"/>',
        "<a>\n\t<!-- nothing -->\n</a>",
    ],
)
def test_models_have_white_space_only_whatever_their_values_contain(text):
    assert not has_character_data(text)


@pytest.mark.parametrize(
    "text",
    [
        "<a>text</a>",
        '<a name="b">\n text</a>',
        '<a><!-- say "hello -->text</a>',
        '<a><!-- <b name="c -->text</a>',
        '<a><?say "hello?>text</a>',
        "<a name='\"'>text</a>",
        "<a><![CDATA[text]]></a>",
    ],
)
def test_text_is_found_after_tags_comments_and_instructions(text):
    assert has_character_data(text)


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
    assert has_character_data(text) or not any(found)


def test_many_values_with_such_characters_are_not_all_looked_at(monkeypatch):
    looked_at = []
    monkeypatch.setattr(handlers, "_is_in_value", lambda *place: looked_at.append(place) or True)
    assert has_character_data('<b c=">d"/>' * 100_000)
    assert len(looked_at) <= 2_000
