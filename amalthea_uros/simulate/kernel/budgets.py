"""Servers: budgets that are used up and come back.

- Deferrable and polling servers (J. P. Lehoczky, L. Sha and J. K. Strosnider, "Enhanced aperiodic responsiveness in hard real-time
  environments", RTSS 1987): the budget is full at each period; a polling server loses it when it has nothing to serve.
- Sporadic servers (B. Sprunt, L. Sha and J. Lehoczky, "Aperiodic task scheduling for hard-real-time systems", Real-Time Systems 1,
  1989): what was used comes back one period after the server became active.
- Constant bandwidth servers (L. Abeni and G. Buttazzo, "Integrating multimedia applications in hard real-time systems", RTSS 1998): a
  new budget comes with a later deadline. SCHED_DEADLINE of Linux throttles them: what has used its budget up waits until the deadline
  (sched-deadline.rst, section 2).
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *


def has_budget(m: Memory, process: int) -> bool:
    """Whether all servers of a process have a budget."""
    server = m[process + SERVER]
    while server:
        if m[server + BUDGET] <= 0:
            return False
        server = m[server + PARENT]
    return True


def activate_server(m: Memory, server: int) -> None:
    """A server has something to serve, and so have those above it."""
    now = m[NOW]
    while server:
        if not m[server + IS_ACTIVE]:
            m[server + IS_ACTIVE] = 1
            if _has_deadline(m, server) and m[server + SERVER_AT] == NEVER:
                # A new deadline, unless the rest of the budget fits to the old one.
                left = m[server + SERVER_DEADLINE] - now
                if m[server + BUDGET] * m[server + PERIOD_RATIO] >= left * m[server + BUDGET_RATIO]:
                    m[server + SERVER_DEADLINE] = now + m[server + SERVER_PERIOD]
                    m[server + BUDGET] = m[server + FULL_BUDGET]
            elif m[server + SERVER_KIND] == SPORADIC:
                m[server + ACTIVE_SINCE] = now
                m[server + BUDGET_BEFORE] = m[server + BUDGET]
        if _has_deadline(m, server):
            pass_deadline_on(m, server)
        server = m[server + PARENT]


def _has_deadline(m: Memory, server: int) -> bool:
    return m[server + SERVER_KIND] == CONSTANT_BANDWIDTH or m[server + SERVER_KIND] == THROTTLED_BANDWIDTH


def pass_deadline_on(m: Memory, server: int) -> None:
    """The processes of a server have its deadline."""
    for place in range(m[server + SERVED], m[server + SERVED_END]):
        process = m[place]
        if m[process + HAS_SERVER_DEADLINE]:
            m[process + OWN_DEADLINE] = m[server + SERVER_DEADLINE]
            m[process + DEADLINE] = m[server + SERVER_DEADLINE]
            m[m[process + DOMAIN] + IS_DUE] = 1


def deactivate_server(m: Memory, server: int) -> None:
    """A server may have nothing to serve any more, and so may those above it."""
    while server:
        for place in range(m[server + SERVED], m[server + SERVED_END]):
            state = m[m[place] + STATE]
            if state != TERMINATED and state != WAITING:
                return
        m[server + IS_ACTIVE] = 0
        if m[server + SERVER_KIND] == POLLING_SERVER:
            m[server + BUDGET] = 0
        elif m[server + SERVER_KIND] == SPORADIC:
            plan(m, server)
        server = m[server + PARENT]


def exhaust(m: Memory, server: int) -> None:
    """A budget is used up."""
    if m[server + SERVER_KIND] == CONSTANT_BANDWIDTH:
        m[server + BUDGET] = m[server + FULL_BUDGET]
        m[server + SERVER_DEADLINE] += m[server + SERVER_PERIOD]
        pass_deadline_on(m, server)
    elif m[server + SERVER_KIND] == THROTTLED_BANDWIDTH:
        m[server + SERVER_AT] = max(m[server + SERVER_DEADLINE], m[NOW])
    elif m[server + SERVER_KIND] == SPORADIC:
        plan(m, server)
        m[server + ACTIVE_SINCE] = m[NOW]
    m[m[server + SERVER_DOMAIN] + IS_DUE] = 1


def plan(m: Memory, server: int) -> None:
    """Plan when a sporadic server gets back what it has used."""
    used = m[server + BUDGET_BEFORE] - m[server + BUDGET]
    if used <= 0:
        return
    m[server + BUDGET_BEFORE] = m[server + BUDGET]
    at = m[server + ACTIVE_SINCE] + m[server + SERVER_PERIOD]
    last = m[server + PLANS_END] - PLAN_SIZE
    place = m[server + PLANS]
    while m[place + PLAN_AMOUNT] and place < last:
        place += PLAN_SIZE
    # With no place left, it comes back together with what comes back later.
    m[place + PLAN_TIME] = max(at, m[place + PLAN_TIME])
    m[place + PLAN_AMOUNT] += used
    m[server + SERVER_AT] = min(m[server + SERVER_AT], m[place + PLAN_TIME])


def replenish(m: Memory, server: int) -> None:
    """A budget comes back."""
    if m[server + SERVER_KIND] == SPORADIC:
        _replenish_as_planned(m, server)
    elif m[server + SERVER_KIND] == THROTTLED_BANDWIDTH:
        m[server + SERVER_AT] = NEVER
        m[server + BUDGET] = m[server + FULL_BUDGET]
        m[server + SERVER_DEADLINE] += m[server + SERVER_PERIOD]
        pass_deadline_on(m, server)
    else:
        m[server + SERVER_AT] += m[server + SERVER_PERIOD]
        is_idle_polling = m[server + SERVER_KIND] == POLLING_SERVER and not m[server + IS_ACTIVE]
        m[server + BUDGET] = 0 if is_idle_polling else m[server + FULL_BUDGET]
    m[m[server + SERVER_DOMAIN] + IS_DUE] = 1


def _replenish_as_planned(m: Memory, server: int) -> None:
    if m[server + BUDGET] <= 0:
        # It cannot have become active before it had a budget.
        m[server + ACTIVE_SINCE] = m[NOW]
    m[server + SERVER_AT] = NEVER
    for place in range(m[server + PLANS], m[server + PLANS_END], PLAN_SIZE):
        if m[place + PLAN_AMOUNT] == 0:
            continue
        if m[place + PLAN_TIME] <= m[NOW]:
            m[server + BUDGET] += m[place + PLAN_AMOUNT]
            m[server + BUDGET_BEFORE] += m[place + PLAN_AMOUNT]
            m[place + PLAN_AMOUNT] = 0
            m[place + PLAN_TIME] = 0
        else:
            m[server + SERVER_AT] = min(m[server + SERVER_AT], m[place + PLAN_TIME])
