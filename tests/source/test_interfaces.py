"""Definitions of messages, services and actions beside the code, and the sizes that follow by the rules of CDR."""

from pathlib import Path

import pytest

from amalthea_uros._internal.message_types import MessageType, length_of
from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.messages import defined_types

IDL = """
#include "geometry_msgs/msg/Vector3.idl"
module my_msgs { module msg {
  typedef double double__3[3];
  @verbatim (language="comment", text="a struct Fake { long x; }; (in a text)")
  struct Wheels {
    @unit (value="m/s")
    double__3 speed; // three
    sequence<long, 4> ticks;
    string<8> label;
    geometry_msgs::msg::Vector3 end;
    boolean moving;
  };
}; };
"""


def lengths(path, text, *names):
    own = defined_types([SourceFile(Path(path), text.encode())])
    return [found and (found.bytes, found.most) for name in names for found in [length_of(MessageType(*name.split("/")), own)]]


@pytest.mark.parametrize(
    ("text", "least", "most"),
    [
        # 4 and a zero byte; with 20 characters 25.
        ("string<=20 name", 5, 25),
        # 4 for the number, then up to six of 8 B, the first of which begins at 8.
        ("float64[<=6] positions", 4, 56),
        # 4, then (4 + 9) and 3 to align and (4 + 9).
        ("string<=8[<=2] names", 4, 4 + 13 + 3 + 13),
        ("uint8 a\nfloat64[<=1] b\nuint8 c", 1 + 3 + 4 + 1, 1 + 3 + 4 + 8 + 1),
        ("string name", 5, None),
        ("string[<=3] names", 4, None),
        ("int32[] values", 4, None),
        ("uint8[99999999] values", None, None),
        ("string<=99999999 name", None, None),
    ],
)
def test_bounds_give_the_longest_message(text, least, most):
    (found,) = lengths("my_msgs/msg/Own.msg", text, "my_msgs/msg/Own")
    assert found == (None if least is None else (least, most))


def test_a_definition_replaces_that_of_a_known_type():
    # The header: 8 B of time, a string of up to 12 characters, 3 B to align; then the position.
    (found,) = lengths(
        "std_msgs/msg/Header.msg", "builtin_interfaces/Time stamp\nstring<=12 frame_id", "geometry_msgs/msg/PointStamped"
    )
    assert found == (8 + 5 + 3 + 24, 8 + 17 + 7 + 24)


def test_an_action_has_three_parts():
    text = "int32 order\n---\nint32[<=5] sequence\n---\nint8 done\n"
    found = lengths("my/action/Count.action", text, *(f"my/action/Count_{part}" for part in ("Goal", "Result", "Feedback")))
    # The identifier of the goal has 16 B; a result begins with its status.
    assert found == [(20, 20), (1 + 3 + 4, 1 + 3 + 4 + 20), (17, 17)]


def test_a_definition_in_idl():
    # 24 B, then 4 B and up to 16 B, then 4 B with a zero byte and up to 8 B more, then 24 B from a multiple of 8 on, and 1 B.
    assert lengths("my_msgs/msg/Wheels.idl", IDL, "my_msgs/msg/Wheels") == [
        (24 + 4 + 5 + 7 + 24 + 1, 24 + 20 + 13 + 7 + 24 + 1)
    ]


@pytest.mark.parametrize("text", ["module", "module a { module msg { struct B { unheard x; }; }; };", "struct {" * 500])
def test_what_is_not_understood_has_no_size(text):
    assert lengths("a/msg/B.idl", text, "a/msg/B") == [None]
