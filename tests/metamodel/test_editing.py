"""Models that are made and changed in one line for each object."""

import pytest

import amalthea_uros as amuros
from amalthea_uros import am
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS


@pytest.fixture
def model():
    made = amuros.Model.new()
    made.add_core("Core_0", frequency="100 MHz")
    made.add_label("speed", size="4 B")
    made.add_task("Control", period="1 ms", wcet="20 us", priority=2, deadline="1 ms", writes=["speed"])
    made.add_task("Slow", period="10 ms", wcet="1 ms", priority=1, reads=["speed"])
    made.add_chain("speed-used", ["Control", "Slow"], reaction="25 ms")
    return made


def responses(model):
    return {process.name: process.response.worst for process in amuros.analyze(model).processes}


def test_saved_and_loaded_it_has_the_response_times_computed_by_hand(model, tmp_path):
    amuros.save(model, tmp_path / "made.amxmi")
    loaded = amuros.load(tmp_path / "made.amxmi")
    # Slow: 1 ms of its own, and the jobs of Control at 0 and 1 ms.
    assert responses(loaded) == {"Control": 20 * US, "Slow": 1 * MS + 2 * 20 * US}
    analysis = amuros.analyze(loaded)
    assert analysis.requirements["Control_response_time"].limit == 1 * MS
    assert analysis.chains["speed-used"].value(amuros.LatencyQuantity.MAX_REDUCED_REACTION_TIME).value is not None


def test_it_has_no_errors_for_any_tool(model, tmp_path):
    amuros.save(model, tmp_path / "made.amxmi")
    settings = amuros.CheckSettings(profiles=["app4mc", "inchron", "timing"])
    found = amuros.check_files(tmp_path / "made.amxmi", settings).findings
    assert [finding for finding in found if finding.severity is amuros.Severity.ERROR] == []
    assert {finding.rule for finding in found} <= {"INC-CO-KIND", "INC-SW-TICKS-BOUNDS", "TA-Hardware-PUDIPCMissing"}


def test_a_period_and_a_priority_are_changed_in_one_line(model):
    model.set_period("Control", "500 us")
    model.set_priority("Slow", 3)
    assert responses(model) == {"Control": 1020 * US, "Slow": 1 * MS}


def test_a_task_that_shares_its_stimulus_gets_its_own():
    model = amuros.Model.new()
    model.add_core("Core_0", frequency="1 MHz")
    one, other = (model.add_task(name, period="10 ms", wcet="1 ms") for name in "AB")
    assert one.stimuli[0] is other.stimuli[0]
    model.set_period(one, "20 ms")
    periods = [task.stimuli[0].recurrence.value for task in (one, other)]
    assert periods == [20, 10]


def test_execution_times_are_rounded_to_the_safe_side():
    model = amuros.Model.new()
    model.add_core("Core_0", frequency="1 MHz")
    model.add_task("A", period="1 ms", bcet="1.5 us", wcet="2.5 us", priority=1)
    ticks = next(model.all(am.Ticks)).default
    assert (ticks.lower_bound, ticks.upper_bound) == (1, 3)


def test_without_priorities_bounds_hold_for_any_order():
    model = amuros.Model.new()
    model.add_core("Core_0", frequency="1 MHz")
    for name in "AB":
        model.add_task(name, period="1 ms", wcet="1 us")
    # Whichever is the lower one waits for the other.
    assert [process.response.worst for process in amuros.analyze(model).processes] == [2_000_000, 2_000_000]


def test_it_works_on_models_of_others():
    built = amuros.build_model(amuros.taskset([(10, 1)], unit="ms", priorities="rate monotonic"))
    built.set_priority("T1", 7)
    assert amuros.extract(built).system.mapping.tasks[0].priority == 7
    with pytest.raises(amuros.InvalidArgumentError, match="not activated by exactly one periodic stimulus"):
        built.set_period("T1", "5 ms")


WRONG = {
    "a core twice": (lambda m: m.add_core("Core_0", frequency="1 MHz"), "already has a ProcessingUnit 'Core_0'"),
    "a task twice": (lambda m: m.add_task("Slow", period="1 ms", wcet="1 us"), "already has a Task 'Slow'"),
    "a label twice": (lambda m: m.add_label("speed", size="4 B"), "already has a Label 'speed'"),
    "a chain twice": (lambda m: m.add_chain("speed-used", ["Control", "Slow"]), "already has an EventChain 'speed-used'"),
    "no unit": (lambda m: m.add_task("X", period="1", wcet="1 us"), "X: period: '1' has no unit"),
    "a number": (lambda m: m.add_task("X", period=1, wcet="1 us"), "expected a text with a unit"),
    "frequency 0": (lambda m: m.add_core("X", frequency="0 Hz"), "X: frequency: '0 Hz' is not positive"),
    "bcet above wcet": (lambda m: m.add_task("X", period="1 ms", wcet="1 us", bcet="2 us"), "bcet 2 us exceeds the wcet 1 us"),
    "a task twice in a chain": (lambda m: m.add_chain("c", ["Slow", "Slow"]), "a task occurs twice"),
    "a name that is no text": (lambda m: m.add_task(5, period="1 ms", wcet="1 us"), "must be a text, not 5"),
    "a frequency without unit": (lambda m: m.add_core("X", frequency=100), "such as '100 MHz', not 100"),
    "a short chain": (lambda m: m.add_chain("c", ["Slow"]), "at least two tasks"),
    "a wrong priority": (lambda m: m.set_priority("Slow", "high"), "must be a whole number, not 'high'"),
    "an unknown preemption": (
        lambda m: m.add_task("X", period="1 ms", wcet="1 us", preemption="never"),
        "unknown preemption 'never'; expected one of preemptive",
    ),
    "no core": (lambda m: amuros.Model.new().add_task("X", period="1 ms", wcet="1 us"), "add one with add_core() first"),
}


@pytest.mark.parametrize(("use", "message"), WRONG.values(), ids=WRONG)
def test_wrong_values_change_nothing(use, message, model):
    before = len(list(model.walk()))
    with pytest.raises(amuros.InvalidArgumentError) as raised:
        use(model)
    assert message in str(raised.value)
    assert len(list(model.walk())) == before


def test_unknown_names_list_similar_ones(model):
    with pytest.raises(KeyError, match="did you mean 'speed'"):
        model.add_task("X", period="1 ms", wcet="1 us", reads=["sped"])


def test_objects_have_short_texts(model):
    assert repr(model) == f"<Model unsaved, AMALTHEA 3.3.0, {len(list(model.walk()))} objects>"
    assert repr(model[am.Task, "Control"]) == "<Task 'Control', every 1 ms, priority 2>"
    assert repr(am.Task()) == "<Task>"
    assert len(repr(amuros.extract(model).system)) < 100


def test_texts_of_wrong_values_do_not_fail():
    task = am.Task(name="A")
    task.__dict__["stimuli"] = [None, am.PeriodicStimulus()]
    assert repr(task).startswith("<Task 'A', ")
    task.__dict__["stimuli"] = 3
    assert repr(task) == "<Task 'A', ...>"
    assert repr(am.PeriodicStimulus()) == "<PeriodicStimulus, every ?>"
