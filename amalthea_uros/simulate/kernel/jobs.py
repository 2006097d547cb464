"""What a job does: the operations of its program, up to its next execution."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.activation import end_job, fire
from amalthea_uros.simulate.kernel.agent import part_arrives
from amalthea_uros.simulate.kernel.conditions import counts, holds, set_mode, step_mode
from amalthea_uros.simulate.kernel.cores import change_level, requeue, run, stays
from amalthea_uros.simulate.kernel.host_threads import call_next, have_called, host_publish
from amalthea_uros.simulate.kernel.iterations import (
    begin_iteration,
    begin_wait,
    check,
    expect,
    listen,
    plan_iteration,
    take_data,
)
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.messages import arrive, has_arrived, pass_on, post, publish, put_in_inbox
from amalthea_uros.simulate.kernel.reading import HAS_TO_WAIT, IS_DONE, has_to_write, read, reply
from amalthea_uros.simulate.kernel.reports import begin_execution, end_execution, observe, report_access, report_execution
from amalthea_uros.simulate.kernel.stages import follow
from amalthea_uros.simulate.kernel.waiting import await_events, change_events, request, serve, unlock
from amalthea_uros.simulate.kernel.wires import keep_values, lacks_value, reach_host, restore_values

#: Who does more at one instant does not end.
MOST_STEPS = 10_000_000


def resume_job(m: Memory, core: int) -> int:
    """Have the job of a core continue to its next execution, or until somebody else may be more urgent."""
    process = m[core + RUNS]
    due = m[core + CORE_DOMAIN] + IS_DUE
    while True:
        at = m[process + AT]
        operation = m[at]
        if operation == EXECUTE:
            m[process + AT] = at + OPERATION_SIZE
            _execute(m, core, process, m[at + 1])
            return CONTINUE
        if m[JOBS] >= m[JOBS_END] or m[OBSERVATIONS] >= m[OBSERVATIONS_END] or m[EVENTS] >= m[EVENTS_END]:
            return ROWS_FULL
        if operation == END:
            end_job(m, core)
            return CONTINUE
        m[STEPS] += 1
        if m[STEPS] > MOST_STEPS:
            m[CAUSE] = process
            return ENDLESS
        if operation == DRAW:
            stream = m[at + 1]
            if m[stream + STREAM_AT] == m[stream + STREAM_END]:
                m[CAUSE] = stream
                return STREAM_EMPTY
            m[process + AT] = at + OPERATION_SIZE
            duration = _draw(m, stream)
            if duration > 0:
                _execute(m, core, process, duration)
                return CONTINUE
            continue
        if operation == MASK and _yields(m, core, process):
            return CONTINUE
        code = _execute_operation(m, core, process, at)
        if code:
            return code - 1
        if REQUEST <= operation <= ANSWER and m[due] and not stays(m, core, process) and not _is_complete(m, m[process + AT]):
            return CONTINUE


def execute_writes(m: Memory, core: int) -> int:
    """Carry out the writes that directly follow an execution: a read on another core at the same instant sees them."""
    process = m[core + RUNS]
    while True:
        if m[OBSERVATIONS] >= m[OBSERVATIONS_END] or m[EVENTS] >= m[EVENTS_END]:
            return ROWS_FULL
        at = m[process + AT]
        operation = m[at]
        if not (NOTE <= operation <= END_EXECUTION or operation == REACH or operation == PUT):
            return CONTINUE
        code = _execute_operation(m, core, process, at)
        if code:
            return code - 1


def _yields(m: Memory, core: int, process: int) -> bool:
    """Whether somebody comes first at the instant at which a non-interruptible group would begin, which would keep it off."""
    due = m[core + CORE_DOMAIN] + IS_DUE
    requeue(m, process)
    if m[ARRIVAL] < m[ARRIVALS_END] and m[m[ARRIVAL]] == m[NOW]:
        m[due] = 1
        return True
    return m[due] != 0 and not stays(m, core, process)


def _is_complete(m: Memory, at: int) -> bool:
    """Whether a job has nothing left to do: it ends at once, as it needs the core no more."""
    while m[at] != END:
        operation = m[at]
        if operation == JUMP:
            at = m[at + 1]
        elif NOTE <= operation <= END_EXECUTION or operation == POINT or operation == UNMASK or operation >= ENTER:
            at += OPERATION_SIZE
        else:
            return False
    return True


def _execute(m: Memory, core: int, process: int, duration: int) -> None:
    m[process + LEFT] = duration
    m[core + NEEDS_STEP] = 0
    requeue(m, process)
    run(m, core, process)


def _draw(m: Memory, stream: int) -> int:
    value = m[m[stream + STREAM_AT]]
    m[stream + STREAM_AT] += 1
    return value


def _execute_operation(m: Memory, core: int, process: int, at: int) -> int:
    """Carry out an operation that takes no time; 0 if the job continues, otherwise a reason to stop plus 1."""
    operation, first, second = m[at], m[at + 1], m[at + 2]
    following = at + OPERATION_SIZE
    if operation >= ENTER:
        follow(m, process, operation, first, second)
    elif operation >= LISTEN:
        return _communicate(m, core, process, at)
    elif operation == COUNT:
        following = following if counts(m, first) else second
    elif operation == JUMP:
        following = first
    elif operation == TEST:
        following = following if holds(m, first) else second
    elif operation == CHOOSE or operation == SHUFFLE or operation == REPEAT:
        stream = first if operation == CHOOSE else second
        if m[stream + STREAM_AT] == m[stream + STREAM_END]:
            m[CAUSE] = stream
            return STREAM_EMPTY + 1
        value = _draw(m, stream)
        if operation == CHOOSE:
            following = m[second + value]
        elif operation == SHUFFLE:
            _shuffle(m, first, value)
        else:
            m[first + PASSES] = value
    elif operation == NEXT:
        following = _next_part(m, first) if m[first + PARTS_LEFT] else second
    elif operation == AGAIN:
        following = following if m[first + PASSES] > 0 else second
        m[first + PASSES] -= 1
    elif operation == NOTE:
        report_access(m, first, process, second)
    elif operation == BEGIN_RUNNABLE or operation == END_RUNNABLE:
        report_execution(m, process, first, operation == BEGIN_RUNNABLE)
    elif operation == OBSERVE:
        observe(m, first, core)
    elif operation == BEGIN_EXECUTION:
        begin_execution(m, first, process)
    elif operation == END_EXECUTION:
        end_execution(m, first, process)
    elif operation == MASK or operation == UNMASK:
        m[process + MASKS] += 1 if operation == MASK else -1
        change_level(m, process)
    elif operation == FIRE:
        m[MESSAGE] = m[process + ITS_MESSAGE] if second else 0
        code = fire(m, first, process)
        if code:
            return code + 1
    elif operation == POINT:
        # In a non-interruptible group, it has no effect.
        if m[process + MASKS] == 0:
            m[process + YIELDS] = 1
            change_level(m, process)
    elif operation == SEND or operation == RECEIVE:
        _change_channel(m, first, second if operation == SEND else -second)
    elif operation == SET_MODE:
        set_mode(m, first, second)
    elif operation == STEP_MODE:
        step_mode(m, first, second)
    elif operation == TAKE_MESSAGE:
        _take_message(m, process, first)
    elif operation == TEST_MESSAGE:
        following = following if m[first + HAS_TAKEN] else second
    else:
        # Who waits continues after this operation.
        m[process + AT] = following
        return 0 if _cooperate(m, core, process, operation, first, second) else CONTINUE + 1
    m[process + AT] = following
    return 0


def _cooperate(m: Memory, core: int, process: int, operation: int, first: int, second: int) -> bool:
    """Carry out an operation that concerns other processes; the result says whether the job continues."""
    if operation == REQUEST:
        return request(m, core, process, first, second)
    if operation == UNLOCK:
        unlock(m, process, first)
        return True
    if operation == SET_EVENT or operation == CLEAR_EVENT:
        change_events(m, process, first, operation == SET_EVENT)
        return True
    if operation == WAIT_EVENT:
        return await_events(m, core, process, first)
    return serve(m, core, process, operation, first, second)


def _communicate(m: Memory, core: int, process: int, at: int) -> int:
    """Carry out an operation of an executor, or about a message; the result is as that of `_execute_operation`."""
    operation, first, second = m[at], m[at + 1], m[at + 2]
    following, code = at + OPERATION_SIZE, CONTINUE
    if operation == LISTEN:
        listen(m, first)
    elif operation == BEGIN_WAIT:
        begin_wait(m, process, first)
    elif operation == EXPECT:
        expect(m, first, second)
    elif operation == READ:
        outcome = read(m, core, process, first)
        if outcome >= HAS_TO_WAIT:
            m[process + AT] = at
            return outcome - HAS_TO_WAIT + CONTINUE + 1
        following = second if outcome == IS_DONE else following
    elif operation == TRY_AGAIN:
        if m[first + IS_ANSWERED]:
            following = second
        else:
            m[first + TIMEOUTS] -= 1
    elif operation == REPLY or operation == WRITE:
        is_reply = operation == REPLY
        if is_reply and not has_to_write(m, first):
            m[process + AT] = second
            return 0
        result = reply(m, core, process, first) if is_reply else publish(m, core, process, first, second)
        if result <= 1:
            # Perhaps there is more to acknowledge.
            m[process + AT] = at if is_reply else following
        return result
    elif operation == BEGIN_ITERATION:
        begin_iteration(m, process)
    elif operation == CHECK:
        check(m, first)
    elif operation == TEST_TRIGGER:
        following = following if m[first + IS_TRIGGERED] else second
    elif operation == TEST_READY:
        following = following if m[first + IS_READY] or m[first + IS_ALWAYS_CALLED] else second
    elif operation == TEST_DATA:
        following = following if m[first + IS_READY] else second
    elif operation == TAKE_DATA:
        take_data(m, first)
    elif operation == PLAN_ITERATION:
        code = plan_iteration(m, process, first)
    elif operation == DEPART:
        code = lacks_value(m, m[first + TO_HOST])
        if code:
            return code + 1
        m[process + AT_HOST] = reach_host(m, first)
    elif operation == PASS_ON:
        code = pass_on(m, process, first)
    elif operation == HAVE_READ:
        if m[process + ITS_MESSAGE]:
            put_in_inbox(m, m[process + ITS_MESSAGE])
    elif operation == CALL_NEXT:
        code = call_next(m, core, process, first)
        if code:
            return code
        following = m[second + m[m[first + CALLED_HANDLE] + HANDLE_INDEX]]
    elif operation == HOST_PUBLISH:
        code = host_publish(m, first)
    elif operation == HAVE_CALLED:
        have_called(m, first)
    elif operation > POST:
        return _pass_wire(m, process, at)
    elif operation == PART_ARRIVES:
        code = part_arrives(m, process, first, second)
    else:
        code = post(m, process, first)
    if code:
        return code + 1
    m[process + AT] = following
    return 0


def _pass_wire(m: Memory, process: int, at: int) -> int:
    """Carry out an operation about what is sent on a wire that loses messages; the result is as that of `_execute_operation`."""
    operation, first, second = m[at], m[at + 1], m[at + 2]
    message, is_next, code = m[process + ITS_MESSAGE], True, CONTINUE
    if operation == ARRIVE:
        code = arrive(m, process, first)
    elif operation == TEST_PART:
        is_next = message == 0 or (m[message + PARTS_IN_IT] >> first) & 1 != 0
    elif operation == TEST_ARRIVED:
        is_next = has_arrived(m, process)
    elif message and operation == KEEP_VALUES:
        keep_values(m, message, first)
    elif message:
        is_next = not restore_values(m, message, first)
    if code:
        return code + 1
    m[process + AT] = at + OPERATION_SIZE if is_next else second
    return 0


def _change_channel(m: Memory, channel: int, elements: int) -> None:
    """Put elements into a channel or take them out; what does not fit is lost."""
    fill, capacity = max(0, m[channel + FILL] + elements), m[channel + CAPACITY]
    if 0 < capacity < fill:
        m[channel + OVERFLOWS] += fill - capacity
        fill = capacity
    m[channel + FILL] = fill


def _take_message(m: Memory, process: int, queue: int) -> None:
    """Take the first message of a queue if it has arrived before the activation of the job, or at the same time."""
    arrived = m[m[process + FIRST_PLACE] + QUEUE_CAPTURES + m[queue + MESSAGE_CAPTURE]]
    m[queue + HAS_TAKEN] = 1 if arrived > m[queue + TAKEN_MESSAGES] else 0
    m[queue + TAKEN_MESSAGES] += m[queue + HAS_TAKEN]


def _shuffle(m: Memory, group: int, word: int) -> None:
    """Begin a group in the order that a word stands for."""
    total = m[group + PARTS_TOTAL]
    m[group + WORD] = word
    m[group + PARTS_LEFT] = total
    for index in range(total):
        m[m[group + PARTS] + index] = m[m[group + ORDERED_PARTS] + index]


def _next_part(m: Memory, group: int) -> int:
    """Where a part of a group begins that has not been executed yet."""
    left, parts = m[group + PARTS_LEFT], m[group + PARTS]
    chosen = parts + m[group + WORD] % left
    m[group + WORD] //= left
    m[group + PARTS_LEFT] = left - 1
    part = m[chosen]
    m[chosen] = m[parts + left - 1]
    return part
