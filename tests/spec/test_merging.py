"""What an application states counts before what its platform states, and this before its operating system, key by key."""

import pytest

from amalthea_uros import describe
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.read import read_description
from amalthea_uros.units import MICROSECOND, MILLISECOND

PLATFORM = """amuros: 1
platform: mine
hardware: {frequency: 100 MHz}
os: {rtos: freertos, tick: 2 ms}
middleware:
  executor: {loop: {spin_some: 100 ms, sleep: 10 ms}, execution_time: {base: 20 us, per_message: 15 us}, stack: 4 kB}
  transport: {serial: {baud_rate: 115200, driver: {write: dma, read: dma}}, acknowledgement: 10 ms}
  limits: {RMW_UXRCE_MAX_NODES: 1, RMW_UXRCE_MAX_SUBSCRIPTIONS: 2}
"""
APPLICATION = """amuros: 1
name: app
hardware: ./mine.yaml
{}
application:
  nodes:
    - name: node
      timers:
        - {{name: Control, period: 20 ms, execution_time: 200 us}}
"""


@pytest.fixture
def completed(tmp_path):
    (tmp_path / "mine.yaml").write_text(PLATFORM)

    def of(text="") -> Description:
        (tmp_path / "app.yaml").write_text(APPLICATION.format(text))
        return complete(read_description(tmp_path / "app.yaml"), tmp_path).description

    return of


def test_an_application_gets_what_it_does_not_state(completed):
    middleware = completed().middleware
    assert (middleware.executor.loop.sleep, middleware.transport.serial.baud_rate) == (10 * MILLISECOND, 115200)
    assert middleware.limits.RMW_UXRCE_MAX_SUBSCRIPTIONS == 2


def test_keys_are_completed_one_by_one(completed):
    middleware = completed(
        "middleware: {transport: {serial: {baud_rate: 921600}}, limits: {RMW_UXRCE_MAX_NODES: 3}, executor: {name: Spin}}"
    ).middleware
    assert (middleware.transport.serial.baud_rate, middleware.transport.serial.driver.write) == (921600, "dma")
    assert (middleware.limits.RMW_UXRCE_MAX_NODES, middleware.limits.RMW_UXRCE_MAX_SUBSCRIPTIONS) == (3, 2)
    assert (middleware.executor.name, middleware.executor.loop.sleep) == ("Spin", 10 * MILLISECOND)


@pytest.mark.parametrize(
    ("text", "loop", "period"),
    [
        ("period: 5 ms", None, 5 * MILLISECOND),
        # The sleep belongs to the loop of the platform.
        ("loop: {spin_some: 50 ms}", 0, None),
    ],
)
def test_the_activation_of_an_executor_is_replaced(completed, text, loop, period):
    executor = completed(f"middleware: {{executor: {{{text}}}}}").middleware.executor
    assert (executor.loop and executor.loop.sleep, executor.period) == (loop, period)


def test_an_execution_time_is_replaced_as_a_whole(completed):
    cost = completed("middleware: {executor: {execution_time: 12 us}}").middleware.executor.execution_time
    assert cost.base.max == 12 * MICROSECOND
    assert cost.per_message.fixed is None


def test_the_wire_is_replaced(completed):
    transport = completed("middleware: {transport: {can: {bitrate: 500 kbit/s}}}").middleware.transport
    assert (transport.can is not None, transport.serial, transport.acknowledgement) == (True, None, 10 * MILLISECOND)


def test_each_of_several_executors_is_completed(completed):
    middleware = completed("middleware: {executors: [{name: A, stack: 8 kB}, {name: B, period: 5 ms}]}").middleware
    first, second = middleware.executors
    assert (first.loop.sleep, first.stack, second.loop) == (10 * MILLISECOND, 8 * 8000, None)
    assert second.stack == first.stack // 2
    assert not middleware.states("executor")


def test_a_value_of_the_platform_has_its_location_there(completed):
    executor = completed("middleware: {executor: {name: Spin}}").middleware.executor
    assert (executor.location("name").path.name, executor.location("name").line) == ("app.yaml", 4)
    assert (executor.location("stack").path.name, executor.location("stack").line) == ("mine.yaml", 6)
    assert executor.location("loop").path.name == executor.loop.location().path.name == "mine.yaml"
    # What nobody states has the location of the section.
    assert executor.location("core") == executor.location()


@pytest.mark.parametrize(
    ("hardware", "os", "line"), [("esp32", "{tick: 1 ms}", 3), ("{platform: esp32}", "{}", 3), ("esp32", "{rtos: zephyr}", 4)]
)
def test_a_value_of_a_file_that_comes_with_amuros_has_the_location_of_its_name(tmp_path, hardware, os, line):
    (tmp_path / "app.yaml").write_text(APPLICATION.format(f"os: {os}").replace("./mine.yaml", hardware))
    whole = complete(read_description(tmp_path / "app.yaml"), tmp_path).description
    executor = whole.middleware.executor
    for location in (
        executor.location(),
        executor.location("stack"),
        executor.loop.location("sleep"),
        whole.os.location("stack"),
    ):
        assert (location.path.name, location.line) == ("app.yaml", line)


