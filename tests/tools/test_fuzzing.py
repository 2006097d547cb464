"""The fuzzer: equal seeds give equal cases, failures are found and shrunk, and no hostile file breaks a command."""

import os
import signal
from random import Random

import pytest
from fuzzing import cases, invariants, line_mutations, sandbox
from fuzzing.cases import Case
from fuzzing.shrinking import minimal, shrunk
from support import ROOT

HOSTILE = ROOT / "tests" / "hostile"


class TestCases:
    def test_equal_numbers_and_seeds_give_equal_cases(self):
        files = cases.starting_points([])
        numbers = range(50)
        once = [cases.make_case(number, 7, files) for number in numbers]
        assert once == [cases.make_case(number, 7, files) for number in numbers]
        assert once != [cases.make_case(number, 8, files) for number in numbers]

    def test_no_mutation_needs_more_than_a_character(self):
        for mutation in line_mutations.MUTATIONS:
            for seed in range(20):
                assert isinstance(mutation(Random(seed), "a"), str)


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


@pytest.mark.parametrize("path", sorted(HOSTILE.iterdir()), ids=lambda path: path.name)
def test_no_hostile_file_breaks_a_command(path, tmp_path):
    for invariant in invariants.invariants_of(path):
        folder = tmp_path / invariant.__name__
        folder.mkdir()
        invariant(path, folder)
