"""How the code of a port looks: its headers, how it sleeps and waits, and how it starts threads."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief
from amalthea_uros.units import Time

_MICROSECOND, _MILLISECOND = 10**6, 10**9


@dataclass(frozen=True, slots=True, kw_only=True)
class CodePort(Brief):
    """A port as code.

    Attributes
    ----------
    headers : that it needs, which also identify it
    sleep, wait : how a thread sleeps, and waits without sleeping; `{ms}` and `{us}` are the time; "" if it cannot
    threads : how threads are started: `freertos`, `zephyr`, or "" for one in `main`
    entry : `main`, or `arduino` for `setup` and `loop`
    ticks : the setting of its configuration for ticks per second; "" if that is elsewhere
    stack_unit : bytes of what the function that starts a thread counts stacks in
    """

    headers: tuple[str, ...]
    sleep: str = "usleep({us});"
    wait: str = ""
    threads: str = ""
    entry: str = "main"
    stack_unit: int = 1
    suffix: str = "c"
    ticks: str = ""


def _freertos(*headers: str, wait: str = "", stack_unit: int = 4, ticks: str = "") -> CodePort:
    sleep = "vTaskDelay(pdMS_TO_TICKS({ms}));"
    return CodePort(headers=headers, sleep=sleep, wait=wait, threads="freertos", stack_unit=stack_unit, ticks=ticks)


def _arduino(*headers: str) -> CodePort:
    return CodePort(headers=headers, sleep="delay({ms});", wait="delayMicroseconds({us});", entry="arduino", suffix="cpp")


_PORTS: Mapping[str, CodePort] = {
    "arduino": _arduino("micro_ros_arduino.h"),
    "platformio": _arduino("Arduino.h", "micro_ros_platformio.h"),
    "espidf": _freertos(
        *("freertos/FreeRTOS.h", "freertos/task.h", "esp_rom_sys.h"),
        wait="esp_rom_delay_us({us});",
        stack_unit=1,
        ticks="CONFIG_FREERTOS_HZ",
    ),
    "zephyr": CodePort(
        headers=("zephyr/kernel.h",), sleep="k_sleep(K_USEC({us}));", wait="k_busy_wait({us});", threads="zephyr"
    ),
    "cubemx": _freertos("cmsis_os.h", "main.h", wait="HAL_Delay({ms});"),
    "renesas": _freertos("hal_data.h", "FreeRTOS.h", "task.h"),
    "freertos": _freertos("FreeRTOS.h", "task.h"),
    "pico-sdk": CodePort(headers=("pico/stdlib.h",), sleep="sleep_us({us});", wait="busy_wait_us({us});"),
    "nuttx": CodePort(headers=("nuttx/config.h", "unistd.h")),
}
_OF_SYSTEMS = {"freertos": "freertos", "zephyr": "zephyr", "nuttx": "nuttx"}


def code_port(port: str | None, rtos: str | None) -> CodePort:
    """The code of a port, or of the operating system if no port is stated."""
    return _PORTS.get(port or _OF_SYSTEMS.get(rtos or "", ""), CodePort(headers=("unistd.h",)))


def waiting(template: str, time: Time) -> str | None:
    """The call that waits for a time; None if the function cannot wait so long or so exactly."""
    unit = _MILLISECOND if "{ms}" in template else _MICROSECOND
    if not template or time % unit:
        return None
    return template.format(ms=time // _MILLISECOND, us=time // _MICROSECOND)
