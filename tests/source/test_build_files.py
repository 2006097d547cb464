"""Files of build systems: the port, the distribution, the board, the transport and the pools that they state."""

from dataclasses import replace

import pytest
from importing import described, imported, rules

from amalthea_uros.errors import ReadError
from amalthea_uros.services.import_code import import_code

NODE = 'check(rclc_node_init_default(&node, "n", "", &support)); '
TIMER = "check(rclc_timer_init_default(&t, &support, RCL_MS_TO_NS(50), cb)); "
EXECUTOR = "check(rclc_executor_init(&e, &support.context, {}, &allocator)); "
SETUP = NODE + TIMER + EXECUTOR.format(1) + "check(rclc_executor_add_timer(&e, &t)); "
SPIN = "rclc_executor_spin_some(&e, RCL_MS_TO_NS(10)); "
ARDUINO = f"void setup() {{ set_microros_serial_transports(Serial); {SETUP} }} void loop() {{ {SPIN} delay(5); }}"
PICO = f"void main(void) {{ rmw_uros_set_custom_transport(true, NULL, pico_serial_open); {SETUP} while (1) {{ {SPIN} }} }}"
TASK = (
    f'#include "freertos/FreeRTOS.h"\nvoid task(void * a) {{{{ {SETUP} while (1) {{{{ {SPIN} usleep(10000); }}}} }}}}\n'
    'void app_main(void) {{ xTaskCreate(task, "task", {}, NULL, CONFIG_PRIORITY, NULL); }}'
)
ZEPHYR = (
    f"void main(void) {{ rmw_uros_set_custom_transport(MICRO_ROS_FRAMING, 0, zephyr_open); {SETUP} while (1) {{ {SPIN} }} }}"
)
CMAKE = "pico_sdk_init()\npico_enable_stdio_usb(app {})\npico_enable_stdio_uart(app {})\n"
KCONFIG = "CONFIG_MICROROS=y\n"
CLOCK = "board_build.f_cpu = 80000000L\n"
INI = "[env:robot]\nboard = {}\nframework = arduino\nlib_deps = https://github.com/micro-ROS/micro_ros_platformio\n"


@pytest.mark.parametrize(
    ("code", "files", "expected"),
    [
        (
            ARDUINO,
            {"platformio__ini": INI.format("teensy41")},
            ["platform: teensy41 # platformio.ini:2", "port: platformio", "usb_cdc: {}"],
        ),
        # FreeRTOS with 1000 ticks per second: a delay sleeps there, and nowhere else.
        (
            ARDUINO,
            {"platformio__ini": INI.format("esp32dev")},
            ["platform: esp32", "tick: 1 ms", "sleep: 5 ms", "serial: {baud_rate: TODO}"],
        ),
        (ARDUINO, {"platformio__ini": INI.format("teensy41")}, ["- busy_wait: 5 ms"]),
        (ARDUINO, {"platformio__ini": INI.format("unheard-of")}, ["transport: TODO", "platform: generic", "frequency: TODO"]),
        (
            ARDUINO,
            {"platformio__ini": INI.format("esp32-s3-devkitc-1") + "build_flags =\n  -DCORE\n  -DARDUINO_USB_CDC_ON_BOOT=1\n"},
            ["platform: esp32-s3", "usb_cdc: {} # platformio.ini:5"],
        ),
        (
            ARDUINO,
            {
                "platformio__ini": INI.format("esp32dev")
                + "board_microros_distro = humble\nboard_microros_transport = wifi\n"
                + CLOCK
            },
            ["ros: humble # platformio.ini:5", "udp: {bitrate: TODO}", "frequency: 80000000 Hz"],
        ),
        # A value of another section.
        (
            ARDUINO,
            {
                "platformio__ini": "[common]\ndistro = humble\n"
                + INI.format("due")
                + "board_microros_distro = ${common.distro}\n"
            },
            ["ros: humble # platformio.ini:7"],
        ),
        # A section that extends another one, and a branch in the address of a library.
        (
            ARDUINO,
            {"platformio__ini": INI.format("esp32dev").replace("env:robot", "base") + "[env:robot]\nextends = base\n"},
            ["platform: esp32", "serial: {baud_rate: TODO}"],
        ),
        (
            ARDUINO,
            {"platformio__ini": INI.format("esp32dev").replace("_platformio", "_arduino.git#v2.0.7-humble ; a comment")},
            ["ros: humble", "port: arduino"],
        ),
        # All files but those for the smallest boards keep four messages: micro-ROS/micro_ros_platformio metas/colcon.meta.
        (ARDUINO, {"platformio__ini": INI.format("esp32dev")}, ["RMW_UXRCE_MAX_HISTORY: 4"]),
        (TASK.format("9000"), {"sdkconfig": 'CONFIG_IDF_TARGET="esp32s3"\n'}, ["platform: esp32-s3 # sdkconfig:1"]),
        # Settings of Kconfig are macros of the code; a stack that is not constant is a gap.
        (
            TASK.format("CONFIG_STACK"),
            {"sdkconfig": "CONFIG_STACK=16000\nCONFIG_PRIORITY=5\n# CONFIG_OTHER is not set\n"},
            ["stack: 16000 B", "priority: 5"],
        ),
        (TASK.format("size()"), {"sdkconfig": ""}, ["stack: TODO", "priority: TODO"]),
        # A stack of the application: 3000 words of 4 B.
        (f"uint32_t words[3000]; {TASK.format('sizeof(words)')}", {"sdkconfig": ""}, ["stack: 12000 B"]),
        # Two environments with different boards state none.
        (
            ARDUINO,
            {"platformio__ini": INI.format("teensy41") + INI.format("due").replace("robot", "other")},
            ["platform: generic", "transport: TODO"],
        ),
        (ARDUINO, {"library__properties": "name=micro_ros_arduino\nversion=2.0.7-humble\n"}, ["ros: humble", "port: arduino"]),
        (PICO, {"CMakeLists__txt": CMAKE.format(0, 1)}, ["port: pico-sdk", "serial: {baud_rate: TODO} # CMakeLists.txt:3"]),
        (PICO, {"CMakeLists__txt": CMAKE.format(1, 0)}, ["usb_cdc: {}"]),
        (PICO, {"CMakeLists__txt": "pico_sdk_init()\n"}, ["transport: TODO"]),
        (
            ZEPHYR,
            {
                "prj__conf": KCONFIG
                + 'CONFIG_MICROROS_SUBSCRIBERS="3"\nCONFIG_MICROROS_TRANSPORT_UDP=y\nCONFIG_SYS_CLOCK_TICKS_PER_SEC=1000\n'
            },
            ["port: zephyr", "RMW_UXRCE_MAX_SUBSCRIPTIONS: 3 # prj.conf:2", "udp: {", "tick: 1 ms"],
        ),
        (
            ZEPHYR,
            {"prj__conf": KCONFIG + "CONFIG_MAIN_STACK_SIZE=25000\nCONFIG_MAIN_THREAD_PRIORITY=3\n"},
            ["stack: 25000 B # prj.conf:2", "priority: 3"],
        ),
    ],
)
def test_a_build_file_states_facts(code, files, expected, tmp_path):
    result = imported(tmp_path, code, "main.cpp", **files)
    assert [text for text in expected if text not in result.text] == []
    assert [each for each in described(result, tmp_path)[1] if each.severity == "error"] == []


