"""Tags found again in a text, compared with what expat reports of it."""

from xml.parsers import expat

import pytest
from effort import every
from hypothesis import given
from hypothesis import strategies as st
from support import corpus

from amalthea_uros.metamodel.tags import ElementEnd, XmlContent
from amalthea_uros.xmi.emf.files import read_text

#: Names that begin alike, and one that is nested in itself.
NAMES = st.sampled_from(["a", "ab", "a-b", "a:b"])
SPACES = st.sampled_from(["", " ", "\n\t"])
VALUES = st.sampled_from(["", "a>b", "/>", "&lt;/a>", "'", "ä€𝄞", "--"])
ATTRIBUTES = st.lists(st.sampled_from("kmn"), unique=True, max_size=2).flatmap(
    lambda keys: st.tuples(*(st.builds("\n{}= {}".format, st.just(key), VALUES.map('"{}"'.format)) for key in keys)).map(
        "".join
    )
)
OTHER = st.sampled_from(
    ["text", "a>b", "/>", "<!-- <a> </a> -->", "<!--<a/>-->", "<![CDATA[</a><a>]]>", "<?pi <a></a>?>", "𝄞 ", "\r\n"]
)


def element(name: str, attributes: str, space: str, content: str) -> str:
    return f"<{name}{attributes}{space}>{content}</{name}{space}>"


ELEMENTS = st.recursive(
    st.builds("<{}{}{}/>".format, NAMES, ATTRIBUTES, SPACES),
    lambda inner: st.builds(element, NAMES, ATTRIBUTES, SPACES, st.lists(inner | OTHER, max_size=4).map("".join)),
    max_leaves=12,
)


def reported(text: str) -> dict[int, ElementEnd]:
    """What expat says: the start tags, and where their elements end."""
    utf8 = text.encode()
    parser = expat.ParserCreate("utf-8")
    opened: list[int] = []
    found: dict[int, ElementEnd] = {}
    last = ""

    def offset() -> int:  # in characters
        return parser.CurrentByteIndex if text.isascii() else len(utf8[: parser.CurrentByteIndex].decode())

    def start(_name, _attributes):
        nonlocal last
        opened.append(offset())
        found[opened[-1]] = ElementEnd(0, 0)
        last = "start"

    def end(_name):
        nonlocal last
        at, begin = offset(), opened.pop()
        # Of an empty element expat reports the offset after it.
        is_empty = last == "start" and text.endswith("/>", begin, at)
        found[begin] = ElementEnd(at, at if is_empty else text.index(">", at) + 1)
        last = "end"

    def other(_data):
        nonlocal last
        last = "other"

    parser.StartElementHandler, parser.EndElementHandler, parser.DefaultHandler = start, end, other
    parser.Parse(utf8, True)
    return found


def check(text: str) -> None:
    expected = reported(text)
    content = XmlContent(text)
    assert content.starts == list(expected)
    assert {start: content.end(start) for start in expected} == expected


@given(ELEMENTS, st.sampled_from(["", "<?xml version='1.0'?>", "<!-- <a> -->\n", "<?pi <a>?>"]))
def test_any_text(root, prolog):
    check(prolog + root)


@pytest.mark.parametrize(
    "text",
    {
        "an end tag with white space inside of an element with the same name": "<a><a></a ></a>",
        "a name that begins like the one of the container": "<a><ab></ab></a>",
        "an end tag in a comment": "<a><!-- </a> --></a>",
        "a start tag in CDATA": "<a><![CDATA[<b>]]></a>",
        "the end of an empty element in a value": '<a b="/>"></a>',
        "text that ends like an empty element": "<a><b></b>/></a>",
    }.values(),
)
def test_by_name(text):
    check(text)


@pytest.mark.parametrize("path", every(5, corpus()))
def test_published_models(path):
    # One byte for each character, so that offsets need no conversion.
    text = read_text(path).text.encode("ascii", "replace").decode()
    expected = reported(text)
    content = XmlContent(text)
    assert content.starts == list(expected)
    assert all(content.end(start) == expected[start] for start in list(expected)[::7])


def test_what_is_before_an_error():
    assert XmlContent("<a>\n<b/><!-- <c>").starts[:2] == [0, 4]


@pytest.mark.parametrize("mark", ["<!--", "<![CDATA[", "<?a "])
def test_what_has_no_end_is_read_once(mark):
    """Looked for from each mark anew, the end would take minutes."""
    assert XmlContent("<a>" + 200_000 * mark).starts == [0]
