"""Importing programs, and filling the gaps of what is written with values that are valid."""

import re

from amalthea_uros.services.build import describe
from amalthea_uros.services.import_code import import_code
from amalthea_uros.spec.read import read_description

#: A value for each key whose value code cannot tell.
VALUES = {
    "frequency": "160 MHz",
    "transport": "{udp: {bitrate: 10 Mbit/s}}",
    "bitrate": "10 Mbit/s",
    "baud_rate": "115200",
    "message_size": "64 B",
    "request_size": "64 B",
    "goal_size": "64 B",
    "result_size": "64 B",
    "feedback_size": "64 B",
    "response_size": "64 B",
    "rate": "1 Hz",
    "loop": "{spin_some: 10 ms}",
    "core": "Core_0",
    "priority": "3",
    "stack": "16 kB",
    "trigger": "any",
    "order": "[]",
    "reliability": "reliable",
    "publishes": "[]",
    "events": "false",
    "string": "20",
    "sequence": "4",
}


def filled(text, values=VALUES):
    """A description with a value instead of each gap."""
    return re.sub(r"(\w+): TODO", lambda match: f"{match[1]}: {values.get(match[1], '20 ms')}", text)


def imported(tmp_path, text, name="main.c", **others):
    """The result for a program, with other files beside it: dots in their names are written as two underscores."""
    (tmp_path / name).write_text(text)
    for other, content in others.items():
        (tmp_path / other.replace("__", ".")).write_text(content)
    return import_code([tmp_path])


def described(result, folder):
    """The description that a result becomes when its gaps are filled, and the findings about it."""
    (folder / "app.yaml").write_text(filled(result.text))
    return read_description(folder / "app.yaml"), describe(folder / "app.yaml").findings


#: Of every program that does not ask for the agent, as most of these.
_OF_MOST = {"IMP026"}


def rules(result):
    """The rules of the findings, except of what most programs here do not do."""
    return {finding.rule for finding in result.findings} - _OF_MOST