@pytest.mark.parametrize(
    ("code", "board", "files", "expected"),
    [
        (PICO, "rp2040", {"CMakeLists__txt": "pico_sdk_init()\npico_enable_stdio_uart(app 1)\n"}, "serial: {baud_rate: TODO}"),
        (ARDUINO, "esp32", {"platformio__ini": "[env]\nboard_build.f_cpu = 160000000L\n"}, "frequency: 160000000 Hz"),
    ],
)
def test_a_board_replaces_nothing_that_the_build_says(code, board, files, expected, tmp_path):
    imported(tmp_path, code, "main.cpp", **files)
    assert expected in import_code([tmp_path], board=board).text


def test_two_names_of_boards_are_a_finding(tmp_path):
    imported(tmp_path, ARDUINO, "main.cpp", platformio__ini=INI.format("teensy41"))
    assert "IMP025" in rules(import_code([tmp_path], board="esp32"))


SERVER = "check(rclc_parameter_server_init_default(&p, &node)); "
ADD = "check(rclc_executor_add_parameter_server(&e, &p, cb)); "
PARAMETERS = f"void main(void) {{ {NODE} {SERVER} {EXECUTOR.format(5)} {ADD} while (1) {{ {SPIN} usleep(1000); }} }}"


@pytest.mark.parametrize(
    ("distribution", "in_code", "in_description"),
    # Five handles up to humble, six since: without a distribution, nobody knows which.
    [("humble", [], []), ("jazzy", ["error"], ["error"]), (None, ["warning"], ["warning"])],
)
def test_the_handles_of_a_parameter_server(distribution, in_code, in_description, tmp_path):
    ini = INI.format("esp32dev") + (f"board_microros_distro = {distribution}\n" if distribution else "")
    result = imported(tmp_path, PARAMETERS, platformio__ini=ini)
    assert [each.severity for each in result.findings if each.rule == "IMP006"] == in_code
    text = result.text.replace("RMW_UXRCE_MAX_SERVICES: 1", "RMW_UXRCE_MAX_SERVICES: 6")
    try:
        findings = described(replace(result, text=text), tmp_path)[1]
    except ReadError as error:
        findings = error.findings
    assert [each.severity for each in findings if each.rule == "EXE001"] == in_description


def test_another_middleware_is_no_xrce(tmp_path):
    result = imported(tmp_path, ZEPHYR, sdkconfig="CONFIG_MICRO_ROS_ESP_EMBEDDEDRTPS_MIDDLEWARE=y\n")
    assert "IMP024" in rules(result)
