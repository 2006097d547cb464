"""`amuros simulate`: what the system does in time, observed in one run or many."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import click

from amalthea_uros._internal.plural import counted
from amalthea_uros.cli.ends import INTERRUPTED
from amalthea_uros.cli.files import INPUT, OUTPUT_FILE, output_path
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    output_option,
    refuse_input,
    refuse_unwritable,
    show_differences,
    show_findings,
    show_line,
    shows_text,
    write_outputs,
)
from amalthea_uros.cli.parsed import Parsed
from amalthea_uros.cli.pictures import Pictures
from amalthea_uros.cli.settings_options import AssignmentType, set_option, settings_options
from amalthea_uros.cli.workers_options import workers_options
from amalthea_uros.design.campaign.run import RunOutcome, count_runs
from amalthea_uros.design.campaign.tables import table_format, write_table
from amalthea_uros.design.changes.change import SWEEP_EXAMPLE, Change, Sweep, parse_sweep
from amalthea_uros.services.simulate import CampaignResult, SimulationResult, plan_simulation, simulate_campaign, simulate_plan
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time, parse_duration, parse_time, time_text


def _window(text: str) -> tuple[Time, Time]:
    start, separator, end = text.partition("..")
    if not separator:
        raise ValueError(f"{text!r} is not of the form FROM..TO; an example: 10ms..20ms")
    times = parse_time(start), parse_time(end)
    if not 0 <= times[0] < times[1]:
        raise ValueError(f"{text!r} is not a range of times from 0 on")
    return times


def _labels(text: str) -> tuple[str, ...]:
    return tuple(filter(None, map(str.strip, text.split(","))))


@click.command("simulate")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@click.option(
    "--duration",
    type=Parsed("TIME", parse_duration),
    default="1 s",
    show_default=True,
    help="Model time of a run, e.g. 5min.",
)
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of all random values.")
@click.option(
    "--mode",
    type=click.Choice([str(mode) for mode in SimulationMode]),
    default=str(SimulationMode.SAMPLED),
    show_default=True,
    help="How values that vary are chosen: at random, or always the longest demand and shortest distance (worst), the contrary "
    "(best), or the means (average).",
)
@set_option
@settings_options
@click.option("--bus", "with_bus", is_flag=True, help="Also simulate the messages on the CAN bus of an app.yaml.")
@click.option("--metrics", "with_metrics", is_flag=True, help="Show minimum, mean and maximum of all metrics of each process.")
@click.option(
    "--labels",
    type=Parsed("all|NAME,...", _labels),
    default="",
    help="Show how often these labels are read and written, and how old the values are that are read, e.g. speed,torque or all.",
)
@click.option(
    "--trace",
    "traces",
    multiple=True,
    type=OUTPUT_FILE,
    metavar="FILE",
    help="Write the events to a file, of which the suffix says the format, e.g. run.btf; may be repeated.",
)
@click.option(
    "--trace-window", type=Parsed("FROM..TO", _window), help="Write only the events of this part of the run, e.g. 10ms..20ms."
)
@click.option("--gantt", type=OUTPUT_FILE, metavar="FILE", help="Draw what all processes do in a part of the run, as SVG.")
@click.option("--gantt-of", metavar="PROCESS", help="Show the longest response time of this process in --gantt.")
@click.option(
    "--chain",
    metavar="NAME",
    help="Show the longest reduced reaction time of this chain in --gantt, with its way through the jobs.",
)
@click.option(
    "--timeline",
    "timelines",
    multiple=True,
    type=AssignmentType("PROCESS=FILE", output_path),
    help="Draw the states of a process in a part of the run, as SVG; may be repeated.",
)
@click.option(
    "--histogram",
    "histograms",
    multiple=True,
    type=AssignmentType("NAME=FILE", output_path),
    help="Draw the response times of a process, the latencies of a chain, or another of its quantities, e.g. "
    "Task.net_execution_time=net.svg; may be repeated.",
)
@click.option(
    "--window",
    type=Parsed("FROM..TO", _window),
    help="Part of the run for --gantt and --timeline; default: around the job that comes closest to its deadline.",
)
@click.option(
    "--sweep",
    "sweeps",
    multiple=True,
    type=Parsed("OBJECT.KEY=VALUES", parse_sweep),
    help=f"Simulate with each of several values, a range or a list, e.g. {SWEEP_EXAMPLE}; if repeated, with all combinations.",
)
@click.option(
    "--runs",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Number of runs of each variant, with the seeds from --seed on.",
)
@workers_options("runs")
@click.option("--table", type=OUTPUT_FILE, metavar="FILE", help="Write a row for each run to a .csv, .json or .parquet file.")
@output_option(CampaignResult)
def command(
    paths: tuple[Path, ...],
    duration: Time,
    seed: int,
    mode: str,
    changes: tuple[Change, ...],
    settings: Settings,
    with_bus: bool,
    with_metrics: bool,
    labels: tuple[str, ...],
    traces: tuple[Path, ...],
    trace_window: tuple[Time, Time] | None,
    gantt: Path | None,
    gantt_of: str | None,
    chain: str | None,
    timelines: tuple[tuple[str, Path], ...],
    histograms: tuple[tuple[str, Path], ...],
    window: tuple[Time, Time] | None,
    sweeps: tuple[Sweep, ...],
    runs: int,
    workers: int | None,
    cluster: str | None,
    table: Path | None,
    outputs: tuple[Output, ...],
) -> None:
    """Simulate the system, and show what was observed: response times, loads, latencies, and missed limits.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. Runs with the same seed are equal. What was
    observed is no bound: see `amuros analyze` for those. The exit code is 1 if a limit is missed, an activation is lost, something
    is not simulated, or a run fails; with Ctrl-C, the runs of a campaign that are finished are shown, and the exit code is 130.
    """
    is_campaign = bool(sweeps) or runs > 1
    pictures = Pictures(gantt, timelines, histograms, window, gantt_of, chain)
    if is_campaign and (traces or pictures.paths):
        raise click.UsageError("traces and pictures are made of a single run, without --sweep and --runs")
    if is_campaign and with_metrics:
        raise click.UsageError(
            "--metrics shows a single run, without --sweep and --runs; --table FILE has the metrics of all runs"
        )
    if cluster is not None and not is_campaign:
        raise click.UsageError("--cluster executes the runs of --sweep or --runs; add one of them")
    if trace_window is not None and not traces:
        raise click.UsageError("--trace-window needs --trace FILE")
    outputs = beside_files(outputs, [*(("--trace", path) for path in traces), *pictures.files, ("--table", table)])
    _check_targets(traces, [*pictures.paths, *(path for _, path in outputs)], table)
    traced = (trace_window or (0, duration)) if traces else None
    options = Options(duration=duration, seed=seed, mode=SimulationMode(mode), settings=settings, traced=traced, labels=labels)
    if is_campaign:
        campaign = _campaign(paths, options, changes, sweeps, runs, with_bus, workers, cluster)
        _show_campaign(campaign, table, outputs)
        sys.exit(_campaign_code(campaign))
    if trace_window is not None and trace_window[0] >= duration:
        start, end = time_text(trace_window[0]), time_text(duration)
        raise click.UsageError(f"the window of the trace starts at {start}, but the run ends at {end}")
    plan = plan_simulation(paths, options, changes, with_bus=with_bus)
    pictures.check(plan)
    try:
        result = simulate_plan(plan, traces, with_metrics=with_metrics)
        _show(result, table, outputs)
        pictures.write(result)
    except KeyboardInterrupt:
        click.echo("interrupted: the run is not finished; traces of unfinished runs are not kept", err=True)
        sys.exit(INTERRUPTED)
    sys.exit(1 if result.is_failed else 0)


def _check_targets(traces: Sequence[Path], results: Sequence[Path], table: Path | None) -> None:
    """Refuse files that cannot be written before the simulation, which may take long."""
    late = [*results, *([table] if table is not None else [])]
    for path, number in Counter([*traces, *late]).items():
        if number > 1:
            raise click.UsageError(f"{path} is the file of {number} options; give each its own")
        refuse_input(path, str(path))
    for path in late:
        refuse_unwritable(path)
    if table is not None:
        table_format(table)


def _show(result: SimulationResult, table: Path | None, outputs: Sequence[Output]) -> None:
    from amalthea_uros.report.documents.simulation import closing_line

    show_findings(result.findings)
    show_differences(result.differences)
    if table is not None:
        write_table(table, [result.simulation.record()])
    write_outputs(outputs, result)
    if result.is_failed and not shows_text(outputs):
        show_line(closing_line(result.simulation))


def _campaign(
    paths: Sequence[Path],
    options: Options,
    changes: Sequence[Change],
    sweeps: Sequence[Sweep],
    runs: int,
    with_bus: bool,
    workers: int | None,
    cluster: str | None,
) -> CampaignResult:
    """Execute a campaign, with a progress bar on a terminal."""
    is_hidden = not sys.stderr.isatty()
    with click.progressbar(length=count_runs(sweeps, runs), label="Simulating", file=sys.stderr, hidden=is_hidden) as bar:

        def advance(_outcome: RunOutcome) -> None:
            bar.update(1)

        return simulate_campaign(
            paths,
            options,
            changes=changes,
            sweeps=sweeps,
            repetitions=runs,
            with_bus=with_bus,
            workers=workers,
            cluster=cluster,
            on_outcome=advance,
        )


def _show_campaign(result: CampaignResult, table: Path | None, outputs: Sequence[Output]) -> None:
    from amalthea_uros.report.documents.simulation import campaign_line

    show_findings(result.findings)
    show_differences(result.differences)
    if table is not None:
        write_table(table, result.rows)
    write_outputs(outputs, result)
    if result.is_failed and not shows_text(outputs):
        show_line(campaign_line(result))
    if not result.is_complete:
        click.echo(f"interrupted: {len(result.outcomes):,} of {counted(result.planned, 'run')} finished", err=True)


def _campaign_code(result: CampaignResult) -> int:
    if not result.is_complete:
        return INTERRUPTED
    return 1 if result.is_failed else 0