def test_two_applications_share_one_generic_model(tmp_path):
    generic = PLATFORM.replace("loop: {spin_some: 100 ms, sleep: 10 ms}", "period: 5 ms")
    (tmp_path / "mine.yaml").write_text(generic)
    for name, text in (("one", ""), ("two", "middleware: {executor: {period: 10 ms}}")):
        (tmp_path / f"{name}.yaml").write_text(APPLICATION.format(text))
    systems = [describe(tmp_path / f"{name}.yaml").system for name in ("one", "two")]
    periods = []
    for system in systems:
        (stimulus,) = (system.stimuli_by_name[name] for name in system.processes["Executor_Task"].stimuli)
        assert isinstance(stimulus, Periodic)
        periods.append(stimulus.period)
    assert periods == [5 * MILLISECOND, 10 * MILLISECOND]


def test_a_finding_about_the_platform_names_its_line(tmp_path):
    (tmp_path / "mine.yaml").write_text(PLATFORM.replace("stack: 4 kB", "core: Core_9"))
    (tmp_path / "app.yaml").write_text(APPLICATION.format("middleware: {executor: {period: 5 ms}}"))
    with pytest.raises(ReadError) as error:
        describe(tmp_path / "app.yaml")
    (finding,) = error.value.findings
    assert finding.message == "undefined core 'Core_9'"
    assert (finding.location.path.name, finding.location.line) == ("mine.yaml", 6)


class TestOperatingSystem:
    def test_the_platform_overrides_it_and_the_application_both(self, completed):
        assert (completed().os.tick, completed("os: {tick: 5 ms}").os.tick) == (2 * MILLISECOND, 5 * MILLISECOND)
        assert completed().os.stack == "per-task"

    def test_another_one_brings_its_own_properties_and_port(self, completed):
        whole = completed("os: {rtos: zephyr}")
        # A tick of 100 us, and the example of the Zephyr module: spin_some(100 ms); usleep(100 ms), in the main thread of priority 0.
        assert (whole.os.tick, whole.os.priorities) == (100 * MICROSECOND, "lower-is-more-urgent")
        executor = whole.middleware.executor
        assert (executor.loop.sleep, executor.priority) == (100 * MILLISECOND, 0)
        assert whole.middleware.transport.serial.driver.write == "polling"
        # What the port does not state remains that of the platform.
        assert executor.execution_time.base.max == 20 * MICROSECOND

    def test_an_application_without_a_platform_has_one(self, tmp_path):
        text = APPLICATION.format("os: {rtos: osek}").replace("./mine.yaml", "{frequency: 1 MHz}")
        (tmp_path / "app.yaml").write_text(text)
        whole = complete(read_description(tmp_path / "app.yaml"), tmp_path).description
        assert (whole.middleware.policy, whole.os.stack) == ("OSEK", "shared")

    def test_a_file_is_relative_to_the_file_that_names_it(self, tmp_path):
        (tmp_path / "boards").mkdir()
        (tmp_path / "boards" / "rtos.yaml").write_text("amuros: 1\nrtos: own\ntitle: Own\nos: {tick: 3 ms}\n")
        platform = "amuros: 1\nplatform: mine\nhardware: {frequency: 1 MHz}\nos: {rtos: ./rtos.yaml}\n"
        (tmp_path / "boards" / "mine.yaml").write_text(platform)
        (tmp_path / "app.yaml").write_text(APPLICATION.format("").replace("./mine.yaml", "./boards/mine.yaml"))
        assert complete(read_description(tmp_path / "app.yaml"), tmp_path).description.os.tick == 3 * MILLISECOND

    @pytest.mark.parametrize(
        ("name", "message", "advice"),
        [
            ("zephir", "unknown operating system 'zephir'", "Did you mean 'zephyr'?"),
            ("x", "unknown operating system 'x'", "Known operating systems: bare-metal, freertos, "),
            ("./x.yaml", "operating system file ", "Give a path relative to the directory of this file."),
        ],
    )
    def test_an_unknown_one_is_an_error_at_its_place(self, tmp_path, name, message, advice):
        (tmp_path / "mine.yaml").write_text(PLATFORM)
        (tmp_path / "app.yaml").write_text(APPLICATION.format(f"os: {{rtos: {name}}}"))
        with pytest.raises(ReadError) as error:
            describe(tmp_path / "app.yaml")
        (finding,) = error.value.findings
        assert (finding.rule, finding.location.line) == ("APP001", 4)
        assert finding.message.startswith(message)
        assert finding.help.startswith(advice)
