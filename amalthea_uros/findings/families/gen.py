"""Findings of generating build options, and of checking those of others."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="GEN001",
        title="build option that is too small for the application",
        severity=Severity.ERROR,
        rationale="The middleware takes its objects from pools of fixed size. Creating an entity fails when its pool is full, and a "
        "message is dropped when no slot is free.",
        remedy="Set the option to the value that is needed, and rebuild the library from clean.",
        fails='{"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_MAX_PUBLISHERS=0"]}}}',
    ),
    FindingKind(
        id="GEN002",
        title="build option that is larger than necessary",
        severity=Severity.INFO,
        rationale="The pool occupies static memory that the application never uses.",
        remedy="Set the option to the smaller value, unless the application will grow.",
        fails='{"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_MAX_PUBLISHERS=10"]}}}',
    ),
    FindingKind(
        id="GEN003",
        title="unknown build option",
        severity=Severity.WARNING,
        rationale="CMake accepts any name, so a misspelled option is ignored without a message.",
        remedy="Correct the name, or remove the option.",
        fails='{"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_MAX_PUBLISHER=1"]}}}',
    ),
    FindingKind(
        id="GEN004",
        title="build option with an invalid value",
        severity=Severity.ERROR,
        rationale="The build stops with an error, or uses another value than the one that was meant.",
        remedy="Correct the value; the histories of streams are powers of two.",
        fails='{"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_STREAM_HISTORY=3"]}}}',
    ),
    FindingKind(
        id="GEN005",
        title="build option without effect",
        severity=Severity.WARNING,
        rationale="The option is not read any more, belongs to another transport or package, needs another one, or is set "
        "again further down.",
        remedy="Remove it, or follow the advice at the finding.",
        fails='{"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_XML_BUFFER_LENGTH=400"]}}}',
    ),
    FindingKind(
        id="GEN006",
        title="file that is not a colcon.meta",
        severity=Severity.ERROR,
        rationale="The file cannot be read, or has no build options in the form that colcon expects.",
        remedy="Correct the file at the location of the finding.",
        fails='{"names": {"rmw_microxrcedds": ["-DRMW_UXRCE_MAX_NODES=1"}}',
    ),
    FindingKind(
        id="GEN007",
        title="comment that colcon takes for a value",
        severity=Severity.WARNING,
        rationale="colcon reads the file as YAML, where `//` starts no comment. The text becomes part of the next value, which is "
        "then lost without a message, or the whole file is skipped.",
        remedy="Start comments with `#`, or remove them.",
        fails='{"names": {"rmw_microxrcedds": {"cmake-args": [\n  // one is enough\n  "-DRMW_UXRCE_MAX_NODES=1"]}}}',
    ),
    FindingKind(
        id="GEN008",
        title="build option that differs from the description",
        severity=Severity.WARNING,
        rationale="Lengths of messages, waiting times and memory were computed with another value than that of the build.",
        remedy="State the value of the build under middleware: limits, or change the build.",
        fails='{"names": {"microxrcedds_client": {"cmake-args": ["-DUCLIENT_CUSTOM_TRANSPORT_MTU=1024"]}}}',
    ),
    FindingKind(
        id="GEN009",
        title="description without a micro-ROS application",
        severity=Severity.ERROR,
        rationale="Without nodes there are no pools to set.",
        remedy="Add nodes under application.",
    ),
)
