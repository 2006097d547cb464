"""The thesis's application with other periods, and with single changes, as design.json describes them."""

from fractions import Fraction

from amalthea_uros.design.changes.change import Change
from amalthea_uros.services.optimize import Optimization, optimize


def changes_of(row: dict) -> tuple[Change, ...]:
    """The changes of a row."""
    found = []
    for key, value in row["change"].items():
        if key == "priority_order":
            found += [Change(task, "priority", str(number)) for task, number in zip(value, (3, 2, 1), strict=True)]
        else:
            found.append(Change(*key.rsplit(".", 1), f"{value}us"))
    return tuple(found)


def application(problem: dict) -> str:
    """The description of a problem."""
    executor, subscription, timer = problem["executor"], problem["subscription"], problem["timer"]
    longest_execution = max(executor["with_message"], subscription["execution_time"], timer["execution_time"])
    shortest = min(period for period in problem["periods_on_offer"] if period > longest_execution)
    return f"""
amuros: 1
name: periods
hardware: single-core
middleware:
  executor:
    name: Executor_Task
    period: {shortest} us
    priority: 3
    execution_time: {{base: {executor["base"]} us, per_message: {executor["with_message"] - executor["base"]} us}}
application:
  nodes:
    - name: node
      timers:
        - name: Control_Function
          period: {shortest} us
          priority: 2
          execution_time: {timer["execution_time"]} us
          reads: [b]
          writes: [c]
      subscriptions:
        - name: Message_Factor
          topic: factor
          rate: {Fraction(10**6, problem["message_interval"])} Hz
          message_size: 4 B
          task_period: {shortest} us
          priority: 1
          buffer: a
          execution_time: {subscription["execution_time"]} us
          writes: [b]
chains:
  - {{name: chain, path: [Executor_Task, Message_Factor, Control_Function], reaction: {problem["chain_limit"]} us}}
"""


def choose_periods(problem: dict) -> Optimization:
    """Judge all periods on offer."""
    offers = ",".join(f"{period}us" for period in problem["periods_on_offer"])
    tasks = ("Executor_Task", "Message_Factor", "Control_Function")
    return optimize(
        application(problem),
        vary=(),
        offers=[f"{task}.period={offers}" for task in tasks],
        goals=["load", "chain.max_reduced_reaction_time"],
        is_rate_monotonic=True,
        may_be_later=True,
        proposals=0,
    )
