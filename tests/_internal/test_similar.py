"""Suggestions for unknown names take limited time."""

from amalthea_uros._internal.similar import MAX_LENGTH, Suggestions, did_you_mean, similar


def test_the_most_similar_names_come_first():
    assert similar("Task_5ms", ["Task_50ms", "Task_5ms_", "Other"], count=2) == ["Task_5ms_", "Task_50ms"]


def test_long_names_are_not_compared():
    # One comparison of such names takes minutes.
    name = "ab" * 100_000
    assert similar(name, [name[1:]]) == similar("ab", [name]) == []
    assert similar("a" * MAX_LENGTH, ["a" * MAX_LENGTH])


def test_the_last_of_many_names_get_no_suggestion():
    suggestions = Suggestions(comparisons=10)
    found = [suggestions.nearest("Tusk", ["Task", "Label", "Runnable"]) for _ in range(5)]
    assert found == ["Task", "Task", "Task", "", ""]
    assert suggestions.advice("Tusk", ["Task"]) == ""


def test_a_name_with_a_further_part_may_be_meant():
    assert did_you_mean("Imu", ["Executor", "Imu_Callback"]) == "did you mean 'Imu_Callback'?"
    assert did_you_mean("Imu", ["Executor", "Imus_of_all_wheels"]) == ""
