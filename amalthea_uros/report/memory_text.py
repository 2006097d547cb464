"""The memory of micro-ROS as rows of a table."""

from __future__ import annotations

from amalthea_uros.uros.memory import MemoryDemand, StackUse


def memory_rows(memory: MemoryDemand) -> list[tuple[str, str, str]]:
    """The parts with sizes and remarks, then total, budget and memory of the board; empty without micro-ROS and stated stacks."""
    rows = [(use.name, f"{use.size} B" if use.is_bounded else "?", use.formula) for use in memory.uses]
    if memory.stacks.users:
        rows.append(("stack, shared" if memory.stacks.shared else "stacks", f"{memory.stacks.size} B", _stacks(memory.stacks)))
    if not rows:
        return []
    missing = memory.stacks.unknown
    unknown = f"without the stacks of {', '.join(missing)}, which are not stated" if missing else ""
    rows.append(("total" if memory.is_complete else "total, at least", f"{memory.total} B", unknown))
    for name, size in (("budget", memory.budget), ("memory of the board", memory.ram)):
        if size is not None:
            rows.append((name, f"{size} B", ""))
    return rows


def _stacks(stacks: StackUse) -> str:
    parts = [f"{user.size} B ({user.name})" for user in stacks.users if user.size]
    return f"longest chain of preemption: {' + '.join(parts)}" if stacks.shared else " + ".join(parts)
