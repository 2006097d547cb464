"""Boards by the names that PlatformIO and amuros have for them: the platform, and what `Serial` of Arduino is on them."""

from __future__ import annotations

import re
from collections.abc import Mapping

#: Names of PlatformIO, or of controllers in ESP-IDF -> platforms.
_PLATFORMS = (
    (r"teensy4[01]", "teensy41"),
    (r"esp32|esp32dev|esp32doit\S*|nodemcu-32s|lolin32|esp-wrover-kit", "esp32"),
    (r"esp32-?s3\S*", "esp32-s3"),
    (r"pico|rpipico", "rp2040"),
    (r"nucleo_(f446re|f746zg|f767zi|h743zi)", r"nucleo-\1"),
    (r"olimex_e407", "olimex-stm32-e407"),
)
#: Boards whose `Serial` is a USB port of the controller itself, so that a rate means nothing.
_NATIVE_USB = r"teensy\S*|pico\S*|rpipico\S*|rp2040|nanorp2040connect|portenta\S*|zero\S*|mkr\S*|leonardo|adafruit_feather_m\S*"
#: Boards whose `Serial` is a UART, maybe with another chip for USB.
_UART = r"esp32|esp32dev|esp32doit\S*|nodemcu-32s|lolin32|esp-wrover-kit|nucleo\S*|uno\S*|mega\S*|due\S*|olimex\S*|ek-ra6m5"


def platform_of_board(board: str) -> str | None:
    """The platform of a board of PlatformIO; None if there is none."""
    for pattern, platform in _PLATFORMS:
        if (match := re.fullmatch(pattern, board)) is not None:
            return match.expand(platform)
    return None


def has_freertos(board: str) -> bool:
    """Whether Arduino runs on FreeRTOS there, with 1000 ticks per second: espressif/arduino-esp32."""
    return "esp32" in board or board in ("nodemcu-32s", "lolin32", "esp-wrover-kit")


def serial_of_board(board: str) -> str | None:
    """The kind of port that `Serial` is on a board, as `app.yaml` calls it; None if that is unknown."""
    return "usb_cdc" if re.fullmatch(_NATIVE_USB, board) else "serial" if re.fullmatch(_UART, board) else None


#: The sizes of the .meta file for boards with enough memory: micro-ROS/micro_ros_platformio metas/colcon.meta, as for Arduino.
_FULL = {
    "RMW_UXRCE_MAX_NODES": 1,
    "RMW_UXRCE_MAX_PUBLISHERS": 10,
    "RMW_UXRCE_MAX_SUBSCRIPTIONS": 5,
    "RMW_UXRCE_MAX_SERVICES": 1,
    "RMW_UXRCE_MAX_CLIENTS": 1,
    "RMW_UXRCE_MAX_HISTORY": 4,
}
#: Boards with the smallest sizes; of PlatformIO as extra_script.py of micro-ROS/micro_ros_platformio lists them.
_SMALLEST = {"platformio": r"due|zero|nanorp2040connect", "arduino": r"zero|nanorp2040connect|mkr\S*|nano_33_iot"}


def pools_of_board(port: str, board: str) -> Mapping[str, int]:
    """The pools of a board with more than the smallest library of a port; empty if that is not known."""
    known = platform_of_board(board) is not None or board in _KNOWN or port == "platformio"
    return _FULL if port in _SMALLEST and known and re.fullmatch(_SMALLEST[port], board) is None else {}


#: Platforms with the full library of Arduino.
_KNOWN = ("esp32", "teensy41")
