"""Cores, the domains whose processes share them, and servers."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import gcd

from amalthea_uros.perf.os import Policy
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.scheduling import Dispatching
from amalthea_uros.timing.scheduling.allocation import standard_policy
from amalthea_uros.trace.table import EntityKind

#: Places for what a sporadic server gets back.
_PLANS = 64
_KINDS = {
    Policy.DEFERRABLE_SERVER: layout.DEFERRABLE,
    Policy.POLLING_SERVER: layout.POLLING_SERVER,
    Policy.SPORADIC_SERVER: layout.SPORADIC,
    Policy.CONSTANT_BANDWIDTH_SERVER: layout.CONSTANT_BANDWIDTH,
    Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH: layout.CONSTANT_BANDWIDTH,
}


@dataclass(slots=True)
class HardwareRecords:
    """The records of cores, domains and servers.

    Attributes
    ----------
    cores, servers : by name
    domains : by core
    """

    resources: Resources
    dispatching: Dispatching
    cores: dict[str, int] = field(default_factory=dict)
    domains: dict[str, int] = field(default_factory=dict)
    servers: dict[str, int] = field(default_factory=dict)

    def place_cores(self) -> None:
        """Cores, and domains of those that share processes."""
        for number, core in enumerate(self.resources.context.system.cores):
            entity = self.resources.entities.number(EntityKind.CORE, core)
            fields = {layout.STOP: layout.NEVER, layout.CORE_NUMBER: number, layout.CORE_ENTITY: entity}
            self.cores[core] = self.resources.image.record(layout.CORE_SIZE, fields)
        for cores in self.dispatching.domains():
            domain = self.resources.image.record(layout.DOMAIN_SIZE)
            first, end = self.resources.image.items(self.cores[core] for core in cores)
            self.resources.image.put(domain, {layout.ITS_CORES: first, layout.ITS_CORES_END: end})
            for core in cores:
                self.domains[core] = domain
                self.resources.image.put(self.cores[core], {layout.CORE_DOMAIN: domain})

    def place_servers(self) -> None:
        """Servers that serve any of the processes that have records."""
        processes = self.resources.processes
        here = [self.dispatching.processes[name].scheduled for name in processes]
        for name in self.dispatching.servers:
            if any(self._is_within(item.server, name) for item in here):
                self.servers[name] = self.resources.image.record(layout.SERVER_SIZE)
        for name, record in self.servers.items():
            server = self.dispatching.servers[name]
            policy = standard_policy(server.scheduler.policy)
            kind = _KINDS[Policy(policy or "")]
            if policy == Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH:
                self.resources.context.notes.assume(f"the server {name!r} does not reuse what other servers leave")
            budget, period = self.resources.time(server.budget), self.resources.time(server.period)
            common = gcd(budget, period)
            served = [processes[item.name] for item in here if self._is_within(item.server, name)]
            first, end = self.resources.image.items(served)
            plans, plans_end = self.resources.image.items([0] * (_PLANS * layout.PLAN_SIZE if kind == layout.SPORADIC else 0))
            fields = {
                # The first period begins at 0: then a polling server loses its budget if it has nothing to serve.
                layout.SERVER_AT: 0 if kind in (layout.DEFERRABLE, layout.POLLING_SERVER) else layout.NEVER,
                layout.BUDGET: budget,
                layout.FULL_BUDGET: budget,
                layout.SERVER_PERIOD: period,
                layout.SERVER_KIND: kind,
                layout.PARENT: self.servers.get(server.server or "", 0),
                layout.SERVER_DOMAIN: self.domains[server.core],
                layout.SERVED: first,
                layout.SERVED_END: end,
                layout.BUDGET_RATIO: budget // common,
                layout.PERIOD_RATIO: period // common,
                layout.PLANS: plans,
                layout.PLANS_END: plans_end,
            }
            self.resources.image.put(record, fields)

    def _is_within(self, server: str | None, outer: str) -> bool:
        while server is not None and server != outer:
            server = self.dispatching.servers[server].server
        return server == outer
