"""The steps that a command takes grow with the size of its input, not with its square, also for inputs that are all mistakes."""

import pytest

from amalthea_uros import build, calibrate, diff, load, measure, report, simulate, sweep
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.check import check_files
from amalthea_uros.services.format import format_files
from tests.growth import SIZES, growth

START = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0" '
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmi:version="2.0"><swModel>'
)
CALL = '<items xsi:type="am:RunnableCall" runnable="{}?type=Runnable"/>'


def repeated(text, count, separator=""):
    return separator.join(text.replace("#", str(number)) for number in range(count))


#: The content of the software model of a size.
CONTENTS = {
    "dangling references of one object": lambda n: (
        f'<tasks name="T" stimuli="{repeated("None#?type=PeriodicStimulus", n, " ")}"/>'
    ),
    "dangling references in one list": lambda n: (
        f'<runnables name="R"><activityGraph>{repeated(CALL.format("None#"), n)}</activityGraph></runnables>'
    ),
    "references to equal names": lambda n: (
        f'<runnables name="R"/><runnables name="R"><activityGraph>{CALL.format("R") * n}</activityGraph></runnables>'
        + '<runnables name="R"/>' * n
    ),
    "unknown attributes of one object": lambda n: '<labels name="L" ' + repeated('none#="1"', n, " ") + "/>",
    "unknown attributes of many objects": lambda n: repeated('<labels name="L#" none#="1"/>', n),
    "unknown elements": lambda n: repeated("<none#/>", n),
    "wrong values": lambda n: repeated('<labels name="L#" constant="none#"/>', n),
    "equal names": lambda n: '<labels name="L"/>' * n,
    "wrong ids": lambda n: repeated('<labels name="L#" xmi:id="none#"/>', n),
}
#: They add no rules to those that other contents fire.
READ_ONLY = {"dangling references of one object", "wrong ids"}
CHECKED = [name for name in CONTENTS if name not in READ_ONLY]
FORMATTED = ("dangling references in one list", "unknown attributes of many objects")


DESCRIPTION = "amuros: 1\nname: x\n"
NODE = DESCRIPTION + "application: {nodes: [{name: n, timers: ["
TIMER = "{name: t#, period: 10 ms, execution_time: 1 us}"
#: Descriptions of a size.
DESCRIPTIONS = {
    "unknown keys": lambda n: DESCRIPTION + repeated("none#: 1\n", n),
    "decimal commas": lambda n: f"{DESCRIPTION}hardware: {{cores: 1, {repeated('# ms', n, ', ')}}}\n",
    "wrong values": lambda n: f"{NODE}{repeated('{name: t#, period: often, execution_time: 1 us}', n, ', ')}]}}]}}\n",
    "equal names": lambda n: f"{NODE}{repeated(TIMER.replace('t#', 't'), n, ', ')}]}}]}}\n",
    "many timers": lambda n: f"{NODE}{repeated(TIMER, n, ', ')}]}}]}}\n",
}


def files(folder, content, suffix=".amxmi"):
    """Files of the sizes."""
    paths = [folder / f"{size}{suffix}" for size in SIZES]
    for path, size in zip(paths, SIZES, strict=True):
        path.write_text(f"{START}{content(size)}</swModel></am:Amalthea>\n" if suffix == ".amxmi" else content(size))
    return paths


@pytest.mark.parametrize("name", CONTENTS)
def test_reading(name, tmp_path):
    assert growth(load, files(tmp_path, CONTENTS[name])) < 2.5


@pytest.mark.parametrize("name", CHECKED)
def test_checking(name, tmp_path):
    assert growth(lambda path: check_files([path]), files(tmp_path, CONTENTS[name])) < 2.5


def system(count):
    """The rest of a model: each task on a core of its own."""
    schedulers = repeated('<taskSchedulers name="S#"/>', count)
    modules = '<modules xsi:type="am:ProcessingUnit" name="C#" definition="D?type=ProcessingUnitDefinition"/>'
    allocation = (
        '<schedulerAllocation scheduler="S#?type=TaskScheduler" responsibility="C#?type=ProcessingUnit"/>'
        '<taskAllocation task="T#?type=Task" scheduler="S#?type=TaskScheduler"/>'
    )
    return (
        repeated('<tasks name="T#" stimuli="P?type=PeriodicStimulus"><activityGraph/></tasks>', count)
        + '</swModel><hwModel><definitions xsi:type="am:ProcessingUnitDefinition" name="D"/>'
        f'<structures name="E">{repeated(modules, count)}</structures></hwModel>'
        f'<osModel><operatingSystems name="O">{schedulers}</operatingSystems></osModel>'
        '<stimuliModel><stimuli xsi:type="am:PeriodicStimulus" name="P">'
        '<recurrence value="10" unit="ms"/></stimuli></stimuliModel>'
        f"<mappingModel>{repeated(allocation, count)}</mappingModel><swModel>"
    )


