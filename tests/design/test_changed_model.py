"""A changed system as a model: of a model that was read only the changed values differ, and it means the changed system."""

from pathlib import Path

import pytest
from effort import IS_THOROUGH, every
from support import MODEL, ROOT

import amalthea_uros as amuros
from amalthea_uros.analyze.impact import figures
from amalthea_uros.design.changes.kinds import KINDS
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.timing.basics.settings import Settings

SAMPLES = ROOT / "samples"
#: A value for each key that no sample has; what depends on the names of a model is in `value_for`.
VALUES = {
    "period": "7 ms",
    "offset": "1 ms",
    "jitter": "3 us",
    "execution_time": "17 ticks",
    "priority": "9",
    "deadline": "3 ms",
    "preemption": "cooperative",
    "activation_limit": "3",
    "frequency": "123 MHz",
    "capacity": "1 ms",
    "budget": "1 ms",
    "phase": "0 s",
    "arrival_period": "33 ms",
    "arrival_jitter": "2 us",
}


def value_for(key, system):
    names = {"core": system.cores, "scheduler": system.schedulers, "controller": system.interrupt_controllers}
    return [*names[key]][-1] if key in names else VALUES.get(key, "1")


def changes_of(system):
    """A change of each key of the first object of each kind."""
    for kind in KINDS:
        for name in list(kind.objects(system))[:1]:
            for key in kind.keys:
                yield f"{name}.{key}", value_for(key, system)


@pytest.mark.parametrize(
    "name", every(2, ["executor.amxmi", "bodas-test-advanced.amxmi", "pump-1.2.0.amxmi", "drive-and-lift.amxmi"])
)
def test_each_key_changes_only_its_value(name, tmp_path):
    path, target = SAMPLES / name, tmp_path / "changed.amxmi"
    system = amuros.extract(amuros.load(path)).system
    written = 0
    for changed, value in every(5, list(changes_of(system))):
        try:
            found = amuros.what_if(path, {changed: value})
        except InvalidArgumentError:
            continue  # the object has no place for such a value
        try:
            found.save(target)
        except InvalidArgumentError as refused:
            assert "cannot represent the scheduling parameter 'deadline'" in str(refused)  # noqa: PT017
            assert name == "pump-1.2.0.amxmi"
            continue
        # A value, its definition, a stimulus of its own: never more than a few objects.
        assert len(amuros.diff(path, target).changes) <= 5, changed
        after = [(figure.key, figure.compared) for figure in figures(amuros.analyze_files(target).analysis)]
        assert after == [(figure.key, figure.compared) for figure in figures(found.after)], changed
        written += 1
    assert written > (8 if IS_THOROUGH else 1)


def test_only_the_lines_of_the_value_differ(tmp_path):
    path, target = SAMPLES / "executor.amxmi", tmp_path / "changed.amxmi"
    amuros.what_if(path, ["Control_Function.priority=7"]).save(target)
    old, new = path.read_text().splitlines(), target.read_text().splitlines()
    ((_, different),) = [(one, other) for one, other in zip(old, new, strict=True) if one != other]
    assert 'value="7"' in different
    # The value that is there already.
    amuros.what_if(path, ["Control_Function.priority=2"]).save(target)
    assert target.read_bytes() == path.read_bytes()


def test_a_time_in_another_unit_is_replaced_with_its_unit(tmp_path):
    path, target = tmp_path / "units.amxmi", tmp_path / "changed.amxmi"
    text = (SAMPLES / "executor.amxmi").read_text()
    assert '<recurrence value="1" unit="ms"/>' in text
    path.write_text(text.replace('<recurrence value="1" unit="ms"/>', '<recurrence value="1000" unit="us"/>'))
    amuros.what_if(path, ["Executor_Task.period=5ms", "Control_Function.period=5ms"]).save(target)
    system = amuros.extract(amuros.load(target)).system
    periods = {
        system.stimuli_by_name[system.processes[name].stimuli[0]].period for name in ("Executor_Task", "Control_Function")
    }
    assert periods == {5 * 10**9}


