"""Robots with several controllers: described in one file or several ones, analysed and simulated as one system."""

import json
from dataclasses import replace
from html import unescape
from random import Random

import pytest
import yaml
from command import amuros as run_amuros
from effort import every
from opponent.executors.claims import false_claims, runs_of
from opponent.executors.descriptions import random_description
from opponent.executors.robots import controller, random_robot
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros import analyze_system
from amalthea_uros.errors import ReadError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.host import Host
from amalthea_uros.perf.network import Direction, Purpose
from amalthea_uros.perf.qualified import joined
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND, MILLISECOND, Duration
from amalthea_uros.uros.described import describe_content, describe_file, describe_text

SAMPLES = ROOT / "samples"
SAMPLE = (SAMPLES / "robot-two-controllers.yaml").read_text()
#: With loops on different wires, and without.
ALONE = ("esp32-serial", "robot-xrce", "stm32-usb-cdc", "two-controllers-drive", "drive-and-lift")


def of_sample(name):
    return replace(describe_file(SAMPLES / f"{name}.yaml").assembly.system, host=Host())


def bounds(analysis, part=""):
    """All bounds of a controller, by the names that its objects have there."""
    values = [("process", each.name, each.response and each.response.worst) for each in analysis.processes]
    for executor in analysis.executors:
        values += [("loop", executor.name, executor.loop), ("slots", executor.name, executor.slots_needed)]
        values += [("handle", each.name, each.response.worst) for each in executor.handles]
    values += [("chain", each.name, each.worst) for each in analysis.chains]
    return {(kind, name.removeprefix(part)): value for kind, name, value in values if name.startswith(part)}


def observed(simulation, part=""):
    values = {
        ("handle", handle.name): (handle.calls, handle.response_time and handle.response_time.max)
        for executor in simulation.executors
        for handle in executor.handles
    }
    values |= {("process", each.name): each.response_time and each.response_time.max for each in simulation.processes}
    return {(kind, name.removeprefix(part)): value for (kind, name), value in values.items() if name.startswith(part)}


def assert_apart(one, other):
    """Two systems that exchange nothing have the same results together as each of them has alone."""
    together = joined({"a": one, "b": other})
    analysis = analyze_system(together)
    options = Options(duration=Duration(200 * MILLISECOND), mode=SimulationMode.WORST)
    simulation = simulate_system(together, options)
    for part, alone in (("a_", one), ("b_", other)):
        assert bounds(analysis, part) == bounds(analyze_system(alone))
        assert observed(simulation, part) == observed(simulate_system(alone, options))


@pytest.mark.parametrize("names", list(zip(ALONE, (*ALONE[1:], ALONE[0]), strict=True)), ids="-".join)
def test_controllers_that_exchange_nothing_have_the_results_that_each_has_alone(names):
    assert_apart(*map(of_sample, names))


def test_so_have_those_without_a_wire():
    """Their executors have no session, but each controller has buffers of its own."""
    content = yaml.safe_load(CONSTANT.format(latency=0))
    middleware = {"executor": {"name": "E", "priority": 1, "loop": {"spin": "1 s"}, "execution_time": "10 us"}}
    subscription = {"topic": "t", "message_size": "8 B", "execution_time": "20 us", "interval": "10 ms"}
    systems = []
    for names in (["A"], ["B", "C"]):
        node = {"name": "n", "subscriptions": [{"name": name, **subscription} for name in names]}
        section = {**content["controllers"][0], "middleware": middleware, "application": {"nodes": [node]}}
        systems.append(describe_content({"amuros": 1, **section}).assembly.system)
    assert_apart(*systems)


@pytest.mark.parametrize("seed", every(5, range(60)))
def test_so_have_random_ones(seed):
    chance, systems = Random(seed), []
    while len(systems) < 2:
        try:
            content = controller(f"p{len(systems)}", random_description(chance.randrange(10**6)))
            systems.append(describe_content({"amuros": 1, **content}).assembly.system)
        except ReadError:
            continue
    assert_apart(*systems)


def test_no_simulation_of_a_random_robot_contradicts_its_analysis():
    found = {seed: false_claims(random_robot(seed), runs=runs_of(200 * MILLISECOND, (1,))) for seed in every(8, range(48))}
    assert {seed: said for seed, said in found.items() if said} == {}


