"""Tables with a column for each quantity, and what tools on the host print: values by hand, and what is wrong with them."""

import pytest

from amalthea_uros import InvalidArgumentError, ReadError, measure
from amalthea_uros.compare.measured.columns import TableColumn, parse_column, unit_of
from amalthea_uros.compare.measured.tables import measured_table
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.units import MICROSECOND, MILLISECOND, SECOND


def table(tmp_path, text, *columns, name="rtt.csv", **options):
    path = tmp_path / name
    path.write_text(text)
    return measure(path, columns=columns or ["rtt_ms=round-trip"], **options)


def only(found):
    (series,) = found.series
    return series


def test_each_row_is_a_value_in_the_unit_of_the_header(tmp_path):
    series = only(table(tmp_path, "cycle,rtt_ms\n1,4.5\n2,4.75\n3,5\n"))
    assert series.values.tolist() == [4_500_000_000, 4_750_000_000, 5_000_000_000]
    assert (series.name, series.quantity, series.counts.lost) == ("round-trip", "time", 0)
    assert only(table(tmp_path, "rtt\n4500\n", "rtt=round-trip", unit="us")).statistics.max == 4500 * MICROSECOND


@pytest.mark.parametrize(
    ("header", "unit"),
    [("rtt_ms", MILLISECOND), ("rtt (us)", MICROSECOND), ("rtt [s]", SECOND), ("rtt", None), ("atoms", None)],
)
def test_a_header_may_end_in_a_unit(header, unit):
    assert unit_of(header) == unit


def test_rows_that_failed_are_lost_and_counted_with_their_first_line(tmp_path):
    text = "cycle,status,rtt_ms\n1,ok,4\n2,timeout,\n3,ok,nan\n4,timeout,9000\n5,ok,6\n"
    found = table(tmp_path, text)
    assert only(found).values.tolist() == [4 * MILLISECOND, 6 * MILLISECOND]
    assert only(found).counts.lost == 3
    assert [(each.rule, each.location.line) for each in found.findings] == [("MEA015", 3), ("MEA015", 4)]
    assert "2 times" in found.findings[0].message
    assert only(table(tmp_path, text, valid_rows="status=ok,timeout")).counts.lost == 2


def test_a_quantity_can_be_the_difference_of_two_time_stamps_since_1970(tmp_path):
    rows = ("1700000000000000001,1700000000004000002", "1700000001000000000,", "1700000002000000000,1700000002005000000")
    text = "\n".join(("sent_ns,received_ns", *rows))
    found = table(tmp_path, text, "received_ns - sent_ns=round-trip.reduced_data_age")
    assert only(found).values.tolist() == [4_000_001_000, 5_000_000_000]
    assert (only(found).quantity, only(found).counts.lost) == ("reduced_data_age", 1)


@pytest.mark.parametrize(
    ("text", "columns", "said"),
    [
        ("cycle,rtt_ms\n", ["rtt=a"], "no column 'rtt'"),
        ("cycle,rtt\n1,2\n", ["rtt=a"], "names no unit"),
        ("", ["rtt_ms=a"], "its header is empty"),
        ("rtt_ms,rtt_ms\n4,400\n", ["rtt_ms=a"], "2 columns 'rtt_ms'"),
        ("status,status,rtt_ms\nok,lost,4\n", ["rtt_ms=a"], "2 columns 'status'"),
    ],
)
def test_a_table_without_the_column_or_its_unit_is_refused_at_its_header(tmp_path, text, columns, said):
    with pytest.raises(ReadError, match=said) as error:
        table(tmp_path, text, *columns)
    assert [(each.rule, each.location.line) for each in error.value.findings] == [("MEA016", 1)]


def test_what_is_no_number_is_told_with_its_line(tmp_path):
    found = table(tmp_path, 'rtt_ms\n4\nfast\n-1\n1e40\n"5\n')
    assert only(found).values.tolist() == [4 * MILLISECOND]
    assert only(found).counts.lost == 4
    assert [(each.rule, each.location.line) for each in found.findings[:3]] == [("MEA009", 3), ("MEA009", 4), ("MEA009", 6)]


@pytest.mark.parametrize("text", ["1e999999", "1e400", "1e999999999", "sNaN", "-NaN", "+inf", "9" * 5000, "1e-999999999999"])
def test_no_number_is_too_strange_to_be_lost_or_read(tmp_path, text):
    series = only(table(tmp_path, f"rtt_ms\n4\n{text}\n6\n"))
    assert series.counts.lost + len(series.values) == 3
    assert series.statistics.max == 6 * MILLISECOND


