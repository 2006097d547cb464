"""The loop over instants."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.budgets import replenish
from amalthea_uros.simulate.kernel.cores import dispatch, dispatch_all, pause, stop
from amalthea_uros.simulate.kernel.jobs import execute_writes, resume_job
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.occurrences import occur


def run_kernel(m: Memory) -> int:
    """Play until something needs the driver; the result says what."""
    first_core, last_core, has_servers = m[CORES], m[CORES_END], m[SERVERS] != m[SERVERS_END]
    first_domain, last_domain = m[DOMAINS], m[DOMAINS_END]
    while True:
        needs_step = True
        while needs_step:
            needs_step = False
            if m[HAS_WRITES]:
                for place in range(first_core, last_core):
                    if m[m[place] + NEEDS_STEP]:
                        code = execute_writes(m, m[place])
                        if code:
                            return code
            for place in range(first_core, last_core):
                core = m[place]
                if m[core + NEEDS_STEP]:
                    code = resume_job(m, core)
                    if code:
                        return code
            code = occur(m)
            if code:
                return code
            if has_servers:
                _replenish(m)
            for place in range(first_domain, last_domain):
                while m[m[place] + IS_DUE]:
                    needs_step = True
                    code = _settle(m, m[place])
                    if code:
                        return code
        now = m[m[ARRIVAL]] if m[ARRIVAL] < m[ARRIVALS_END] else m[UNTIL]
        for place in range(first_core, last_core):
            now = min(now, m[m[place] + STOP])
        for place in range(m[ALARMS], m[ALARMS_END]):
            now = min(now, m[m[place] + ALARM_AT])
        if has_servers:
            for place in range(m[SERVERS], m[SERVERS_END]):
                now = min(now, m[m[place] + SERVER_AT])
        if now >= m[UNTIL]:
            return WINDOW
        # Activations and preemptions are reported without a job that continues.
        if m[OBSERVATIONS] >= m[OBSERVATIONS_END] or m[EVENTS] >= m[EVENTS_END]:
            return ROWS_FULL
        m[NOW] = now
        m[STEPS] = 0
        for place in range(first_core, last_core):
            if m[m[place] + STOP] == now:
                stop(m, m[place])


def _settle(m: Memory, domain: int) -> int:
    """The cores of a domain are given anew, and the jobs there continue."""
    first, last = m[domain + ITS_CORES], m[domain + ITS_CORES_END]
    m[domain + IS_DUE] = 0
    if last - first == 1:
        dispatch(m, domain)
    else:
        dispatch_all(m, domain)
    for place in range(first, last):
        if m[m[place] + NEEDS_STEP]:
            code = resume_job(m, m[place])
            if code:
                return code
    return 0


def _replenish(m: Memory) -> None:
    """The budgets come back that are due."""
    for place in range(m[SERVERS], m[SERVERS_END]):
        server = m[place]
        if m[server + SERVER_AT] <= m[NOW]:
            for core in range(m[CORES], m[CORES_END]):
                if m[m[core] + RUNS]:
                    pause(m, m[core], m[m[core] + RUNS])
            replenish(m, server)
