"""How micro-ROS was brought to the controller: the port, the operating system and its ticks, as far as sources show them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple

from amalthea_uros.source.boards import has_freertos
from amalthea_uros.source.build_files import BuildFacts
from amalthea_uros.source.ports import FORMS
from amalthea_uros.source.program import CodeProgram
from amalthea_uros.source.walk import FunctionCall

#: Headers -> the port, the first one that is included counts; of several, such as FreeRTOS under Arduino, the more specific one.
_HEADERS = (
    (r"micro_ros_arduino\.h", "arduino"),
    (r"micro_ros_platformio\.h", "platformio"),
    (r"zephyr(/kernel)?\.h", "zephyr"),
    (r"pico/stdlib\.h", "pico-sdk"),
    (r"hal_data\.h", "renesas"),
    (r"nuttx/config\.h", "nuttx"),
    (r"cmsis_os2?\.h|stm32\w+_hal\.h", "cubemx"),
    (r"freertos/FreeRTOS\.h|esp_\w+\.h", "espidf"),
    (r"FreeRTOS\.h", "freertos"),
)
_INCLUDE = re.compile(rb'^[ \t]*#[ \t]*include[ \t]*[<"]([^">\n]+)[">]', re.MULTILINE)
#: Ports whose programs call the functions of Arduino.
OF_ARDUINO = ("arduino", "platformio")
_RTOS = {"zephyr": "zephyr", "espidf": "freertos", "freertos": "freertos", "nuttx": "nuttx"}
#: Ticks per second of a port if nobody changes them: espressif/esp-idf components/freertos/Kconfig.
_TICKS = {"espidf": Fraction(100)}


class CodePlatform(NamedTuple):
    """The port and the operating system of a program.

    Attributes
    ----------
    port, rtos : "" if unknown
    tick_rate : ticks per second
    ticks_are_stated : whether the sources or the port say so; else it is a default that the build may change
    """

    port: str
    rtos: str
    tick_rate: Fraction | None
    ticks_are_stated: bool


def platform_of(program: CodeProgram, calls: Iterable[FunctionCall], build: BuildFacts, board: str) -> CodePlatform:
    """The port and the operating system of a program, by files of its build system and by its sources.

    Parameters
    ----------
    board : as PlatformIO or amuros calls it; "" if unknown
    """
    every, stated, included = list(calls), _stated_ticks(program, build), _included(program)
    port = build.port.value if build.port is not None else _port(included)
    is_esp32 = has_freertos(board) or any(re.fullmatch(r"(esp_|ESP32)\w*\.h", name) for name in included)
    # Of the boards that micro-ROS for Arduino supports, those with ESP32 have this function.
    is_esp32 = is_esp32 or any(call.name == "set_microros_wifi_transports" and not call.uncertain for call in every)
    if port in OF_ARDUINO and is_esp32 and (build.framework is None or build.framework.value == "arduino"):
        # FreeRTOS with 1000 ticks per second (espressif/arduino-esp32).
        return CodePlatform(port, "freertos", stated or Fraction(1000), ticks_are_stated=True)
    rtos = _operating_system(every) or _RTOS.get(port, "")
    return CodePlatform(port, rtos, stated or _TICKS.get(port), ticks_are_stated=stated is not None)


def _included(program: CodeProgram) -> set[str]:
    return {name.decode("utf-8", "replace") for file, _ in program.files for name in _INCLUDE.findall(file.text)}


def _port(included: Iterable[str]) -> str:
    return next((port for pattern, port in _HEADERS if any(re.fullmatch(pattern, name) for name in included)), "")


def _operating_system(calls: Iterable[FunctionCall]) -> str:
    """The operating system that is used, as `app.yaml` calls it."""
    hints = {name: form.rtos for name, form in FORMS.items() if form.rtos} | dict.fromkeys(
        ("vTaskDelay", "osDelay"), "freertos"
    )
    hints |= dict.fromkeys(("k_sleep", "k_msleep", "k_usleep"), "zephyr")
    return next((hints[call.name] for call in calls if call.name in hints), "")


def _stated_ticks(program: CodeProgram, build: BuildFacts) -> Fraction | None:
    texts = program.macros.get("configTICK_RATE_HZ", set()) | program.macros.get("CONFIG_FREERTOS_HZ", set())
    numbers = {number for text in texts for number in re.findall(r"\d+", text)}
    numbers |= {build.ticks.value} if build.ticks is not None else set()
    rate = next(iter(numbers)) if len(numbers) == 1 else "0"
    return Fraction(int(rate)) if 0 < len(rate) < 10 and int(rate) else None