@pytest.mark.parametrize("text", ["nan", "inf", "1e999999", "", "x"])
def test_a_row_without_its_time_is_lost(tmp_path, text):
    found = table(tmp_path, f"time_s,rtt_ms\n1,4\n{text},400\n3,6\n")
    assert (only(found).values.tolist(), only(found).counts.lost) == ([4 * MILLISECOND, 6 * MILLISECOND], 1)
    assert found.duration == 2 * SECOND
    assert [(each.rule, each.location.line) for each in found.findings] == [("MEA009", 3), ("MEA006", None)]
    first = table(tmp_path, f"time_s,rtt_ms\n{text},400\n1,4\n3,6\n")
    assert (len(only(first).values), only(first).counts.lost, first.duration) == (2, 1, 2 * SECOND)


def test_rows_that_are_not_in_the_order_of_their_times_are_measured(tmp_path):
    assert only(table(tmp_path, "time_s,rtt_ms\n5,4\n1,400\n9,6\n")).statistics.max == 400 * MILLISECOND
    replies = only(table(tmp_path, "sent_ms,got_ms\n0,50\n1,9\n", "got_ms - sent_ms=round-trip"))
    assert replies.values.tolist() == [50 * MILLISECOND, 8 * MILLISECOND]
    part = table(tmp_path, "time_s,rtt_ms\n1,4\n5,400\n9,6\n", window=("2 s", "6 s"))
    assert only(part).values.tolist() == [400 * MILLISECOND]


@pytest.mark.parametrize("text", ["rtt_ms\n4,5\n6\n", "n,rtt_ms\n1,4,5\n2,6\n", "n;rtt_ms\n1;4,5\n2;6\n"])
def test_a_decimal_comma_is_no_separator(tmp_path, text):
    found = table(tmp_path, text)
    assert (only(found).values.tolist(), only(found).counts.lost) == ([6 * MILLISECOND], 1)
    assert (found.findings[0].rule, found.findings[0].location.line) == ("MEA009", 2)


def test_a_part_of_what_has_no_times_is_refused(tmp_path):
    report = "average delay: 0.005\n\tmin: 0.003s max: 0.006s std dev: 0.00100s window: 10\n"
    (tmp_path / "delay.txt").write_text(report)
    (tmp_path / "plain.csv").write_text("object,value_us\na,1\n")
    for name in ("delay.txt", "plain.csv"):
        with pytest.raises(InvalidArgumentError, match="does not say when"):
            measure(tmp_path / name, window=("1 s", None))
    with pytest.raises(InvalidArgumentError, match="does not say when"):
        table(tmp_path, "rtt_ms\n4\n", window=("1 s", None))


def test_reports_before_a_line_without_an_end_are_used(tmp_path):
    report = "average delay: 0.005\n\tmin: 0.003s max: 0.006s std dev: 0.00100s window: 10\n"
    (tmp_path / "delay.txt").write_text(report + 100_000 * "7")
    found = measure(tmp_path / "delay.txt")
    assert (only(found).statistics.max, [each.rule for each in found.findings]) == (6 * MILLISECOND, ["TRC002", "MEA007"])


def test_a_line_without_an_end_leaves_nothing_measured(tmp_path):
    found = table(tmp_path, "7" * 100_000)
    assert (found.series, [each.rule for each in found.findings]) == ((), ["TRC002", "MEA005"])


def test_a_table_without_rows_measures_nothing(tmp_path):
    found = table(tmp_path, "status,rtt_ms\nlost,\n")
    assert only(found).statistics is None
    assert [each.rule for each in found.findings] == ["MEA015", "MEA005"]


def test_two_columns_are_not_the_same_quantity(tmp_path):
    with pytest.raises(InvalidArgumentError, match="two columns"):
        table(tmp_path, "a_ms,b_ms\n1,2\n", "a_ms=x", "b_ms=x")
    with pytest.raises(InvalidArgumentError, match="add --column"):
        measure(tmp_path / "rtt.csv", unit="ms")


@pytest.mark.parametrize("text", ["rtt_ms", "=round-trip", "rtt_ms=", "a - b - c=x"])
def test_a_column_has_a_form(text):
    with pytest.raises(ValueError, match="not of the form"):
        parse_column(text)


def test_a_unit_that_contradicts_the_header_is_refused(tmp_path):
    with pytest.raises(ReadError, match="'rtt_ms' names another unit"):
        table(tmp_path, "rtt_ms\n4\n", unit="us")
    assert only(table(tmp_path, "rtt_ms\n4\n", unit="ms")).statistics.max == 4 * MILLISECOND
    both = table(tmp_path, "rtt_ms,plain\n4,5\n", "rtt_ms=a", "plain=b", unit="us")
    assert [each.statistics.max for each in both.series] == [4 * MILLISECOND, 5 * MICROSECOND]


