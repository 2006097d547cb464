"""A text where several can be given is one of them, not its letters; where a list is needed, that is said."""

import inspect
import re

import pytest
from support import DATA, ROOT

import amalthea_uros as amuros
from amalthea_uros.simulate.options import Options

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
LOG = ROOT / "samples" / "bodas-test-measured.log"
MARKERS = ROOT / "samples" / "bodas-test-measured.markers.yml"
SOURCE = next((ROOT / "samples" / "sources").rglob("*.c"))
TASKS = [amuros.task("A", period="10 ms", wcet="1 ms")]


def compared(by):
    return amuros.compare(ADVANCED, amuros.measure(LOG, markers=MARKERS), by=by).rows


def measured(path, **options):
    return [(series.name, len(series.values)) for series in amuros.measure(path, **options).series]


def optimized(**options):
    search = amuros.optimize(ADVANCED, designs=20, **options)
    return search.limits, search.goals, [proposal.changes for proposal in search.proposals]


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "times.csv"
    path.write_text("a_us,b_us\n1,2\n2,3\n")
    return path


CAMPAIGN = Options(duration="5 ms")
#: Function and parameter -> what a text means for it.
ACCEPTED = {
    "analyze(changes)": (lambda given: amuros.analyze(ADVANCED, changes=given).processes, "Control_Function.priority=1"),
    "analyze_files(paths)": (lambda given: amuros.analyze_files(given).paths, str(ADVANCED)),
    "analyze_files(changes)": (
        lambda given: amuros.analyze_files(ADVANCED, changes=given).differences,
        "Control_Function.priority=1",
    ),
    "check_files(paths)": (lambda given: amuros.check_files(given).paths, str(ADVANCED)),
    "compare(by)": (compared, "analysis"),
    "compare(changes)": (
        lambda given: amuros.compare(ADVANCED, amuros.measure(LOG, markers=MARKERS), by="analysis", changes=given).differences,
        "Control_Function.priority=1",
    ),
    "import_code(paths)": (lambda given: amuros.import_code(given).text, str(SOURCE)),
    "load(paths)": (lambda given: len(amuros.load(given).documents), str(DATA / "brake.amxmi")),
    "measure(select)": (lambda given: measured(LOG, markers=MARKERS, select=given), "Control_Function"),
    "migrate(source)": (lambda given: amuros.migrate(given).files, str(DATA / "brake.amxmi")),
    "optimize(limits)": (lambda given: optimized(limits=given), "factor-to-output.max_reduced_reaction_time<=20ms"),
    "optimize(goals)": (lambda given: optimized(goals=given), "load"),
    "optimize(vary)": (lambda given: optimized(vary=given), "periods"),
    "optimize(offers)": (lambda given: optimized(offers=given), "Control_Function.offset=0ms..0.9ms/0.3ms"),
    "optimize(keep)": (lambda given: optimized(keep=given), "Control_Function"),
    "report(changes)": (
        lambda given: str(amuros.report(ADVANCED, changes=given, with_simulation=False)),
        "Control_Function.priority=1",
    ),
    "simulate(changes)": (
        lambda given: amuros.simulate(ADVANCED, "5 ms", changes=given).processes,
        "Control_Function.priority=1",
    ),
    "simulate(labels)": (lambda given: amuros.simulate(ADVANCED, "5 ms", labels=given).labels, "output"),
    "Options(labels)": (lambda given: Options(duration="5 ms", labels=given), "output"),
    "simulate_files(paths)": (lambda given: amuros.simulate_files(given, CAMPAIGN).paths, str(ADVANCED)),
    "simulate_files(changes)": (
        lambda given: amuros.simulate_files(ADVANCED, CAMPAIGN, changes=given).differences,
        "Control_Function.priority=1",
    ),
    "simulate_campaign(paths)": (lambda given: amuros.simulate_campaign(given, CAMPAIGN, workers=1).paths, str(ADVANCED)),
    "simulate_campaign(changes)": (
        lambda given: amuros.simulate_campaign(ADVANCED, CAMPAIGN, changes=given, workers=1).differences,
        "Control_Function.priority=1",
    ),
    "simulate_campaign(sweeps)": (
        lambda given: amuros.simulate_campaign(ADVANCED, CAMPAIGN, sweeps=given, workers=1).planned,
        "Control_Function.priority=1,2",
    ),
    "sweep(sweeps)": (lambda given: len(amuros.sweep(ADVANCED, given).outcomes), "Control_Function.priority=1,2"),
    "sweep(changes)": (
        lambda given: amuros.sweep(ADVANCED, "Control_Function.priority=1,2", changes=given).differences,
        "Control_Function.offset=0ms",
    ),
    "Sweep(values)": (lambda given: amuros.Sweep("Task", "period", given), "1 ms"),
    "what_if(changes)": (lambda given: amuros.what_if(ADVANCED, given).differences, "Control_Function.priority=1"),
}


