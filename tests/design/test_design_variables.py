"""What may change beside periods, priorities, offsets and cores: callbacks, communication, the memory of labels, clocks."""

import pytest

from amalthea_uros import InvalidArgumentError, Settings, analyze, build, diff, optimize
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.design.optimize.problem import Conclusion
from amalthea_uros.services.build import build_file
from amalthea_uros.services.changed_model import write_proposal
from amalthea_uros.timing.basics.settings import MemoryModel
from amalthea_uros.units import MICROSECOND as US

HARDWARE = """
amuros: 1
name: small
hardware:
  frequency: 100 MHz
  cores: 1
  core_type: X
  memories:
    - {name: Slow, kind: SRAM, size: 64 kB, read_cycles: 9, write_cycles: 9}
    - {name: Fast, kind: SRAM, size: 8 B, read_cycles: 1, write_cycles: 1}
    - {name: Code, kind: flash, size: 64 kB, read_cycles: 0, write_cycles: 0}
"""
INSIDE = """
amuros: 1
name: inside
hardware: single-core
middleware:
  executor:
    {name: Executor, period: 10 ms, callbacks: in-executor, order: [Control, Take], execution_time: {base: 20 us, per_message: 10 us}}
application:
  nodes:
    - name: n
      subscriptions:
        - {name: Take, topic: t, interval: 20 ms, message_size: 4 B, execution_time: 40 us, writes: [wanted]}
      timers:
        # Must stay.
        - {name: Control, period: 10 ms, execution_time: 100 us, reads: [wanted], writes: [output]}
chains:
  - {name: c, path: [Take, Control], reaction: 30 ms}
"""
TASKS = """
middleware: {executor: {period: 10 ms, execution_time: 1 us}}
tasks:
  - {name: Writer, period: 10 ms, execution_time: 10 us, writes: [a, b]}
  - {name: Reader, period: 20 ms, execution_time: 10 us, reads: [a]}
labels:
  a: 4 B # the only one that is listed
chains:
  - {name: c, path: [Writer, a, Reader], reaction: 100 ms}
"""


def reaction(path):
    (chain,) = analyze(path).chains
    return chain.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)


def write(tmp_path, text):
    path = tmp_path / "app.yaml"
    path.write_text(text)
    return path


def test_the_order_of_callbacks_decides_about_a_whole_period(tmp_path):
    source, target = write(tmp_path, INSIDE), tmp_path / "better.yaml"
    # Control runs before Take, which starts after 20 + 100 + 10 us; Control uses its value 10 ms + 20 us + 100 us after the activation.
    assert reaction(source).value == 9990 * US
    found = optimize(source, vary=["order"], limits=["c.max_reduced_reaction_time<1ms"])
    (proposal,) = found.proposals
    assert [str(each) for each in proposal.differences] == ["Executor.order: Control,Take -> Take,Control"]
    assert found.search.conclusion is Conclusion.OPTIMAL
    write_proposal(found, 1, target)
    assert reaction(target) == proposal.analysis.chains["c"].value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)
    # Take and Control one after the other.
    assert reaction(target).value == 140 * US
    assert "order: [Take, Control]" in target.read_text()
    assert "# Must stay." in target.read_text()


@pytest.mark.parametrize("suffix", ["yaml", "amxmi"])
def test_a_callback_moves_to_a_task_of_its_own(suffix, tmp_path):
    source, target = write(tmp_path, INSIDE), tmp_path / f"better.{suffix}"
    found = optimize(source, vary=["callbacks"], goals=["Executor.response_time"], may_be_later=True)
    best = found[0]
    # Without callbacks the executor needs 20 us, and 10 us for a message.
    assert best.analysis.processes["Executor"].response.worst == 30 * US
    assert {each.target for each in best.differences} == {"Take.runs_in", "Control.runs_in"}
    write_proposal(found, 1, target)
    assert reaction(target) == best.analysis.chains["c"].value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)
    assert {each.name for each in analyze(target).processes} == {"Executor", "Take", "Control"}


def test_a_deadline_keeps_its_callback_out_of_the_executor(tmp_path):
    text = INSIDE.replace("order: [Control, Take], ", "").replace(
        "name: Control,", "name: Control, runs_in: own-task, deadline: 5 ms,"
    )
    found = optimize(write(tmp_path, text), vary=["callbacks"], keep=["Take"], is_complete=True)
    assert [proposal.differences for proposal in found.proposals] == [()]