def test_messages_that_the_tool_reports_as_lost_are_lost(tmp_path):
    lost = "A message was lost!!!\n\ttotal count change:{}\n\ttotal count: 9---\n"
    text = lost.format(2) + "data: 4\n---\n" + lost.format(1) + "data: 5\n---\n"
    found = table(tmp_path, text, "data=rtt", name="echo.txt", unit="ms")
    assert (only(found).values.tolist(), only(found).counts.lost) == ([4 * MILLISECOND, 5 * MILLISECOND], 3)
    assert [(each.rule, each.location.line) for each in found.findings] == [("MEA015", 2)]
    assert only(table(tmp_path, text + lost.format(1), "data=rtt", name="echo.txt", unit="ms")).counts.lost == 4


def test_of_a_document_that_is_cut_off_or_names_a_field_twice_there_is_no_value(tmp_path):
    found = table(tmp_path, "data: 4\n---\ndata: 4\ndata: 400\n---\ndata: 9", "data=rtt", name="echo.txt", unit="ms")
    assert (only(found).values.tolist(), only(found).counts.lost) == ([4 * MILLISECOND], 2)
    assert {each.rule for each in found.findings} == {"MEA015", "MEA009"}


def test_documents_of_a_topic_are_rows_with_the_moments_of_their_stamps(tmp_path):
    text = "".join(
        f"header:\n  stamp:\n    sec: {second}\n    nanosec: {nanoseconds}\nsent:\n  sec: {second}\n  nanosec: 0\ndata: {value}\n---\n"
        for second, nanoseconds, value in ((1_700_000_000, 5_000_000, 4.5), (1_700_000_001, 7_000_000, 4.75))
    )
    found = table(tmp_path, text, "header.stamp_s - sent_s=age", "data=rtt", name="echo.txt", unit="ms")
    assert [each.values.tolist() for each in found.series] == [
        [5 * MILLISECOND, 7 * MILLISECOND],
        [4_500_000_000, 4_750_000_000],
    ]
    assert found.duration == SECOND + 2 * MILLISECOND


def test_reports_of_a_topic_have_the_extremes_of_all_and_the_mean_of_the_last(tmp_path):
    path = tmp_path / "delay.txt"
    report = "average delay: {}\n\tmin: {}s max: {}s std dev: 0.00100s window: {}\n"
    path.write_text(report.format("0.005", "0.003", "0.006", 10) + report.format("0.006", "0.004", "0.009", 20))
    series = only(measure(path, name="age"))
    statistics = series.statistics
    assert (series.name, series.quantity) == ("age", "duration")
    assert (statistics.count, statistics.min, statistics.max) == (20, 3 * MILLISECOND, 9 * MILLISECOND)
    assert statistics.mean == 6 * MILLISECOND
    path.write_text("average rate: 8.000\n\tmin: 0.124s max: 0.126s std dev: 0.00046s window: 11\n")
    assert only(measure(path)).statistics.mean == 125 * MILLISECOND
    assert only(measure(path)).quantity == "start_to_start"
    path.write_text(report.format("0.005", "0.003", "0.006", 10) + report.format("1e99999999", "0.004", "1e99999999", 20))
    assert only(measure(path)).statistics.max == 6 * MILLISECOND


@pytest.mark.parametrize("text", ["nan", "inf", "1e400", "1e999999", "1e99999999", '"5', "4,5", "fast"])
def test_a_value_that_is_no_time_is_an_error_at_its_line(tmp_path, text):
    path = tmp_path / "values.csv"
    path.write_text(f"object,value_us\na,4\na,{text}\na,6\n")
    found = measure(path)
    assert only(found).values.tolist() == [4 * MICROSECOND, 6 * MICROSECOND]
    assert [(each.rule, each.location.line) for each in found.findings] == [("MEA009", 3)]


def test_two_columns_with_values_are_refused(tmp_path):
    path = tmp_path / "values.csv"
    path.write_text("object,value_us,value_ms\na,4000,400\n")
    with pytest.raises(ReadError, match="2 columns with 'value'"):
        measure(path)


class CountedName(str):
    """A name that counts how often it is compared with another one."""

    __slots__ = ()
    comparisons = 0
    __hash__ = str.__hash__

    def __eq__(self, other):
        CountedName.comparisons += 1
        return str.__eq__(self, other)


def test_each_column_is_compared_with_few_others(tmp_path):
    names = [f"c{number}" for number in range(100)]
    path = tmp_path / "wide.csv"
    path.write_text(f"{','.join(names)}\n{','.join('1' for _ in names)}\n")
    columns = [TableColumn(CountedName(name), None, CountedName(name)) for name in names]
    found = measured_table(path, columns, None, MILLISECOND, MeasurementWindow())
    assert [series.name for series in found.series] == names
    assert CountedName.comparisons < 10 * len(names)
