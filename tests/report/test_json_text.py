"""JSON is indented, but what consists of numbers alone takes one line."""

import io
import json

import pytest

from amalthea_uros.report.basics.json_text import write_json

CONTENT = {
    "name": "Task",
    "times": {"min_ps": 1, "avg_ps": 2.5, "max_ps": None},
    "counts": [1, 0, True],
    "nothing": [{}, [], ()],
    "parts": [{"name": 'a "b"\n', "values": [[1, 2], [3]]}, "text", 4],
}
TEXT = """{
  "name": "Task",
  "times": {"min_ps": 1, "avg_ps": 2.5, "max_ps": null},
  "counts": [1, 0, true],
  "nothing": [
    {},
    [],
    []
  ],
  "parts": [
    {
      "name": "a \\"b\\"\\n",
      "values": [
        [1, 2],
        [3]
      ]
    },
    "text",
    4
  ]
}
"""


def written(content, encoding="utf-8"):
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding, newline="")
    write_json(content, stream)
    stream.seek(0)
    return stream.read()


def test_the_text():
    assert written(CONTENT) == TEXT


@pytest.mark.parametrize("content", [CONTENT, [], {}, 7, "text", None, [[]]])
def test_it_says_what_the_library_says(content):
    assert json.loads(written(content)) == json.loads(json.dumps(content))


@pytest.mark.parametrize("text", ["\x7f", "\u202e", "\ud800", "a\u200bb", "\n\u2028"])
def test_hidden_characters_are_escapes(text):
    found = written({text: [text]})
    assert found.replace("\n", "").isascii()
    assert found.replace("\n", "").isprintable()
    assert json.loads(found) == {text: [text]}


def test_letters_that_the_stream_lacks_are_escapes():
    assert "ü" in written(["ü"])
    assert json.loads(written(["ü"], "ascii")) == ["ü"]
