"""Requirements on jitters: by hand, for the thesis, and against simulated runs."""

import textwrap

from effort import examples
from fuzzing.contradictions import contradictions
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration
from amalthea_uros.uros.described import describe_text

ADVANCED = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text()
HEAD = """\
amuros: 1
name: jitter
hardware: {platform: single-core}
"""


def system(text):
    return describe_text(text).assembly.system


def on_one_core(tasks, *requirements):
    """A description of tasks on a core at 1 MHz, with requirements."""
    return HEAD + f"tasks:\n{textwrap.indent(tasks, '  ')}\nrequirements: [{', '.join(requirements)}]\n"


def judged(system):
    """Of each requirement the ends of its value in microseconds, and the verdict."""
    found = analyze_system(system).requirements
    return [(each.lower and each.lower / US, each.upper and each.upper / US, str(each.verdict)) for each in found]


class TestOfTheThesis:
    """S. R. Bappanadu 2022, section 1.2: latency of the control function 1 ms, jitter below 0.5 ms."""

    def test_a_message_delays_the_response_by_13_us(self):
        text = ADVANCED.replace("response_time: 1 ms", "jitter: 0.5 ms")
        (jitter, _) = analyze_system(system(text)).requirements
        assert (jitter.quantity, jitter.value, jitter.verdict) == ("response time jitter", 13 * US, Verdict.MET)

    def test_and_the_distance_of_two_starts_as_well(self):
        # Figure 6.6: 987 to 1013 us from one start to the next.
        text = ADVANCED.replace("response_time: 1 ms", "jitter: {of: start_to_start, max: 12 us}")
        assert judged(system(text))[0] == (13, 13, "missed")

    def test_the_jitter_of_a_chain_is_that_over_all_phases(self):
        # In each phase, all reactions take the same time. But nobody states that the phase never drifts: from 1016 to 20029 us.
        text = ADVANCED.replace("reaction: 25 ms", "jitter: 19 ms")
        assert judged(system(text))[1] == (0, 19_013, "unknown")
        assert judged(system(text.replace("jitter: 19 ms", "jitter: 20 ms")))[1] == (0, 19_013, "met")

    def test_that_of_a_known_phase_is_exact(self):
        known = ADVANCED.replace("execution_time: 2 us,", "execution_time: 2 us, phase: 0 ms,")
        assert judged(system(known.replace("reaction: 25 ms", "jitter: 1 us")))[1] == (0, 0, "met")


class TestByHand:
    def test_what_varies_alone_varies_by_its_execution_time(self):
        tasks = "- {name: A, period: 1 ms, execution_time: {min: 4 us, max: 10 us}}"
        assert judged(system(on_one_core(tasks, "{process: A, jitter: 6 us}", "{process: A, jitter: 5 us}"))) == [
            (6, 6, "met"),
            (6, 6, "missed"),
        ]

    def test_a_task_of_half_the_rate_delays_every_second_start(self):
        # A has the higher priority by its number: B starts after 10 us in jobs without A, and after 20 us in those with it.
        tasks = """\
            - {name: A, period: 2 ms, execution_time: 10 us, priority: 9}
            - {name: B, period: 1 ms, execution_time: 10 us, priority: 5}"""
        found = judged(
            system(
                on_one_core(
                    textwrap.dedent(tasks),
                    "{process: B, jitter: {of: start_delay, max: 10 us}}",
                    "{process: B, jitter: {of: start_to_start, max: 9 us}}",
                    "{process: B, jitter: {of: end_to_end, max: 10 us}}",
                    "{process: B, jitter: {of: gross_execution_time, max: 1 us}}",
                )
            )
        )
        assert found == [(10, 10, "met"), (10, 10, "missed"), (10, 10, "met"), (0, 0, "met")]

    def test_a_deviation_from_the_period_needs_a_period(self):
        tasks = "- {name: A, sporadic: {min: 1 ms, max: 2 ms}, execution_time: 10 us}"
        (found,) = analyze_system(
            system(on_one_core(tasks, "{process: A, jitter: {of: start_to_start, max: 5 ms}}"))
        ).requirements
        assert (found.verdict, found.upper) == (Verdict.UNKNOWN, None)
        assert found.reason == "'A' is not activated by exactly one periodic stimulus, so it has no nominal period"

    def test_an_overload_has_no_bound(self):
        tasks = "- {name: A, period: 1 ms, execution_time: 2 ms, activation_limit: 9}"
        assert judged(system(on_one_core(tasks, "{process: A, jitter: 9 s}"))) == [(None, None, "unknown")]


TASK = st.fixed_dictionaries(
    {
        "period": st.sampled_from(["1 ms", "2 ms", "5 ms"]),
        "least": st.integers(1, 150),
        "more": st.sampled_from([0, 1, 150]),
        "offset": st.sampled_from(["0 us", "30 us", "700 us"]),
        "jitter": st.sampled_from(["", "", ", jitter: 100 us"]),
    }
)
QUANTITIES = ("response_time", "start_delay", "net_execution_time", "gross_execution_time", "start_to_start", "end_to_end")


def of_random_tasks(tasks, limit):
    lines = "\n".join(
        f"- {{name: T{number}, period: {task['period']}, offset: {task['offset']}{task['jitter']}, priority: {number}, "
        f"execution_time: {{min: {task['least']} us, max: {task['least'] + task['more']} us}}}}"
        for number, task in enumerate(tasks)
    )
    limits = [f"{{process: T{n}, jitter: {{of: {of}, max: {limit} us}}}}" for n in range(len(tasks)) for of in QUANTITIES]
    return on_one_core(lines, *limits)


@given(tasks=st.lists(TASK, min_size=1, max_size=3), limit=st.sampled_from([1, 100, 300]))
@examples(8)
def test_no_run_has_a_greater_jitter_than_the_bound(tasks, limit):
    described = system(of_random_tasks(tasks, limit))
    analysis = analyze_system(described)
    for mode in (Mode.SAMPLED, Mode.WORST, Mode.BEST):
        run = simulate_system(described, Options(duration=Duration(60 * MS), mode=mode, seed=len(tasks)))
        assert list(contradictions(analysis, run)) == []
        for bound, observed in zip(analysis.requirements, run.requirements, strict=True):
            assert bound.upper is None or observed.value is None or observed.value <= bound.upper, bound.name
