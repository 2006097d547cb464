"""Wrong use of the library says what was expected."""

import pytest
from support import DATA, ROOT

import amalthea_uros as amuros
from amalthea_uros import am
from amalthea_uros.services.analyze import chain_detail
from amalthea_uros.services.chains import add_path, find_paths
from amalthea_uros.services.explain import explain

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"


@pytest.fixture(scope="module")
def model():
    return amuros.load(DATA / "brake.amxmi")


@pytest.fixture(scope="module")
def result():
    return amuros.analyze_files(ADVANCED)


WRONG_TYPES = {
    "a model instead of a system": (lambda m: amuros.analyze_system(m), r"not Model; extract\(model\).system"),
    "a path instead of a system": (lambda m: amuros.sensitivity("app.yaml"), r"not str; analyze\(\.\.\.\) makes one"),
    "a model instead of its analysis": (
        lambda m: amuros.propose_priorities(m),
        r"not Model; analyze\(\.\.\.\) makes one",
    ),
    "a name without a class": (lambda m: m["Brake (left)"], r"model\[am.Task, 'Brake \(left\)'\]"),
    "one rule instead of a list": (lambda m: amuros.check(m, "TIM-WAIT"), r"rules must be a list, e.g. \['TIM-WAIT'\]"),
    "a path instead of a model": (lambda m: amuros.check("app.amxmi"), r"not str; use check_files\(\)"),
    "one selected rule": (lambda m: amuros.CheckSettings(select="TIM-*"), r"select must be a list, e.g. \['TIM-\*'\]"),
    "an unknown communication": (lambda m: amuros.Settings(communication="foo"), "'foo'; expected one of .*Communication.LET"),
    "an unknown memory": (lambda m: amuros.Settings(memory="slow"), "'slow'; expected one of MemoryModel.NONE"),
    "a text instead of a number": (lambda m: am.Time("2 ms"), r"e.g. Time\(2, 'ms'\), not the text '2 ms'; parse_time\(\)"),
}


@pytest.mark.parametrize(("use", "message"), WRONG_TYPES.values(), ids=WRONG_TYPES)
def test_wrong_types(use, message, model):
    with pytest.raises(TypeError, match=message):
        use(model)


WRONG_VALUES = {
    "a rule that does not exist": (
        lambda r: amuros.check(amuros.load(DATA / "brake.amxmi"), ["TIM-X"]),
        "unknown rule 'TIM-X'",
    ),
    "a profile that does not exist": (
        lambda r: amuros.CheckSettings(profiles=["inchrn"]),
        "'inchrn'; expected .*inchron",
    ),
    "a severity that does not exist": (
        lambda r: amuros.CheckSettings(fail_on="never"),
        "'never'; expected one of error, warning",
    ),
    "a core that does not exist": (
        lambda r: amuros.analyze_files(ADVANCED, amuros.Settings(frequencies={"Core_1": "1 Hz"})),
        "unknown core 'Core_1'; did you mean 'Core_0'",
    ),
    "a process that does not exist": (
        lambda r: explain(r, "Control"),
        "unknown process, callback or chain 'Control'; did you mean",
    ),
    "a chain that does not exist": (lambda r: chain_detail(r, "x"), "unknown chain 'x'; known: factor-to-output"),
    "an end that does not exist": (lambda r: find_paths(ADVANCED, "Nothing", "Executor_Task"), "'Nothing'"),
    "a description that is not rewritten": (
        lambda r: add_path(find_paths(ADVANCED, "Executor_Task", "Control_Function"), 1, "c", "x.yaml"),
        r"path: \[Executor_Task, Message_Factor, Control_Function\]",
    ),
    "no path at all": (lambda r: amuros.check_files([]), "no path given"),
}


@pytest.mark.parametrize(("use", "message"), WRONG_VALUES.values(), ids=WRONG_VALUES)
def test_wrong_values(use, message, result):
    with pytest.raises(ValueError, match=message):
        use(result)


def test_results_are_found_by_name_index_and_iteration(result):
    processes = result.analysis.processes
    control = result.analysis["Control_Function"]
    assert control.name == "Control_Function"
    assert processes["Control_Function"] is control is processes[processes.names.index("Control_Function")]
    assert [process.name for process in processes] == list(processes.names)
    assert result.analysis.chains["factor-to-output"] is result.analysis.chains[0] is result.analysis.chains[-1]
    assert processes[1:] == tuple(processes)[1:]
    with pytest.raises(KeyError, match="no result named 'Control_Functions'; did you mean 'Control_Function'"):
        processes["Control_Functions"]
    with pytest.raises(KeyError, match="known: Core_0"):
        result.analysis.processors["x"]


@pytest.mark.parametrize(
    ("name", "advice"),
    [
        ("Task", "is amalthea_uros.am.Task"),
        ("anlyze_system", "did you mean 'analyze_system'"),
        ("Tsk", "no attribute"),
    ],
)
def test_a_name_that_is_elsewhere(name, advice):
    with pytest.raises(AttributeError, match=advice):
        getattr(amuros, name)


def test_the_tools_own_classes_are_not_hidden_by_those_of_amalthea():
    assert amuros.Severity.WARNING == "warning"
    assert amuros.System is amuros.perf.System is not am.System
    assert amuros.MemoryModel is not am.Memory
    assert amuros.LatencyValue is not am.Value