@pytest.fixture
def files(tmp_path):
    """The sample with a file for each controller."""
    content = yaml.safe_load(SAMPLE)
    for section in content["controllers"]:
        (tmp_path / f"{section['name']}.yaml").write_text(yaml.safe_dump({"amuros": 1, **section}))
    content["controllers"] = [{"name": each["name"], "file": f"{each['name']}.yaml"} for each in content["controllers"]]
    path = tmp_path / "robot.yaml"
    path.write_text(yaml.safe_dump(content))
    return path


def test_a_controller_can_be_described_in_a_file_of_its_own(files):
    assert describe_file(files).assembly.system == describe_text(SAMPLE).assembly.system


def test_the_model_has_the_whole_robot():
    model = amuros.build(SAMPLES / "robot-two-controllers.yaml").model
    assert bounds(amuros.analyze(model)) == bounds(amuros.analyze(SAMPLE))


def hops(chain):
    return [(hop.kind.value, hop.name) for hop in chain.hops]


def test_a_message_takes_both_agents_and_the_latency_of_its_topic():
    chain = amuros.analyze(SAMPLE).chains["wheels-to-joint"]
    agents = [hop for hop in chain.hops if hop.kind.value == "agent"]
    (topic,) = (hop for hop in chain.hops if hop.kind.value == "topic")
    assert hops(chain)[2:7] == [
        ("wire", "base_Serial"),
        ("agent", "Agent"),
        ("topic", "/odom"),
        ("agent", "Agent"),
        ("wire", "arm_Serial"),
    ]
    assert [hop.worst for hop in agents] == [MILLISECOND, MILLISECOND]
    assert (topic.best, topic.worst) == (50 * MICROSECOND, 400 * MICROSECOND)


#: Everything takes the same time always, and the wait of the receiver ends when a message arrives.
CONSTANT = """
amuros: 1
name: constant
controllers:
  - name: a
    hardware: &hardware {{platform: single-core, frequency: 1 GHz}}
    middleware: &middleware
      executor: {{name: E, priority: 1, loop: {{spin: 1 s}}, execution_time: {{base: 10 us, per_message: 5 us}}}}
      transport: {{custom: {{table: [{{size: 512 B, time: 1 ms}}]}}}}
      agent: {{to_controller: 500 us, to_host: 500 us}}
    application:
      nodes:
        - name: n
          publishers: [&topic {{topic: t, message_size: 8 B, reliability: best-effort}}]
          timers: [{{name: Send, period: 100 ms, execution_time: 20 us, publishes: [t]}}]
  - name: b
    hardware: *hardware
    middleware: *middleware
    application:
      nodes:
        - {{name: n, subscriptions: [{{<<: *topic, name: Take, interval: 100 ms, execution_time: 20 us}}]}}
host: {{ros: humble, computers: [{{name: pc}}], latency: {latency} ms}}
chains: [{{name: c, path: [a_Send, /t, b_Take]}}]
"""


@pytest.mark.parametrize("latency", [0, 3, 8])
def test_the_simulation_takes_the_same_way(latency):
    """From the start of the callback: 20 us, 1 ms on each wire, 0.5 ms in each agent, the topic, then 10, 5 and 20 us."""
    text = CONSTANT.format(latency=latency)
    (seen,) = amuros.simulate(text, "2 s").chains
    quantity = seen.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert quantity.min == quantity.max == latency * MILLISECOND + 3 * MILLISECOND + 55 * MICROSECOND
    (found,) = amuros.analyze(text).chains
    assert found.best <= quantity.min
    assert found.worst >= quantity.max


def test_without_a_latency_of_the_topic_nothing_is_known_of_what_arrives():
    text = SAMPLE.replace("  latency: {min: 50 us, max: 400 us}\n", "")
    result = amuros.analyze(text)
    assert result.chains["wheels-to-joint"].worst is None
    assert "the latency of the topic 'odom' is not specified" in result.chains["wheels-to-joint"].reason
    assert all(each.response.worst is None for each in result.executors["arm_Spin"].handles)
    simulation = amuros.simulate(text, "1 s")
    reasons = {each.name: each.reason for each in simulation.left_out}
    assert "how long messages of 'odom' take from 'base_Report'" in reasons["arm_Spin"]
    assert not simulation.chains["wheels-to-joint"].quantities


