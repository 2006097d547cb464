"""What is shown of overloaded cores: shares, and what would resolve it. All tasks run at 1 MHz, so that a tick takes 1 us."""

from hand_made_systems import Proc, system, ticks

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.report.documents.overloads import overload_sections


def sections(*processes, triggers=()):
    return list(overload_sections(analyze_system(system(*processes, triggers=triggers))))


def test_the_share_of_each_process_and_what_it_takes():
    # 80 us + 20 us of 100 us, and 50 us of 200 us: 125 %, which 1 / 1.25 of the execution times, or 1.25 MHz, resolve.
    (found,) = sections(
        Proc("A", (ticks(20), Trigger(stimulus="go")), 100, priority=3),
        Proc("B", (ticks(50),), 200, priority=2),
        Proc("C", (ticks(80),), stimuli=("go",), priority=1),
        triggers=("go",),
    )
    table, sentences = found.blocks
    assert [(row[0], row[4]) for row in table.rows] == [("C", "80 %"), ("B", "25 %"), ("A", "20 %")]
    assert sentences.sentences == [
        "The processes need at least 125 % of the core: it takes execution times of at most 80 % of these, "
        "a clock of at least 1.25 MHz, or processes on another core."
    ]


def test_nothing_is_said_of_a_core_that_is_full():
    assert sections(Proc("A", (ticks(50),), 100, priority=2), Proc("B", (ticks(50),), 100, priority=1)) == []
