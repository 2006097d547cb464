"""Who has the cores: the most urgent ready processes of each domain, a domain being cores that share processes."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.budgets import exhaust, has_budget
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.reports import enter_state, report

#: The kinds of events, as in `trace.table.EventKind`.
_START, _PREEMPT, _RESUME, _PARK, _POLL_PARKING = 1, 2, 3, 7, 8


def run(m: Memory, core: int, process: int) -> None:
    """Have a process execute what is left of its execution, as far as its time slice and budgets go."""
    now = m[NOW]
    stop = now + m[process + LEFT]
    if m[process + SLICE]:
        stop = min(stop, now + m[process + SLICE_LEFT])
    server = m[process + SERVER]
    while server:
        stop = min(stop, now + m[server + BUDGET])
        server = m[server + PARENT]
    m[core + STOP] = stop
    m[core + BEGIN] = now


def pause(m: Memory, core: int, process: int) -> None:
    """Account for the time that a process has had its core since it was accounted for last."""
    used = m[NOW] - m[core + BEGIN]
    if used == 0:
        return
    m[core + BEGIN] = m[NOW]
    m[core + BUSY] += used
    m[process + LEFT] -= used
    if m[process + SLICE]:
        m[process + SLICE_LEFT] -= used
    server = m[process + SERVER]
    while server:
        m[server + BUDGET] -= used
        server = m[server + PARENT]


def stop(m: Memory, core: int) -> None:
    """An execution, a time slice or a budget of the process on a core ends now."""
    process = m[core + RUNS]
    pause(m, core, process)
    server = m[process + SERVER]
    while server:
        if m[server + BUDGET] <= 0:
            exhaust(m, server)
        server = m[server + PARENT]
    if m[process + LEFT] <= 0:
        m[core + NEEDS_STEP] = 1
        m[core + STOP] = NEVER
    else:
        requeue(m, process)
        run(m, core, process)


def requeue(m: Memory, process: int) -> None:
    """Who has used up its time slice, and executes more, lets its equals go first."""
    if m[process + SLICE] and m[process + SLICE_LEFT] <= 0:
        m[process + SLICE_LEFT] = m[process + SLICE]
        m[ORDER] += 1
        m[process + SEQUENCE] = m[ORDER]
        m[m[process + DOMAIN] + IS_DUE] = 1


def is_before(m: Memory, first: int, then: int) -> bool:
    """Whether a process is more urgent than another one."""
    if m[first + LEVEL] != m[then + LEVEL]:
        return m[first + LEVEL] > m[then + LEVEL]
    if m[first + DEADLINE] != m[then + DEADLINE]:
        return m[first + DEADLINE] < m[then + DEADLINE]
    if m[first + INNER] != m[then + INNER]:
        return m[first + INNER] > m[then + INNER]
    return m[first + SEQUENCE] < m[then + SEQUENCE]


def _is_held_back(m: Memory, process: int) -> bool:
    """Whether a cooperative task between two points keeps off another cooperative one."""
    domain = m[process + DOMAIN]
    if not m[domain + HAS_COOPERATIVE] or not m[process + IS_COOPERATIVE]:
        return False
    for place in range(m[domain + MEMBERS], m[domain + MEMBERS_END]):
        other = m[place]
        if other != process and m[other + IS_COOPERATIVE] and m[other + IS_STARTED] and not m[other + YIELDS]:
            return True
    return False


def dispatch(m: Memory, domain: int) -> None:
    """Give the core of a domain that has only one to the most urgent process."""
    assign(m, m[m[domain + ITS_CORES]], _most_urgent(m, domain))


def stays(m: Memory, core: int, process: int) -> bool:
    """Whether the process of a core is still the most urgent one; where cores share processes, that is not decided here."""
    domain = m[core + CORE_DOMAIN]
    return m[domain + ITS_CORES_END] - m[domain + ITS_CORES] == 1 and _most_urgent(m, domain) == process


def _most_urgent(m: Memory, domain: int) -> int:
    """The most urgent process that can execute; 0 if there is none."""
    best, place, group, left = 0, m[domain + MEMBERS], m[domain + GROUPS], m[domain + PRESENT]
    is_static, of_group = m[domain + RAISED] == 0, m[group]
    while left:
        while of_group == 0:
            # The next members.
            group += 1
            of_group = m[group]
            place = m[domain + MEMBERS] + (group - m[domain + GROUPS]) * GROUP_OF_MEMBERS
        process = m[place]
        place += 1
        state = m[process + STATE]
        if state == TERMINATED:
            continue
        left -= 1
        of_group -= 1
        if state == WAITING:
            continue
        if best and is_static and m[process + LEVEL] < m[best + LEVEL]:
            # Members are in the order of their levels.
            break
        if (m[process + SERVER] and not has_budget(m, process)) or _is_held_back(m, process):
            continue
        if best == 0 or is_before(m, process, best):
            best = process
    return best


def dispatch_all(m: Memory, domain: int) -> None:
    """Give several cores to the most urgent processes; who has a core stays on it if it can.

    As in global scheduling, a job can start and resume on any core that its process may use.
    """
    first, last = m[domain + ITS_CORES], m[domain + ITS_CORES_END]
    for place in range(first, last):
        m[m[place] + CHOSEN] = 0
    for _ in range(first, last):
        best, chosen = 0, 0
        for place in range(m[domain + MEMBERS], m[domain + MEMBERS_END]):
            process = m[place]
            if m[process + STATE] == TERMINATED or m[process + STATE] == WAITING or m[process + IS_CHOSEN]:
                continue
            if not has_budget(m, process) or _is_held_back(m, process):
                continue
            if best == 0 or is_before(m, process, best):
                core = _free_core(m, domain, process)
                if core:
                    best, chosen = process, core
        if best == 0:
            break
        m[chosen + CHOSEN] = best
        m[best + IS_CHOSEN] = 1
    for place in range(first, last):
        _keep_on_core(m, domain, m[place])
    for place in range(first, last):
        core = m[place]
        if m[core + CHOSEN]:
            m[m[core + CHOSEN] + IS_CHOSEN] = 0
        if m[core + RUNS] and m[core + RUNS] != m[core + CHOSEN]:
            _preempt(m, core)
    for place in range(first, last):
        assign(m, m[place], m[m[place] + CHOSEN])


def _free_core(m: Memory, domain: int, process: int) -> int:
    """The core for a process: the one that it had, or an idle one, or any that is not chosen yet; 0 if there is none."""
    own, found = m[process + CORE], 0
    if own and m[own + CHOSEN] == 0 and m[own + CORE_DOMAIN] == domain:
        if m[process + STATE] == RUNNING or m[process + STATE] == POLLING or m[own + RUNS] == 0:
            return own
    for place in range(m[domain + ITS_CORES], m[domain + ITS_CORES_END]):
        core = m[place]
        if m[core + CHOSEN] == 0 and m[m[process + ALLOWED] + m[core + CORE_NUMBER]]:
            if m[core + RUNS] == 0:
                return core
            if found == 0:
                found = core
    return found


def _keep_on_core(m: Memory, domain: int, core: int) -> None:
    """If the process of a core was chosen for another one, it changes places with that chosen here."""
    process, guest = m[core + RUNS], m[core + CHOSEN]
    if process == 0 or process == guest or m[process + IS_CHOSEN] == 0:
        return
    for place in range(m[domain + ITS_CORES], m[domain + ITS_CORES_END]):
        other = m[place]
        if m[other + CHOSEN] == process and m[m[guest + ALLOWED] + m[other + CORE_NUMBER]]:
            m[core + CHOSEN] = process
            m[other + CHOSEN] = guest


def assign(m: Memory, core: int, process: int) -> None:
    """Give a core to a process, or to none (0)."""
    running = m[core + RUNS]
    if process != running:
        if running:
            _preempt(m, core)
        if process:
            _dispatch(m, core, process)
    elif process:
        if m[process + YIELDS]:
            m[process + YIELDS] = 0
            set_level(m, process)
        if (m[process + SERVER] or m[process + SLICE]) and not m[core + NEEDS_STEP]:
            pause(m, core, process)
            run(m, core, process)


def _preempt(m: Memory, core: int) -> None:
    """Preempt the process of a core."""
    process = m[core + RUNS]
    pause(m, core, process)
    requeue(m, process)
    if m[core + NEEDS_STEP]:
        m[process + LEFT] = 0
        m[core + NEEDS_STEP] = 0
    if m[process + STATE] == POLLING:
        enter_state(m, process, PARKING)
        report(m, _PARK, core, process)
    else:
        enter_state(m, process, READY)
        report(m, _PREEMPT, core, process)
        m[process + PREEMPTIONS] += 1
    m[core + RUNS] = 0
    m[core + STOP] = NEVER


def _dispatch(m: Memory, core: int, process: int) -> None:
    """Start or resume a process."""
    before = m[process + STATE]
    m[core + RUNS] = process
    m[core + BEGIN] = m[NOW]
    if before == ACTIVATED:
        m[process + START] = m[NOW]
        m[process + SINCE] = m[NOW]
        m[process + STATE] = RUNNING
        m[process + IS_STARTED] = 1
        m[process + LEFT] = 0
        m[process + SLICE_LEFT] = m[process + SLICE]
        report(m, _START, core, process)
    else:
        if m[process + CORE] != core:
            m[process + MIGRATIONS] += 1
        if before == PARKING:
            enter_state(m, process, POLLING)
            report(m, _POLL_PARKING, core, process)
        else:
            enter_state(m, process, RUNNING)
            report(m, _RESUME, core, process)
    m[process + CORE] = core
    if m[process + YIELDS] or m[process + RUNNING_LEVEL] != m[process + OWN_LEVEL]:
        m[process + YIELDS] = 0
        set_level(m, process)
    if m[process + LEFT] > 0:
        run(m, core, process)
    else:
        m[core + NEEDS_STEP] = 1
        m[core + STOP] = NEVER


def leave_core(m: Memory, core: int) -> None:
    """The process of a core gives it away."""
    m[core + RUNS] = 0
    m[core + STOP] = NEVER
    m[core + NEEDS_STEP] = 0
    m[m[core + CORE_DOMAIN] + IS_DUE] = 1


def set_level(m: Memory, process: int) -> None:
    """Find the level and the deadline of a process: by what it holds, and whether it runs and keeps others off by that."""
    level, deadline, semaphore = m[process + OWN_LEVEL], m[process + OWN_DEADLINE], m[SEMAPHORES]
    if m[process + IS_STARTED] and not m[process + YIELDS]:
        level = max(level, m[process + RUNNING_LEVEL])
    for place in range(m[process + HOLDS], m[process + HOLDS] + (m[SEMAPHORES_END] - semaphore) * HOLD_SIZE, HOLD_SIZE):
        ceiling = m[m[semaphore] + CEILING]
        if m[place + HELD] and ceiling >= 0:
            # Among those that are in the order of their deadlines, a ceiling is a deadline.
            if not m[process + IS_BY_DEADLINE] or ceiling > m[process + OWN_LEVEL] + 1:
                level = max(level, ceiling)
            if m[process + IS_BY_DEADLINE]:
                deadline = min(deadline, m[place + HELD_SINCE] + m[m[semaphore] + DEADLINE_CEILING])
        semaphore += 1
    if m[process + MASKS]:
        level = NEVER
    restore_level(m, process)
    m[process + LEVEL] = level
    m[process + DEADLINE] = deadline
    if level != m[process + OWN_LEVEL] or deadline != m[process + OWN_DEADLINE]:
        m[m[process + DOMAIN] + RAISED] += 1


def restore_level(m: Memory, process: int) -> None:
    """A process has its own level and deadline again."""
    if m[process + LEVEL] != m[process + OWN_LEVEL] or m[process + DEADLINE] != m[process + OWN_DEADLINE]:
        m[m[process + DOMAIN] + RAISED] -= 1
        m[process + LEVEL] = m[process + OWN_LEVEL]
        m[process + DEADLINE] = m[process + OWN_DEADLINE]


def change_level(m: Memory, process: int) -> None:
    """Find the level of a process, and let the cores be given anew."""
    set_level(m, process)
    m[m[process + DOMAIN] + IS_DUE] = 1
