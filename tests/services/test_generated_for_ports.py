"""Files for the build, by the rules of the port that the description states."""

import json

import pytest

from amalthea_uros.services.generate import check_colcon_meta, generate

APP = """
amuros: 1
name: app
hardware: {{platform: generic, frequency: 100 MHz}}
middleware:
  ros: {ros}
  port: {port}
  executor: {{loop: {{spin_some: 100 ms}}, priority: 3}}
  transport: {{udp: {{bitrate: 10 Mbit/s}}}}
application:
  nodes:
    - name: node
      parameter_server: {{rate: 1 Hz, execution_time: 1 ms}}
      subscriptions:
        - {{name: A, topic: a, message_size: 4 B, rate: 1 Hz, execution_time: 1 ms, reliability: best-effort}}
        - {{name: B, topic: b, message_size: 4 B, rate: 1 Hz, execution_time: 1 ms, reliability: best-effort}}
"""


def generated(folder, port, ros="humble"):
    (folder / "app.yaml").write_text(APP.format(port=port, ros=ros))
    return generate(folder / "app.yaml", folder).texts


def options(texts):
    names = json.loads(texts["colcon.meta"])["names"]
    return [argument for package in names.values() for argument in package["cmake-args"]]


@pytest.mark.parametrize(
    ("port", "transport"),
    # Libraries for Arduino, PlatformIO and others send by functions of their own, also over UDP.
    [*((port, "custom") for port in ("arduino", "platformio", "zephyr", "pico-sdk")), ("espidf", "udp"), ("nuttx", "udp")],
)
def test_the_transport_is_that_of_the_port(port, transport, tmp_path):
    assert f"-DRMW_UXRCE_TRANSPORT={transport}" in options(generated(tmp_path, port))


@pytest.mark.parametrize(("ros", "services"), [("humble", 5), ("iron", 6)])
def test_the_services_of_a_parameter_server(ros, services, tmp_path):
    texts = generated(tmp_path, "espidf", ros)
    assert f"-DRMW_UXRCE_MAX_SERVICES={services}" in options(texts)
    # Two subscriptions, and a handle for each service.
    assert f"AMUROS_HANDLES_EXECUTOR_TASK {services + 2} " in texts["amuros_limits.h"]


def test_the_pools_of_zephyr_are_in_its_configuration(tmp_path):
    texts = generated(tmp_path, "zephyr")
    assert 'CONFIG_MICROROS_SUBSCRIBERS="2"' in texts["amuros.conf"].splitlines()
    assert 'CONFIG_MICROROS_SERVERS="5"' in texts["amuros.conf"].splitlines()
    # The configuration replaces them in the other file.
    assert [each for each in options(texts) if "MAX_SUBSCRIPTIONS" in each] == []
    assert check_colcon_meta(tmp_path / "app.yaml", tmp_path / "colcon.meta").is_fine
    meta = {"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_MAX_SUBSCRIPTIONS=2"]}}}
    (tmp_path / "colcon.meta").write_text(json.dumps(meta))
    (finding, *_) = check_colcon_meta(tmp_path / "app.yaml", tmp_path / "colcon.meta").findings
    assert (finding.rule, "CONFIG_MICROROS_SUBSCRIBERS" in finding.help) == ("GEN005", True)


def test_zephyr_implies_its_port(tmp_path):
    text = (
        APP.format(port="none", ros="humble")
        .replace("  port: none\n", "")
        .replace("hardware:", "os: {rtos: zephyr}\nhardware:")
    )
    (tmp_path / "app.yaml").write_text(text)
    result = generate(tmp_path / "app.yaml")
    assert result.assembly.description.middleware.port == "zephyr"
    assert "-DRMW_UXRCE_TRANSPORT=custom" in options(result.texts)
    assert 'CONFIG_MICROROS_SUBSCRIBERS="2"' in result.texts["amuros.conf"].splitlines()


BOARD = "hardware: {{platform: {board}}}\nos: {{rtos: {rtos}}}\n"


@pytest.mark.parametrize(
    ("board", "rtos", "port", "transport", "publishers"),
    [
        # The board's own port, that of ESP-IDF; and another one on the same board, whose smallest library has as many.
        ("esp32", "freertos", None, "udp", 2),
        ("nucleo-f767zi", "freertos", "platformio", "custom", 2),
        ("nucleo-f767zi", "freertos", None, "custom", 10),
        # The port of a board with FreeRTOS says nothing about NuttX: as the limits are too small, the defaults are left.
        ("nucleo-f767zi", "nuttx", None, "udp", 4),
    ],
)
def test_a_board_says_only_what_holds_for_its_port(board, rtos, port, transport, publishers, tmp_path):
    text = APP.format(port=port, ros="humble").replace("  port: None\n", "")
    hardware = "hardware: {platform: generic, frequency: 100 MHz}\n"
    (tmp_path / "app.yaml").write_text(text.replace(hardware, BOARD.format(board=board, rtos=rtos)))
    result = generate(tmp_path / "app.yaml", tmp_path)
    assert f"-DRMW_UXRCE_TRANSPORT={transport}" in options(result.texts)
    profile = result.assembly.profile
    available = {option.name: option.available for option in profile.options(result.assembly.description.application)}
    assert available["RMW_UXRCE_MAX_PUBLISHERS"] == publishers