def test_what_the_other_controller_sends_counts_instead_of_what_is_stated():
    """Its timer can be late by its response time, its message on the wire and in the agents, and the topic."""
    stated = amuros.analyze(SAMPLE.replace("jitter: 30 ms", "jitter: 1 ms"))
    assert [each.rule for each in stated.findings if each.rule == "HST003"] == ["HST003"]
    real = stated.solution.context.system.stimuli_by_name["arm_odom_topic_to_On_Odom"].jitter
    response = stated.executors["base_Spin"].handles["base_Report"].response
    assert real.upper > response.worst - response.best + MILLISECOND


def test_another_interval_than_that_of_the_publisher_makes_unknown_what_depends_on_it():
    result = amuros.analyze(SAMPLE.replace("topic: odom, interval: 50 ms", "topic: odom, interval: 70 ms"))
    assert "another controller can send 'odom' in another interval" in result.chains["wheels-to-joint"].reason
    assert result.requirements["wheels-to-joint_reaction"].verdict is Verdict.UNKNOWN


def test_each_client_has_its_own_messages():
    system = describe_text(SAMPLE).assembly.system
    base, arm = system.clients
    assert [each.name for each in base.executors] == ["base_Spin"]
    assert [wire.name for wire in arm.network.wires] == ["arm_Serial"]
    own = [each for each in base.network.transmissions if each.wire == "arm_Serial"]
    # The agent can send on what another client publishes.
    assert all((each.direction, each.purpose) == (Direction.TO_AGENT, Purpose.DATA) for each in own)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("name: arm\n    hardware", "name: base\n    hardware"), "duplicate controller name 'base'"),
        (("  - name: base\n    hardware", "  - name: base\n    host: {ros: humble}\n    hardware"), "unknown key 'host'"),
        (
            ("name: arm\n    hardware: {platform: esp32}\n", "name: arm\n    file: arm.yaml\n"),
            "controllers: 'middleware' cannot be combined",
        ),
        (("path: [base_Wheels, base_Report", "path: [Wheels, base_Report"), "undefined process, runnable or label 'Wheels'"),
        (("- {name: Joint,", "- {name: Joint, prio: 3,"), "unknown key 'prio'"),
    ],
)
def test_mistakes(change, message):
    assert change[0] in SAMPLE
    with pytest.raises(ReadError) as caught:
        describe_text(SAMPLE.replace(*change))
    assert any(each.message.startswith(message) for each in caught.value.findings), caught.value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "file of a controller .* not found"),
        ("amuros: 1\nname: x\ncontrollers: [{name: y, file: z.yaml}]\n", "describes a robot of several controllers"),
        ("amuros: 1\nname: x\nhardware: {platform: esp32}\nhost: {ros: humble, computers: [{name: pc}]}\n", "has a 'host'"),
    ],
)
def test_mistakes_in_the_file_of_a_controller(files, text, message):
    path = files.with_name("arm.yaml")
    path.unlink() if text is None else path.write_text(text)
    with pytest.raises(ReadError, match=message):
        describe_file(files)


@pytest.mark.parametrize("key", ["chains", "requirements", "labels"])
def test_nothing_beside_the_file_of_a_controller_is_left_out(key):
    content = {"amuros": 1, "name": "x", "controllers": [{"name": "y", "file": "y.yaml", key: {} if key == "labels" else []}]}
    with pytest.raises(ReadError, match=f"'{key}' cannot be combined with 'file'"):
        describe_content(content)


def test_there_are_not_so_many_controllers_that_nobody_waits_for_them():
    content = {"amuros": 1, "name": "x", "controllers": [{"name": f"c{n}", "file": "c.yaml"} for n in range(101)]}
    with pytest.raises(ReadError, match="at most 100"):
        describe_content(content)


