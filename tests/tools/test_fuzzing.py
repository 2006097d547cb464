"""The fuzzer: equal seeds give equal cases, failures are found and shrunk, and no hostile file breaks a command."""

import os
import signal
import sys
from random import Random

import fuzz_readers
import pytest
from effort import every
from fuzzing import byte_mutations, cases, commands, invariants, line_mutations, sandbox
from fuzzing.cases import Case
from fuzzing.contradictions import contradictions
from fuzzing.seeds import seeds
from fuzzing.shrinking import minimal, shrunk
from support import ROOT

from amalthea_uros import analyze_files, simulate

HOSTILE = ROOT / "tests" / "hostile"


class TestCases:
    def test_equal_numbers_and_seeds_give_equal_cases(self):
        files = cases.starting_points([])
        numbers = every(3, range(50))
        once = [cases.make_case(number, 7, files) for number in numbers]
        assert once == [cases.make_case(number, 7, files) for number in numbers]
        assert once != [cases.make_case(number, 8, files) for number in numbers]

    def test_no_mutation_needs_more_than_a_character(self):
        for mutation in line_mutations.MUTATIONS:
            for seed in range(20):
                assert isinstance(mutation(Random(seed), "a"), str)


class TestReaders:
    def test_byte_mutations_take_any_content(self):
        for mutation in byte_mutations.MUTATIONS:
            for seed in range(20):
                for content in (b"", b"\xff", b"a: 1\n- 2\n"):
                    assert isinstance(mutation(Random(seed), content, b"other\n"), bytes)

    @pytest.mark.parametrize("name", fuzz_readers.READERS)
    def test_what_is_mutated_is_read_unless_it_is_mutated(self, name, tmp_path, monkeypatch):
        monkeypatch.setenv("XDG_CONFIG_HOME", "")  # which a reader sets
        for files in every(6, seeds(name)):
            fuzz_readers.READERS[name](fuzz_readers.place(files, tmp_path / "case"))


class TestShrinking:
    def test_only_what_fails_is_left(self):
        parts = list("abcdefghijklmnopqrstuvwxyz")
        assert minimal(parts, {"c", "x"}.issubset) == ["c", "x"]

    def test_the_number_of_trials_is_near_linear(self):
        """A single failing part of n is found with about log2(n) passes over ever fewer parts."""

        def trials(size):
            count = 0

            def fails(parts):
                nonlocal count
                count += 1
                return size // 3 in parts

            assert minimal(list(range(size)), fails) == [size // 3]
            return count

        assert trials(2000) <= 2.5 * trials(1000)

    def test_a_case_shrinks_to_lines_and_then_to_attributes(self):
        case = Case("case.amxmi", b'<a>\n  <b name="x" wrong="1" type="y"/>\n  <c/>\n</a>\n')
        assert shrunk(case, lambda smaller: b"wrong" in smaller.content).content == b' wrong="1"'


class TestSandbox:
    def test_what_does_not_hold_is_reported_with_its_place(self, monkeypatch):
        def broken(path, folder):
            raise KeyError("surprise")

        monkeypatch.setattr(invariants, "_OF_MODELS", (broken,))
        ((_, (failure,)),) = sandbox.failures([Case("case.amxmi", b"")], 1)
        assert (failure.invariant, failure.message) == ("broken", "'surprise'")
        assert failure.reason.startswith("KeyError")

    def test_a_process_that_dies_is_a_failure(self, monkeypatch):
        def killed(path, folder):
            os.kill(os.getpid(), signal.SIGKILL)

        monkeypatch.setattr(invariants, "_OF_MODELS", (killed,))
        ((_, (failure,)),) = sandbox.failures([Case("case.amxmi", b"")], 1)
        assert failure.invariant == "killed"
        assert "ended by signal" in failure.reason

    def test_memory_is_limited(self, monkeypatch):
        def greedy(path, folder):
            bytearray(2**33)

        monkeypatch.setattr(invariants, "_OF_MODELS", (greedy,))
        ((_, (failure,)),) = sandbox.failures([Case("case.amxmi", b"")], 1)
        assert failure.reason.startswith("MemoryError")


class TestCommands:
    @pytest.mark.parametrize("text", ["\x1b[31mred", "a\u202eb", "::error::x", "  ::set-env::x", "##vso[task]", "a\rb"])
    def test_what_acts_on_a_terminal_or_runner_is_a_failure(self, text, monkeypatch):
        monkeypatch.setattr(commands, "main", lambda: sys.stdout.write(text))
        with pytest.raises(commands.InvariantError):
            commands.run("check")

    def test_standard_output_for_programs_is_raw(self, monkeypatch):
        monkeypatch.setattr(commands, "main", lambda: sys.stdout.write("\x1b[31mred"))
        assert commands.run("fmt", "--diff", is_raw=True).out == "\x1b[31mred"


class TestContradictions:
    """A system agrees with its own simulation; one whose jobs take longer than what was analysed does not."""

    TASKS = """
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: Writer, period: 10 ms, execution_time: 1 ms, writes: [a]}
  - {name: Reader, period: 10 ms, execution_time: 1 ms, reads: [a]}
chains:
  - {name: chain, path: [Writer, Reader]}
requirements:
  - {process: Writer, response_time: 3 ms}
"""

    def test_only_what_is_beyond_a_claim(self, tmp_path):
        short, long = tmp_path / "short.yaml", tmp_path / "long.yaml"
        short.write_text(self.TASKS)
        long.write_text(self.TASKS.replace("1 ms", "4 ms"))
        analysis = analyze_files(short).analysis
        assert list(contradictions(analysis, simulate(short, "50 ms"))) == []
        found = list(contradictions(analysis, simulate(long, "50 ms")))
        for name in ("response time 4000000000 of Writer", "max_reaction_time", " of Writer, is met"):
            assert any(name in text for text in found), found


@pytest.mark.parametrize("path", sorted(HOSTILE.iterdir()), ids=lambda path: path.name)
def test_no_hostile_file_breaks_a_command(path, tmp_path):
    for invariant in invariants.invariants_of(path):
        folder = tmp_path / invariant.__name__
        folder.mkdir()
        invariant(path, folder)