@pytest.mark.parametrize(("use", "text"), ACCEPTED.values(), ids=ACCEPTED)
def test_a_text_alone_is_one_of_several(use, text):
    assert use(text) == use([text])


def test_a_column_alone(table):
    assert measured(table, columns="a_us=A") == measured(table, columns=["a_us=A"]) == [("A", 2)]


@pytest.mark.parametrize("form", ["btf", "csv"])
def test_a_trace_alone(form, tmp_path):
    path = str(tmp_path / f"trace.{form}")
    amuros.simulate(ADVANCED, "5 ms", trace_paths=path)
    one = amuros.measure(path).series
    amuros.simulate_files(ADVANCED, CAMPAIGN, trace_paths=path)
    assert one
    assert amuros.calibrate(ADVANCED, path).values == amuros.calibrate(ADVANCED, [path]).values


def test_a_fit_alone():
    with pytest.raises(amuros.InvalidArgumentError) as alone:
        amuros.calibrate(ADVANCED, LOG, fits="agent")
    with pytest.raises(amuros.InvalidArgumentError) as listed:
        amuros.calibrate(ADVANCED, LOG, fits=["agent"])
    assert str(alone.value) == str(listed.value)


REFUSED = {
    "check(rules)": lambda: amuros.check(amuros.load(DATA / "brake.amxmi"), "TIM-WAIT"),
    "CheckSettings(profiles)": lambda: amuros.CheckSettings(profiles="inchron"),
    "CheckSettings(select)": lambda: amuros.CheckSettings(select="TIM-*"),
    "CheckSettings(ignore)": lambda: amuros.CheckSettings(ignore="TIM-*"),
    "CheckSettings(targets)": lambda: amuros.CheckSettings(targets="inchron"),
    "taskset(chains)": lambda: amuros.taskset(TASKS, chains={"a": "A"}),
    "method_bounds(methods)": lambda: amuros.method_bounds(ADVANCED, "mine"),
    "taskset(tasks)": lambda: amuros.taskset("A"),
}


@pytest.mark.parametrize("use", REFUSED.values(), ids=REFUSED)
def test_a_text_instead_of_a_list_is_refused_in_words(use):
    with pytest.raises((TypeError, amuros.InvalidArgumentError), match=r"a list|expected"):
        use()


#: Those that are tried above in another way, and those that take no texts: objects that results are made of.
OTHERS = {
    "calibrate(fits)",
    "calibrate(trace)",
    "measure(columns)",
    "simulate(trace_paths)",
    "simulate_files(trace_paths)",
    "write_table(rows)",
    "EventTable(entities)",
    "Model(documents)",
}
#: What only amuros makes, with one parameter for each attribute.
_MANY = re.compile(r"Iterable\[|Sequence\[|\bChanges\b|\bSweeps\b")


def test_every_parameter_for_several_is_tried():
    """Exceptions and results are made by amuros itself."""
    found = set()
    for name in amuros.__all__:
        value = getattr(amuros, name)
        if inspect.isfunction(value) or (inspect.isclass(value) and not issubclass(value, Exception)):
            parameters = inspect.signature(value).parameters.values()
            found |= {f"{name}({each.name})" for each in parameters if _MANY.search(str(each.annotation))}
    assert found <= {*ACCEPTED, *REFUSED, *OTHERS}
