"""The handles of an executor: their kinds, order, number and defaults."""

from looping import described, executor_of

from amalthea_uros.perf.executors import HandleKind, TriggerKind
from amalthea_uros.units import MILLISECOND

ALL_KINDS = """
      subscriptions:
        - {name: Sub, topic: t, rate: 20 Hz, message_size: 8 B, execution_time: 1 us, jitter: 5 ms, invocation: always, depth: 3}
      services: [{name: Srv, request_size: 4 B, response_size: 8 B, execution_time: 1 us, rate: 1 Hz, history: keep-all}]
      timers: [{name: Tim, period: 50 ms, execution_time: 1 us, phase: 20 ms}]
      clients: [{name: Ask, service: s, request_size: 4 B, response_size: 8 B, execution_time: 1 us, rate: 1 Hz}]
      guard_conditions: [{name: Stop, execution_time: 1 us}]
      action_servers: [{name: Move, goal_size: 8 B, result_size: 8 B, feedback_size: 8 B, execution_time: 1 us, rate: 1 Hz}]
      action_clients: [{name: Go, action: go, goal_size: 8 B, result_size: 8 B, feedback_size: 8 B, execution_time: 1 us, rate: 1 Hz}]
      parameter_server: {execution_time: 1 us}
      lifecycle: {services: 2, execution_time: 1 us}
"""


def test_there_are_handles_of_all_kinds_in_the_order_of_the_file():
    handles = executor_of("{loop: {spin: 1 s}}", ALL_KINDS).handles
    # 6 services of a parameter server: RCLC_EXECUTOR_PARAMETER_SERVER_HANDLES of ros2/rclc.
    assert [(handle.name, handle.kind) for handle in handles] == [
        ("Sub", HandleKind.SUBSCRIPTION),
        ("Tim", HandleKind.TIMER),
        ("Srv", HandleKind.SERVICE),
        ("Ask", HandleKind.CLIENT),
        ("Stop", HandleKind.GUARD_CONDITION),
        ("Move", HandleKind.ACTION_SERVER),
        ("Go", HandleKind.ACTION_CLIENT),
        *((f"node_Parameters_{number}", HandleKind.PARAMETER_SERVICE) for number in range(1, 7)),
        *((f"node_Lifecycle_{number}", HandleKind.LIFECYCLE_SERVICE) for number in (1, 2)),
    ]


def test_a_handle_has_what_its_section_says_and_unknown_is_unknown():
    handles = {handle.name: handle for handle in executor_of("{loop: {spin: 1 s}}", ALL_KINDS).handles}
    sub, timer, stop = handles["Sub"], handles["Tim"], handles["Stop"]
    assert (sub.interval, sub.jitter, sub.always, sub.depth, sub.phase) == (50 * MILLISECOND, 5 * MILLISECOND, True, 3, None)
    assert (timer.interval, timer.phase, timer.depth) == (50 * MILLISECOND, 20 * MILLISECOND, None)
    assert (stop.interval, stop.depth, stop.reliable) == (None, None, False)
    assert not handles["Srv"].overwrites
    assert sub.overwrites
    # Only topics have messages that come regularly; 10 is the depth of the default profile of ros2/rmw.
    assert [name for name, handle in handles.items() if handle.is_periodic] == ["Sub", "Tim"]
    assert handles["Ask"].depth == 10
    # ros2/rcl rcl_action: 3 services and a timer; 3 clients and 2 subscriptions.
    assert (handles["Move"].sources, handles["Go"].sources, sub.sources) == (4, 5, 1)
    assert handles["node_Parameters_1"].interval is None


def test_best_effort_messages_have_the_depth_of_sensor_data():
    first, second, _ = executor_of("{loop: {spin: 1 s}}").handles
    assert (first.reliable, first.depth) == (False, 5)
    assert (second.reliable, second.depth) == (True, 10)


def test_the_order_of_the_executor_is_the_order_of_its_handles():
    assert [handle.name for handle in executor_of("{loop: {spin: 1 s}, order: [Control, On_Map]}").handles] == [
        "Control",
        "On_Map",
        "On_Command",
    ]


def test_transmissions_are_named_only_if_a_wire_is_described():
    assert {handle.transmission for handle in executor_of("{loop: {spin: 1 s}}").handles} == {None}
    handles = executor_of("{loop: {spin: 1 s}}", more="transport: {can: {bitrate: 500 kbit/s}}").handles
    assert handles[0].transmission == "command_topic_to_On_Command"
    assert handles[2].publications[0].transmission == "state_topic_from_Control"


def test_what_publishes_reliably_waits_unless_the_middleware_does_not():
    callbacks = """
      publishers: [{topic: state, message_size: 8 B}]
      timers: [{name: Control, period: 50 ms, execution_time: 300 us, publishes: [state]}]
"""
    waiting, other = (
        executor_of("{loop: {spin_some: 1 ms, sleep: 1 ms}}", callbacks, more=more).handles[0].publications[0]
        for more in ("", "reliable: {waits: false}")
    )
    # RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT of micro-ROS/rmw_microxrcedds is 1000 ms.
    assert (waiting.waits, waiting.timeout) == (True, 1000 * MILLISECOND)
    assert (other.waits, other.timeout) == (False, None)


def test_a_callback_in_a_task_of_its_own_is_activated_by_its_executor():
    callbacks = """
      subscriptions:
        - {name: Sub, topic: t, rate: 20 Hz, message_size: 8 B, execution_time: 1 ms, runs_in: own-task}
        - {name: Polled, topic: u, rate: 20 Hz, message_size: 8 B, execution_time: 1 ms, runs_in: own-task, task_period: 10 ms}
"""
    system = described("{name: Main, loop: {spin: 1 s}}", callbacks).system
    sub, polled = system.executors[0].handles
    assert [activity.stimulus for activity in system.runnables[sub.runnable].activities[-1:]] == list(
        system.processes["Sub"].stimuli
    )
    assert (sub.runnable, sub.publications) == ("Take_Sub", ())
    assert "trigger" not in repr(system.runnables[polled.runnable].activities)
    assert system.stimuli_by_name[system.processes["Polled"].stimuli[0]].period == 10 * MILLISECOND


def test_triggers_name_handles():
    custom = executor_of("{loop: {spin: 1 s}, trigger: {custom: [[On_Map, Control], [On_Command]]}}").trigger
    assert custom.kind is TriggerKind.CUSTOM
    assert custom.sets == (frozenset({"On_Map", "Control"}), frozenset({"On_Command"}))
    assert executor_of("{loop: {spin: 1 s}, trigger: {one: On_Map}}").trigger.sets == (frozenset({"On_Map"}),)


def test_several_executors_share_a_session_if_the_middleware_is_built_for_threads():
    executors = "executors: [{name: A, loop: {spin: 1 s}}, {name: B, loop: {spin: 1 s}}]"
    callbacks = """
      subscriptions:
        - {name: One, topic: t, rate: 20 Hz, message_size: 8 B, execution_time: 1 us}
        - {name: Two, topic: u, rate: 20 Hz, message_size: 8 B, execution_time: 1 us, runs_in: B}
"""
    first, second = described(executors, callbacks, "multithread: true").system.executors
    assert [[handle.name for handle in each.handles] for each in (first, second)] == [["One"], ["Two"]]
    assert first.session == second.session is not None
    assert executor_of("{loop: {spin: 1 s}}").session is None