def test_a_clock_that_others_have_is_copied(tmp_path):
    path, target = SAMPLES / "drive-and-lift.amxmi", tmp_path / "changed.amxmi"
    amuros.what_if(path, ["Core_0.frequency=200MHz"]).save(target)
    system = amuros.extract(amuros.load(target)).system
    clocks = {name: system.clocks[core.clock].frequency for name, core in system.cores.items() if core.clock}
    assert clocks["Core_0"] == 200 * 10**6
    assert clocks["Core_1"] == 300 * 10**6


def test_a_frequency_that_a_setting_has_already_is_written_if_it_is_set(tmp_path):
    """A setting is not part of the model, but a change is."""
    settings, target = Settings(frequencies={"Core_0": "3 MHz"}), tmp_path / "changed.amxmi"
    amuros.what_if(SAMPLES / "executor.amxmi", ["Core_0.frequency=3MHz"], settings).save(target)
    (clock,) = amuros.extract(amuros.load(target)).system.clocks.values()
    assert clock.frequency == 3 * 10**6


def test_a_description_and_a_system_become_the_model_of_the_changed_system(tmp_path):
    path, target = SAMPLES / "bodas-test-simple.yaml", tmp_path / "changed.amxmi"
    found = amuros.what_if(path, {"Control_Function.priority": "7"})
    found.save(target)
    assert amuros.extract(amuros.load(target)).system == found.system
    amuros.what_if(found.system, {}).save(target)
    assert amuros.extract(amuros.load(target)).system == found.system


def test_the_model_of_the_caller_stays_as_it_is(tmp_path):
    path, target = SAMPLES / "executor.amxmi", tmp_path / "changed.amxmi"
    model = amuros.load(path)
    amuros.what_if(model, ["Control_Function.priority=7"]).save(target)
    amuros.save(model, tmp_path / "model.amxmi")
    assert Path(tmp_path / "model.amxmi").read_bytes() == path.read_bytes()
    assert amuros.diff(model, target).timing[0].differences[0].after == "7"


def test_what_cannot_be_written_is_refused_before_anything_is(tmp_path):
    found = amuros.what_if(SAMPLES / "pump-1.2.0.amxmi", ["Control.deadline=3ms"])
    with pytest.raises(InvalidArgumentError, match=r"AMALTHEA 1[.]2[.]0 cannot represent the scheduling parameter 'deadline'"):
        found.save(tmp_path / "changed.amxmi")
    with pytest.raises(InvalidArgumentError, match="written as an AMALTHEA model, not as a description"):
        found.save(tmp_path / "app.yaml")
    # A file that is migrated while it is read would be in another version, so that more than the changed value would differ.
    path = tmp_path / "old.amxmi"
    task = '<swModel><tasks name="T" multipleTaskActivationLimit="1"/></swModel>'
    path.write_text(MODEL.replace("3.3.0", "0.9.5").format(task))
    changed = amuros.what_if(path, ["T.activation_limit=3"])
    with pytest.raises(InvalidArgumentError, match=r"AMALTHEA 0[.]9[.]5 is not written with other values; migrate it first"):
        changed.save(tmp_path / "changed.amxmi")
    assert [file.name for file in tmp_path.iterdir()] == ["old.amxmi"]


def test_a_model_of_several_files_is_refused(tmp_path):
    model = amuros.load(SAMPLES / "executor.amxmi")
    stimuli = amuros.Document(amuros.am.Amalthea(stimuli_model=model.root.stimuli_model), path=tmp_path / "stimuli.amxmi")
    model.documents[0].path = tmp_path / "rest.amxmi"
    amuros.save(amuros.Model([*model.documents, stimuli]))
    found = amuros.what_if([tmp_path / "rest.amxmi", tmp_path / "stimuli.amxmi"], ["Control_Function.priority=7"])
    with pytest.raises(InvalidArgumentError, match="the model has 2 files, but the changed model is written to one file"):
        found.save(tmp_path / "changed.amxmi")