def test_only_a_description_says_where_callbacks_run(tmp_path):
    with pytest.raises(InvalidArgumentError, match=r"only an app.yaml"):
        optimize(build(write(tmp_path, INSIDE)).model, vary=["callbacks"])


def test_too_many_orders_are_refused(tmp_path):
    more = "".join(f"        - {{name: T{number}, period: 10 ms, execution_time: 1 us}}\n" for number in range(5))
    text = INSIDE.replace("chains:\n", more + "chains:\n").replace("order: [Control, Take], ", "")
    with pytest.raises(InvalidArgumentError, match=r"5,040 combinations; at most 500"):
        optimize(write(tmp_path, text), vary=["order"])


def test_labels_move_to_the_memory_that_has_room(tmp_path):
    source, target = write(tmp_path, HARDWARE + TASKS), tmp_path / "better.yaml"
    settings = Settings(memory=MemoryModel.EXPLICIT)
    found = optimize(source, vary=["memory"], goals=["load"], settings=settings)
    # 4 B each, both fit into the 8 B. Flash would be faster still, but is no place for what is written.
    assert {str(change) for change in found[0].changes} == {"a.memory=Fast", "b.memory=Fast"}
    assert found.search.conclusion is Conclusion.OPTIMAL
    write_proposal(found, 1, target)
    assert "a: {size: 4 B, memory: Fast} # the only one that is listed" in target.read_text()
    changes = {str(each) for change in diff(source, target).timing for each in change.differences}
    assert changes == {"a.memory: Slow -> Fast", "b.memory: Slow -> Fast"}
    full = optimize(
        write(tmp_path, (HARDWARE + TASKS).replace("8 B,", "4 B,")), vary=["memory"], goals=["load"], settings=settings
    )
    # The label that is accessed more often is the one that moves.
    assert [str(change) for change in full[0].changes] == ["a.memory=Fast"]
    assert full.search.broken == {"Fast is too small for its data": 1}
    with pytest.raises(InvalidArgumentError, match="--memory"):
        optimize(source, vary=["memory"])


def test_let_communication_is_written_into_a_model_and_not_into_a_description(tmp_path):
    source, target = write(tmp_path, HARDWARE + TASKS), tmp_path / "better.amxmi"
    found = optimize(source, vary=["communication"], goals=["c.max_reduced_reaction_time"], may_be_later=True, is_complete=True)
    implicit, let = found.proposals
    # The value of the period [0, 10) is published at 10 ms, and read at 20 ms: with offsets of 0 always in the same way.
    assert [str(change) for change in let.changes] == ["a.communication=LET"]
    assert implicit.changes == ()
    values = [each.analysis.chains["c"].value(LatencyQuantity.MAX_REDUCED_REACTION_TIME).value for each in (implicit, let)]
    assert values[0] < values[1]
    write_proposal(found, 2, target)
    assert reaction(target).value == values[1]
    with pytest.raises(InvalidArgumentError, match=r"an app.yaml does not state"):
        write_proposal(found, 2, tmp_path / "better.yaml")


def test_a_slower_clock_is_chosen_among_those_on_offer(tmp_path):
    source, target = build_file(write(tmp_path, HARDWARE + TASKS)).document.path, tmp_path / "better.amxmi"
    found = optimize(
        source,
        vary=[],
        offers=["Core_0.frequency=50MHz,25MHz"],
        limits=["Core_0.load<=1%"],
        may_be_later=True,
        is_complete=True,
    )
    # 10 us in 10 ms and 10 us in 20 ms are 0.15 % at 100 MHz.
    assert len(found.proposals) == 3
    slow = next(each for each in found.proposals if "25" in str(each.differences))
    assert float(slow.analysis.processors["Core_0"].worst) == pytest.approx(4 * 0.0015)
    write_proposal(found, 1 + found.proposals.index(slow), target)
    assert analyze(target).processors["Core_0"].worst == slow.analysis.processors["Core_0"].worst


def test_a_description_does_not_say_how_long_its_code_takes_at_another_clock(tmp_path):
    with pytest.raises(InvalidArgumentError, match="those at the present clock"):
        optimize(write(tmp_path, HARDWARE + TASKS), vary=[], offers=["Core_0.frequency=50MHz"])
