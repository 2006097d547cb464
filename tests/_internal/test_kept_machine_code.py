"""What numba keeps of machine code is used as what it was made from, whatever becomes of the files and whoever else uses them."""

import os
import tempfile
from contextlib import suppress

import pytest

from amalthea_uros._internal.compiled import machine_code

numba = pytest.importorskip("numba")


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def source(tmp_path):
    path = tmp_path / "halves.py"
    path.write_text("def half(number):\n    return number // 2\n")
    return path


def loaded(source, argument=numba.int64):
    """The function of a source as machine code, as a new process has it, and whether that was kept by an earlier one."""
    namespace = {"__name__": __name__}
    exec(compile(source.read_text(), str(source), "exec"), namespace)
    found = machine_code(namespace["half"], (argument,), [source])
    return found(9), found.stats.cache_hits[(argument,)] == 1


NEW, KEPT = (4, False), (4, True)


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("size", [0, 100])
def test_damaged_machine_code_is_made_again(suffix, size, source, cache):
    assert [loaded(source), loaded(source)] == [NEW, KEPT]
    (damaged,) = cache.glob(f"*/*{suffix}")
    os.truncate(damaged, size)
    assert [loaded(source), loaded(source), loaded(source)] == [NEW, NEW, KEPT]


def test_machine_code_of_other_types_is_no_answer(source, cache):
    """Two processes that keep it for different types at the same time can leave that of one under the types of the other."""
    loaded(source), loaded(source, numba.float64)
    one, other = sorted(cache.glob("*/*.nbc"))
    one.write_bytes(other.read_bytes())
    assert [loaded(source), loaded(source), loaded(source)] == [NEW, NEW, KEPT]


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), OSError(30, "Read-only file system")])
def test_machine_code_that_cannot_be_kept_is_used(error, source, monkeypatch):
    def refuse(*_arguments, **_more):
        raise error

    monkeypatch.setattr(*((os, "replace") if error.errno == 28 else (tempfile, "TemporaryFile")), refuse)
    assert [loaded(source), loaded(source)] == [NEW, NEW]


class Killed(BaseException):
    """The process ends here."""


@pytest.fixture
def at_step(monkeypatch):
    """Have something happen before a file with the given number appears."""
    appear = os.replace

    def set_action(number, action):
        left = [number]

        def replace(*paths):
            left[0] -= 1
            if left[0] == 0:
                action()
            appear(*paths)

        monkeypatch.setattr(os, "replace", replace)

    return set_action


@pytest.mark.parametrize("step", [1, 2])
def test_another_process_may_make_and_read_it_at_any_moment(step, source, at_step):
    seen = []
    at_step(step, lambda: seen.append(loaded(source)))
    assert [loaded(source), *seen] == [NEW, NEW]
    assert loaded(source) == KEPT


@pytest.mark.parametrize("step", [1, 2])
def test_no_process_executes_what_was_made_from_another_version_of_the_source(step, source, at_step):
    """One reads while the new machine code is kept, and one reads after the process that kept it was killed."""
    loaded(source)
    source.write_text("def half(number):\n    return number - 2\n")
    seen = []

    def read_and_end():
        seen.append(loaded(source))
        raise Killed

    at_step(step, read_and_end)
    with suppress(Killed):
        loaded(source)
    assert [*seen, loaded(source)] in ([(7, False), (7, False)], [(7, False), (7, True)])
