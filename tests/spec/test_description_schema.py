"""The JSON Schema and the reader agree on what an app.yaml may be."""

import ast
import copy
import json
from functools import cache

import jsonschema
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros._internal.files import overlaid
from amalthea_uros.errors import ReadError
from amalthea_uros.spec import description as description  # with all its sections
from amalthea_uros.spec import platforms as platforms
from amalthea_uros.spec.description import json_schema
from amalthea_uros.spec.read import read_description
from amalthea_uros.spec.section import DescriptionSection

SAMPLES = [yaml.safe_load(path.read_text()) for path in sorted((ROOT / "samples").glob("*.yaml"))]
PATH = ROOT / "no-such-file.yaml"


@cache
def validator():
    return jsonschema.Draft7Validator(json_schema())


def schema_accepts(content):
    return validator().is_valid(content)


def reader_accepts(content):
    # JSON is YAML, and leaves no doubt what is text.
    with overlaid({PATH: json.dumps(content).encode()}):
        try:
            read_description(PATH)
        except ReadError:
            return False
    return True


def test_the_schema_is_one_and_says_where_it_is():
    schema = json_schema()
    jsonschema.Draft7Validator.check_schema(schema)
    assert schema["$id"] == f"{DOCUMENTATION}/app.schema.json"


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: sample["name"])
def test_both_accept_a_sample(sample):
    assert schema_accepts(sample)
    assert reader_accepts(sample)


def places(value, path=()):
    """The paths to everything in a value."""
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, (*path, key))


VALUES = st.sampled_from(
    [
        *("10 ms", "0 ms", "-1 ms", "+2 us", ".5 s", "1e-3 s", "-0 ms", "1e3 us"),
        *("10", "ms", "10 msec", "1,5 ms", "00 ms", "1 s\n"),
        *("4 B", "0 B", "-4 B", "50 Hz", "0 Hz", "250 kbit/s", "250 kbps"),
        *("A", "", " A", "A ", "a b", "x" * 200, "x" * 201, "preemptive", "LET", "any", "0x120", "0xg", "1.5", "-1.5"),
        *(0, 1, -1, 2, 10**6 + 1, 2**31, True, None, [], {}, ["A"], [1], {"min": "1 ms"}, {"min": "1 ms", "max": "2 ms"}),
        *({"name": "A"}, {"x-note": 1}, {"": "1 B"}, [{"name": "A", "period": "10 ms"}]),
    ]
)


def drawn_place(data, content):
    """What holds a value anywhere in a content, and the key of it there."""
    *outer, last = data.draw(st.sampled_from([path for path in places(content) if path]))
    for key in outer:
        content = content[key]
    return content, last


@given(st.data())
def test_what_the_schema_refuses_the_reader_refuses(data):
    content = copy.deepcopy(data.draw(st.sampled_from(SAMPLES)))
    holder, last = drawn_place(data, content)
    match data.draw(st.sampled_from(["replace", "remove", "add"])):
        case "remove":
            del holder[last]
        case "add" if isinstance(holder, dict):
            holder[data.draw(st.sampled_from(["x-note", "perod", "period", "offset", "core"]))] = data.draw(VALUES)
        case _:
            holder[last] = data.draw(VALUES)
    if not schema_accepts(content):
        assert not reader_accepts(content)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *(("period", value) for value in ("0 ms", "0.0 s", "-5 ms", "10", 10, "10 msec", "1,5 ms", True, None, [], {})),
        *(("offset", value) for value in ("-1 ms", 0, "0", "1 Hz")),
        *(("name", value) for value in ("", " A", "A ", True, None, [], "x" * 201)),
        *(("preemption", value) for value in ("Preemptive", "", 1)),
        *(("priority", value) for value in (-1, "1", 2**31, True)),
        *(("execution_time", value) for value in (1, "0 ms", [], {"mn": "1 ms"}, {"min": 1, "max": "1 ms"})),
        ("perod", "10 ms"),
    ],
)
def test_what_the_reader_refuses_in_a_task_the_schema_refuses(key, value):
    content = {"amuros": 1, "name": "a", "hardware": "single-core"}
    content["tasks"] = [{"name": "A", "period": "10 ms", "execution_time": "1 ms", key: value}]
    assert not reader_accepts(content)
    assert not schema_accepts(content)


CONTROLLERS = [controller for sample in SAMPLES for controller in sample.get("controllers", [sample])]
PARTS = [value for each in CONTROLLERS for value in (copy.deepcopy(each["application"]), *each.get("tasks", ()))]


@given(st.data())
def test_parts_of_samples_in_wrong_places_are_no_false_alarms(data):
    """An editor must not underline what `amuros check` accepts, wherever a part of another file was pasted."""
    content = copy.deepcopy(data.draw(st.sampled_from(SAMPLES)))
    holder, last = drawn_place(data, content)
    part, _ = drawn_place(data, copy.deepcopy(data.draw(st.sampled_from(PARTS))))
    if isinstance(holder, list):
        holder.append(part)
    else:
        holder[last] = part
    if not schema_accepts(content):
        assert not reader_accepts(content)


# No key of app.yaml is accepted and then ignored.


#: The version of the format, for which there is only one value, and where figures come from, for readers.
WITHOUT_EFFECT = {"amuros", "sources"}


def test_every_key_is_read_somewhere():
    read = {name for room in ("spec", "uros") for name in names_read_in(ROOT / "amalthea_uros" / room)}
    own = [section for section in sections(DescriptionSection) if section.__module__.startswith("amalthea_uros.")]
    assert {key for section in own for key in section.model_fields} - read == WITHOUT_EFFECT


def sections(base):
    for section in base.__subclasses__():
        yield section
        yield from sections(section)


def names_read_in(folder):
    """The attributes and texts in the code of a folder; keys are read as `task.period`, or by their names from a table.

    Build options are read by the names in the tables of their middlewares.
    """
    for path in folder.rglob("options.yaml"):
        yield from (row["name"] for group in yaml.safe_load(path.read_text()) for row in group["options"])
    for path in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Attribute):
                yield node.attr
            elif isinstance(node, ast.Constant):
                yield node.value