@pytest.mark.parametrize(
    "action", [lambda path: check_files([path]), lambda path: analyze_files([path])], ids=["check", "analyze"]
)
def test_many_cores(action, tmp_path):
    assert growth(action, files(tmp_path, system)) < 2.5


@pytest.mark.parametrize("name", FORMATTED)
def test_formatting(name, tmp_path):
    assert growth(lambda path: format_files([path]), files(tmp_path, CONTENTS[name])) < 2.5


@pytest.mark.parametrize("name", DESCRIPTIONS)
def test_checking_descriptions(name, tmp_path):
    assert growth(lambda path: check_files([path]), files(tmp_path, DESCRIPTIONS[name], ".yaml")) < 2.5


#: Sizes of systems that are analysed or edited.
FEW = (10, 20, 40)
#: An exponent of 1.1 of a polynomial.
ALMOST_LINEAR = 2**1.1
COMMANDS = {
    "analyze": lambda path: analyze_files([path]),
    "build": build,
    "report": lambda path: report(path, with_simulation=False),
    "simulate": lambda path: simulate(path, "10 ms"),
    "sweep": lambda path: sweep(path, ["t0.execution_time=1us,2us"]),
}


def timers(count):
    """A description with as many timers."""
    each = repeated("{name: t#, period: 100 ms, execution_time: 1 us}", count, ", ")
    return f"{DESCRIPTION}hardware: {{platform: single-core}}\napplication: {{nodes: [{{name: n, timers: [{each}]}}]}}\n"


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_on_many_tasks(command, tmp_path):
    paths = [tmp_path / f"{size}.yaml" for size in FEW]
    for path in paths:
        path.write_text(timers(int(path.stem)))
    assert growth(COMMANDS[command], paths) < ALMOST_LINEAR


def chains(count):
    """A description of six tasks with as many chains."""
    tasks = repeated("{name: t#, period: 1# ms, execution_time: 1 us, priority: 1#}", 6, ", ")
    each = ", ".join(f"{{name: c{number}, path: [t{number % 5}, t{number % 5 + 1}]}}" for number in range(count))
    return f"{DESCRIPTION}hardware: {{platform: single-core}}\ntasks: [{tasks}]\nchains: [{each}]\n"


@pytest.mark.parametrize("command", ["analyze", "build", "report"])
def test_commands_on_many_chains(command, tmp_path):
    paths = [tmp_path / f"{size}.yaml" for size in FEW]
    for path in paths:
        path.write_text(chains(int(path.stem)))
    assert growth(COMMANDS[command], paths) < ALMOST_LINEAR


def test_comparing_models_of_which_each_object_differs(tmp_path):
    def labels(value):
        return lambda count: repeated(f'<labels name="L#" constant="{value}"/>', count)

    pairs = []
    for value in ("true", "false"):
        (tmp_path / value).mkdir()
        pairs.append(files(tmp_path / value, labels(value)))
    assert growth(lambda pair: diff(*pair), list(zip(*pairs, strict=True))) < ALMOST_LINEAR


def test_measuring_many_names(tmp_path):
    jobs = [
        f"{1000 * number + at},Core,0,T,T{number},0,{event}"
        for number in range(max(SIZES))
        for at, event in enumerate(("activate", "start", "terminate"))
    ]
    paths = [tmp_path / f"{size}.btf" for size in SIZES]
    for path, size in zip(paths, SIZES, strict=True):
        path.write_text("\n".join(["#version 2.1.3", "#timeScale ns", *jobs[: 3 * size], ""]))
    assert growth(measure, paths) < ALMOST_LINEAR


def test_calibrating_many_values(tmp_path):
    inputs = []
    for size in FEW:
        table = tmp_path / f"{size}.csv"
        table.write_text(f"{repeated('c#_us', size, ',')}\n{repeated('1', size, ',')}\n")
        measured = measure(table, columns=[f"c{number}_us=t{number}.execution_time" for number in range(size)])
        inputs.append((timers(size), measured))
    assert growth(lambda given: calibrate(*given), inputs) < ALMOST_LINEAR
