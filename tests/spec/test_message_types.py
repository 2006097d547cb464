"""Sizes of messages that follow from their types, and the bounds that they need."""

import pytest

from amalthea_uros.errors import ReadError
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.read import read_section

TIMES = "rate: 1 Hz, execution_time: 1 ms"


def read(folder, kind, text):
    (folder / "part.yaml").write_text(f"nodes: [{{name: n, {kind}: [{{{text}}}]}}]\n")
    return getattr(read_section(folder / "part.yaml", Application).nodes[0], kind)[0]


@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("type: geometry_msgs/msg/Twist", 48),
        # Its length, twenty characters and the byte at the end.
        ("type: std_msgs/msg/String, bounds: {string: 20}", 4 + 20 + 1),
        # Two times of 4 B, a string of one character (6 B), two bytes to align; then the number of names, two of them with two bytes
        # to align after the first, and for each of three sequences the number, and two numbers of 8 B, the first of which is aligned.
        ("type: sensor_msgs/msg/JointState, bounds: {string: 1, sequence: 2}", 16 + 4 + 8 + 6 + 2 + 4 + 16 + 8 + 16 + 8 + 16),
        # What is stated counts, also for a type that is not known.
        ("type: my_msgs/msg/Own, message_size: 17 B", 17),
        ("type: std_msgs/msg/String, message_size: 64 B", 64),
    ],
)
def test_the_size_of_a_message_follows_from_its_type(text, size, tmp_path):
    assert read(tmp_path, "publishers", f"topic: t, {text}").message_size == 8 * size
    assert read(tmp_path, "subscriptions", f"name: S, topic: t, {text}, {TIMES}").message_size == 8 * size


def test_the_sizes_of_a_service(tmp_path):
    # A flag; a flag, three bytes to align, and a string.
    service = read(tmp_path, "services", f"name: S, type: std_srvs/srv/SetBool, bounds: {{string: 7}}, {TIMES}")
    assert (service.request_size, service.response_size) == (8, 8 * (4 + 4 + 8))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("type: std_msgs/msg/String", "std_msgs/msg/String has no longest string: state it in 'bounds'"),
        ("type: sensor_msgs/msg/JointState, bounds: {string: 3}", "has no longest sequence"),
        ("type: std_msgs/msg/Int32, message_size: 2 B", "the size 2 B is less than the 4 B of the shortest message"),
        ("type: my_msgs/msg/Own", "missing key 'message_size'"),
        ("type: std_msgs/Int32, message_size: 4 B", "expected a type such as 'std_msgs/msg/Int32'"),
        ("type: std_msgs/msg/String, bounds: {string: TODO}", "'string' has no value yet"),
    ],
)
def test_what_a_type_leaves_open_is_asked_for(text, message, tmp_path):
    with pytest.raises(ReadError) as caught:
        read(tmp_path, "publishers", f"topic: t, {text}")
    assert [message in each.message for each in caught.value.findings] == [True]
