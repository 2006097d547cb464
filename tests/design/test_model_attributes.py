"""Every attribute of an AMALTHEA model as a key: setting one is what editing the file is."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from urllib.parse import unquote_plus
from xml.etree import ElementTree

import pytest
from effort import examples
from hypothesis import assume, given
from hypothesis import strategies as st
from support import ROOT, hand_written

import amalthea_uros as amuros
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.model_attributes.keys import keys_of, matching, short_names
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.changed import open_changed
from amalthea_uros.services.keys import keys

SAMPLES = ROOT / "samples"
EXECUTOR = SAMPLES / "executor.amxmi"

#: Changes -> a part of the file, and what somebody would write there.
EDITS = {
    "every_1_ms.recurrence=2500us": ('<recurrence value="1" unit="ms"/>', '<recurrence value="2500" unit="us"/>'),
    "every_20_ms.recurrence=0.005 s": ('<recurrence value="20" unit="ms"/>', '<recurrence value="5" unit="ms"/>'),
    "Executor_Task_Runnable.value=300": ('value="12"', 'value="300"'),
    "memory_2.size=8B": (
        'name="memory_2" constant="false" bVolatile="false">\n      <size value="4" unit="B"/>',
        'name="memory_2" constant="false" bVolatile="false">\n      <size value="8" unit="B"/>',
    ),
    "Message_Factor.stimuli=every_1_ms": (
        '"every_20_ms?type=PeriodicStimulus" preem',
        '"every_1_ms?type=PeriodicStimulus" preem',
    ),
    "Control_Function.multipleTaskActivationLimit=4": (
        'name="Control_Function" stimuli="every_1_ms?type=PeriodicStimulus" preemption="preemptive" multipleTaskActivationLimit="1"',
        'name="Control_Function" stimuli="every_1_ms?type=PeriodicStimulus" preemption="preemptive" multipleTaskActivationLimit="4"',
    ),
}


@pytest.mark.parametrize("change", EDITS)
def test_a_change_is_the_edit_of_the_file(change, tmp_path):
    target = tmp_path / "changed.amxmi"
    old, new = EDITS[change]
    text = EXECUTOR.read_text()
    assert old in text
    found = amuros.what_if(EXECUTOR, [change])
    found.save(target)
    assert target.read_text() == text.replace(old, new, 1)
    assert amuros.extract(amuros.load(target)).system == found.system


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("every_1_ms.recurence=2ms", "did you mean 'every_1_ms.recurrence'?"),
        ("every_2_ms.recurrence=2ms", "unknown object 'every_2_ms'; did you mean 'every_20_ms' or 'every_1_ms'?"),
        ("every_1_ms.recurrence=2", "has no unit; write a time such as '10 ms'"),
        ("recurrence=2ms", "means several values of the model: every_1_ms.recurrence, every_20_ms.recurrence; choose one"),
        ("Executor_Task_Runnable.value=many", "'many' is not a whole number"),
        ("Clock.default_value=fast", "is not a frequency such as '50 Hz'"),
        ("Executor_Task.stimuli=every_2_ms", "is not the name of a Stimulus; did you mean 'every_20_ms'"),
        ("Executor_Task_Runnable.access=look", "'look' is not one of read, write"),
    ],
)
def test_what_cannot_be_set_is_explained(change, words):
    with pytest.raises(InvalidArgumentError) as error:
        open_changed(EXECUTOR, changes=[change])
    assert words in str(error.value)


def test_a_change_of_the_model_and_one_of_the_system_act_together(tmp_path):
    model = amuros.load(EXECUTOR)
    found = amuros.what_if(model, {"Executor_Task_Runnable.value": 20, "Control_Function.priority": 9})
    found.save(tmp_path / "both.amxmi")
    assert amuros.extract(amuros.load(tmp_path / "both.amxmi")).system == found.system
    assert [str(each) for each in found.differences] == [
        "Executor_Task_Runnable.value: 12 -> 20",
        "Control_Function.priority: 2 -> 9",
        "Executor_Task_Runnable.execution_time: 12 us -> 20 us (consequence)",
    ]
    assert amuros.extract(model).system == amuros.extract(amuros.load(EXECUTOR)).system


def test_attributes_are_swept_and_offered():
    """At 1 MHz a tick is 1 us, and the task runs every millisecond."""
    swept = amuros.sweep(EXECUTOR, ["Executor_Task_Runnable.value=100..300/100"], workers=2)
    loads = [row["Executor_Task.worst_case_response_time_ps"] for row in swept.rows]
    assert loads == [100 * 10**6, 200 * 10**6, 300 * 10**6]
    found = amuros.optimize(EXECUTOR, vary=(), goals=["load"], offers=["Executor_Task_Runnable.value=8,20"], is_complete=True)
    assert [str(each) for each in found[0].differences] == ["Executor_Task_Runnable.value: 12 -> 8"]
    assert found.search.conclusion == "optimal"


def test_keys_are_listed_by_a_part_of_their_names():
    assert {each.name: each.value for each in keys(EXECUTOR, matching="every_20")} == {
        "every_20_ms.period": "20 ms",
        "every_20_ms.offset": "0 s",
        "every_20_ms.jitter": "0 s",
        "every_20_ms.tags": "not set",
        "every_20_ms.recurrence": "20 ms",
        "every_20_ms.min_distance": "not set",
    }


# Any key of any model, against the file with another text in the same place


@cache
def paths():
    """Models of several versions and authors."""
    samples = (SAMPLES / name for name in ("executor.amxmi", "pump-1.2.0.amxmi", "drive-and-lift.amxmi"))
    return [*samples, *(case.values[0] for case in hand_written() if not case.marks)]


@cache
def opened(number):
    model = amuros.load(paths()[number])
    found = tuple(keys_of(model))
    return open_changed(model), found, short_names(found, found)


def same(name):
    return name.replace("_", "").casefold()


def node_of(tree, path):
    """The XML element at the end of a path of features and numbers."""
    steps = [*path, None]
    for step, following in zip(path, steps[1:], strict=True):
        if isinstance(step, str):
            inside = [child for child in tree if same(child.tag) == same(step)]
            tree = inside[following] if isinstance(following, int) else inside[0]
    return tree


def edited(path, key, value):
    """The text of a file with another value; None where it is not stated there now."""
    text = path.read_text(encoding="utf-8")
    for prefix, uri in (pair for _, pair in ElementTree.iterparse(path, events=["start-ns"])):
        ElementTree.register_namespace(prefix, uri)
    root = ElementTree.fromstring(text)
    try:
        if isinstance(value, tuple):
            node = node_of(root, key.path)
            node.attrib |= {"value": value[0]} | ({"unit": value[1]} if value[1] else {})
        else:
            holder = node_of(root, key.path[:-1])
            (name,) = (each for each in holder.attrib if same(each) == same(key.path[-1]))
            holder.set(name, value)
    except (IndexError, ValueError):
        return None
    return ElementTree.tostring(root, encoding="unicode")


def values_for(key, text):
    """Pairs of a value as in the file and as it is written in a change."""
    present = None if key.part is not None else key.holder.__dict__.get(key.feature.name)
    if key.part is not None:
        unit = getattr(key.part, "unit", None)
        if hasattr(key.part, "unit") and str(unit) in ("None", "_undefined_"):
            return []  # a number without a unit is refused
        numbers = ("1", "7", "20")
        return [((number, unit or ""), f"{number} {str(unit or '').replace('PerSecond', '/s')}".strip()) for number in numbers]
    if key.feature.is_reference:
        kinds = [each.partition("?type=")[2] for each in text.split('"') if "?type=" in each and " " not in each]
        wanted = f"?type={kinds[0]}" if kinds else None
        references = {each for each in text.split('"') if wanted and each.endswith(wanted)}
        return [(each, unquote_plus(each.partition("?")[0].rpartition("/")[2])) for each in sorted(references)]
    if isinstance(present, bool):
        return [("true", "true"), ("false", "false")]
    if isinstance(present, int):
        return [(number, number) for number in ("1", "3", "50")]
    if isinstance(present, float):
        return [("2.5", "2.5")]
    literals = (
        [] if present is None else [str(each) for each in type(present)] if hasattr(type(present), "__members__") else ["x"]
    )
    return [(each, each) for each in literals]


@st.composite
def changes(draw):
    number = draw(st.integers(0, len(paths()) - 1))
    _, found, _ = opened(number)
    stated = [key for key in found if key.part is not None or key.holder.__dict__.get(key.feature.name) is not None]
    assume(stated)
    key = draw(st.sampled_from(stated))
    text = paths()[number].read_text(encoding="utf-8")
    values = values_for(key, text)
    assume(values)
    return number, key, *draw(st.sampled_from(values))


def system_of(text):
    with TemporaryDirectory() as folder:
        path = Path(folder, "edited.amxmi")
        path.write_text(text, encoding="utf-8")
        model = amuros.load(path)
        invalid = [each for each in model.findings if each.rule.startswith("XMI")]
        return None if invalid else amuros.extract(model).system


@examples(60)
@given(changes())
def test_setting_any_attribute_is_editing_the_file(case):
    number, key, written, said = case
    changed, found, names = opened(number)
    assert matching(names[key], found) == [key]
    text = edited(paths()[number], key, written)
    assume(text is not None)
    by_hand = system_of(text)
    assume(by_hand is not None)
    name, _, last = names[key].rpartition(".")
    if changed.origin.divided([Change(name, last, said)]).attributes:
        assert changed.origin.configure([Change(name, last, said)]).system == by_hand
