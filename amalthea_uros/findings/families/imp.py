"""Findings of importing source code."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

_INIT = """
void main(void) {
  check(rclc_node_init_default(&node, "n", "", &support));
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(5), on_timer));
  check(rclc_executor_init(&executor, &support.context, %s, &allocator));
  %s
}
"""
_ADD = "check(rclc_executor_add_timer(&executor, &timer));"
_SPIN = "while (1) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); usleep(1000); }"


def _kind(number: int, title: str, severity: Severity, rationale: str, remedy: str, fails: str = "") -> FindingKind:
    return FindingKind(id=f"IMP{number:03}", title=title, severity=severity, rationale=rationale, remedy=remedy, fails=fails)


_ERROR, _WARNING, _INFO = Severity.ERROR, Severity.WARNING, Severity.INFO

KINDS = (
    _kind(
        1,
        "value that is not filled in yet",
        _ERROR,
        "The value cannot be read from the source code, and an assumption instead of TODO could make a result too good.",
        "Replace TODO by a value.",
        """
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: TODO}
""",
    ),
    _kind(
        2,
        "source code that cannot be read",
        _ERROR,
        "The file is missing, too large or not text, or the parsers are not installed.",
        "Give files of C or C++ source code; install the parsers with pip install 'amuros[code]'.",
    ),
    _kind(
        3,
        "code that is not understood",
        _WARNING,
        "A call of rclc is in code that cannot be parsed, or that no path through the functions leads to. It is left out.",
        "Add what it does to the description by hand.",
        "#define MAKE(n) rclc_node_init_default(n, 0, 0, 0)\n" + _INIT % (1, f"{_ADD} {_SPIN}"),
    ),
    _kind(
        4,
        "value that is not constant",
        _WARNING,
        "The value is computed when the program runs, or depends on the path through it.",
        "Write the value into the description.",
        _INIT % ("count()", f"{_ADD} {_SPIN}"),
    ),
    _kind(
        5,
        "unknown function of rclc",
        _WARNING,
        "What the function does is not in the description.",
        "Add what it does to the description by hand.",
        _INIT % (1, f"{_ADD} rclc_executor_shuffle(&executor); {_SPIN}"),
    ),
    _kind(
        6,
        "more handles than the executor was initialised with",
        _ERROR,
        "Adding a handle then returns an error, and its callback never runs.",
        "Give rclc_executor_init the number of handles that are added.",
        _INIT % (0, f"{_ADD} {_SPIN}"),
    ),
    _kind(
        7,
        "pool of the middleware that is too small",
        _ERROR,
        "Creating the next entity returns an error. Without options in the sources this is a warning about the default sizes.",
        "Set the option in colcon.meta and rebuild libmicroros from scratch.",
    ),
    _kind(
        8,
        "return code that is not checked",
        _WARNING,
        "If the pool is exhausted or the agent does not answer, the program goes on without the entity.",
        "Compare the return code with RCL_RET_OK.",
        _INIT % (1, f"{_ADD} {_SPIN}") + "void more(void) { rclc_timer_init_default(&other, &support, 1, on_timer); }",
    ),
    _kind(
        9,
        "timeout below 1 ms",
        _WARNING,
        "The middleware waits whole milliseconds, so the executor polls. Timeouts are in nanoseconds.",
        "Use RCL_MS_TO_NS for the timeout.",
        _INIT % (1, f"{_ADD} while (1) {{ rclc_executor_spin_some(&executor, 100); usleep(100); }}"),
    ),
    _kind(
        10,
        "timeout of the executor that is not shorter than its period",
        _WARNING,
        "Each round of rclc_executor_spin_period waits for the timeout of the executor, 1 s by default, if nothing arrives.",
        "Call rclc_executor_set_timeout with less than the period.",
        _INIT % (1, f"{_ADD} rclc_executor_spin_period(&executor, RCL_MS_TO_NS(20));"),
    ),
    _kind(
        11,
        "timer that is faster than the loop",
        _WARNING,
        "A timer runs at most once per round, and periods that have passed are skipped.",
        "Sleep less in the loop, or use a longer period.",
        _INIT % (1, f"{_ADD} while (1) {{ rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); usleep(100000); }}"),
    ),
    _kind(
        12,
        "callback that waits for the agent",
        _INFO,
        "Publishing reliably waits until the agent has acknowledged the message, up to 1 s by default.",
        "Use best effort where losses are harmless.",
        _INIT % (1, f"check(rclc_publisher_init_default(&p, &node, t, name)); {_ADD} {_SPIN}")
        + "void on_timer(rcl_timer_t * timer, int64_t last) { check(rcl_publish(&p, &m, NULL)); }",
    ),
    _kind(
        13,
        "publication outside of callbacks",
        _WARNING,
        "The description has publications of callbacks only, so this load is missing in it.",
        "Describe it as a timer, or publish in the callback of a timer.",
        _INIT
        % (1, f"check(rclc_publisher_init_default(&p, &node, t, name)); {_ADD} check(rcl_publish(&p, &m, NULL)); {_SPIN}"),
    ),
    _kind(
        14,
        "trigger that is a function of the application",
        _WARNING,
        "Which callbacks it waits for cannot be read from the code.",
        "Write the sets of callbacks that it waits for into the description.",
        _INIT % (1, f"{_ADD} rclc_executor_set_trigger(&executor, both, NULL); {_SPIN}"),
    ),
    _kind(
        15,
        "code under an unknown condition",
        _INFO,
        "Whether it is compiled depends on a macro that the sources do not define. It is taken as compiled.",
        "Remove it from the description if it is not compiled.",
        _INIT % (1, f"\n#ifdef WITH_TIMER\n  {_ADD}\n#endif\n  {_SPIN}"),
    ),
    _kind(
        16,
        "several programs",
        _ERROR,
        "The same entry is defined in several files, so what they create would be mixed in one description.",
        "Give the files of one program.",
    ),
    _kind(
        17,
        "callback or executor that never runs",
        _WARNING,
        "Something is created but not added to an executor, or added without being created, or the executor never spins.",
        "Add it, or give the files in which that happens.",
        _INIT % (1, _SPIN),
    ),
    _kind(
        18,
        "loop without sleep",
        _INFO,
        "The thread only waits for messages; with timers alone, some versions of the middleware never wait.",
        "Sleep in the loop if other tasks with lower priority have to run.",
        _INIT % (1, f"{_ADD} while (1) {{ rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); }}"),
    ),
    _kind(
        19,
        "sources without micro-ROS",
        _ERROR,
        "No function of rclc that creates something is called.",
        "Give the files in which nodes and executors are created.",
        "void main(void) { start(); }",
    ),
)