def test_two_names_that_are_the_same_with_those_of_controllers_before_them():
    content = {"amuros": 1, "name": "robot", "controllers": []}
    for name, task in (("arm", "left_Motor"), ("arm_left", "Motor")):
        section = {"name": task, "period": "5 ms", "execution_time": "1 ms"}
        content["controllers"].append({"name": name, "hardware": {"platform": "single-core"}, "tasks": [section]})
    with pytest.raises(ReadError, match="two controllers have a task 'arm_left_Motor'"):
        describe_content(content)


def test_a_platform_is_that_of_one_controller(files):
    with pytest.raises(ReadError, match="several controllers, each with a platform of its own"):
        describe_file(files, "rp2040")


def test_a_value_of_a_controller_has_its_name(files):
    changed = amuros.analyze(SAMPLE, changes=["arm_Joint.period=10ms"])
    edited = amuros.analyze(SAMPLE.replace("name: Joint, period: 5 ms", "name: Joint, period: 10 ms"))
    assert bounds(changed) == bounds(edited)
    with pytest.raises(amuros.InvalidArgumentError, match=r"'arm_Joint' is described in arm.yaml; change 'Joint' there"):
        amuros.analyze(files, changes=["arm_Joint.period=10ms"])


def test_files_for_the_build_are_those_of_one_controller(files, tmp_path):
    for path in (files, SAMPLES / "robot-two-controllers.yaml"):
        text = amuros.generate(path, controller="arm").texts["colcon.meta"]
        assert text == amuros.generate(files.with_name("arm.yaml")).texts["colcon.meta"]
    for name in (None, "leg"):
        with pytest.raises(ReadError) as caught:
            amuros.generate(files, controller=name)
        assert caught.value.findings[0].help == "Choose one with --controller: base, arm."


@pytest.fixture(scope="module")
def strangers():
    """Two samples that exchange nothing as a robot."""
    controllers = [{"name": name[:5], "file": str(SAMPLES / f"{name}.yaml")} for name in ("esp32-serial", "stm32-usb-cdc")]
    return yaml.safe_dump({"amuros": 1, "name": "robot", "controllers": controllers})


@pytest.mark.parametrize("name", ["esp32-serial", "stm32-usb-cdc"])
def test_generated_files_and_those_in_a_report_are_the_same(strangers, name, tmp_path):
    (tmp_path / "robot.yaml").write_text(strangers)
    options = amuros.generate(tmp_path / "robot.yaml", controller=name[:5]).texts["colcon.meta"]
    assert options == amuros.generate(SAMPLES / f"{name}.yaml").texts["colcon.meta"]
    page = unescape(amuros.report(strangers, with_simulation=False).html)
    assert all(line in page for line in options.splitlines())


def test_pools_and_memory_are_those_of_each_controller(strangers, tmp_path):
    (tmp_path / "robot.yaml").write_text(strangers)
    record = built(tmp_path / "robot.yaml", tmp_path)
    assert record["memory"] is None
    for name in ("esp32-serial", "stm32-usb-cdc"):
        alone = built(SAMPLES / f"{name}.yaml", tmp_path)
        assert record["controllers"][name[:5]] == {key: alone[key] for key in ("messages", "initialisation", "pools", "memory")}


def built(path, folder):
    run_amuros("build", path, "-o", folder / "built.amxmi", "--force", "--output", f"json={folder / 'built.json'}")
    return json.loads((folder / "built.json").read_text())


def test_two_robots_are_compared_by_the_files_of_their_controllers(files, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    for path in files.parent.glob("*.yaml"):
        (other / path.name).write_text(path.read_text().replace("name: Joint\n  period: 5 ms", "name: Joint\n  period: 9 ms"))
    described = amuros.diff(files, other / "robot.yaml").described
    assert [(each.target, each.before, each.after) for each in described] == [("arm.Joint.period", "5 ms", "9 ms")]


def test_a_robot_is_not_calibrated_as_a_whole(tmp_path):
    (tmp_path / "robot.yaml").write_text(SAMPLE)
    trace = tmp_path / "run.btf"
    amuros.simulate(SAMPLE, "1 s", trace_paths=[trace])
    with pytest.raises(amuros.InvalidArgumentError, match="several controllers"):
        amuros.calibrate(tmp_path / "robot.yaml", [trace])
