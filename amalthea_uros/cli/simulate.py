"""`amuros simulate`: what the system does in time, observed in one run or many."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from amalthea_uros._internal.plural import counted
from amalthea_uros.cli.ends import INTERRUPTED
from amalthea_uros.cli.options import (
    bus_option,
    duration_option,
    metrics_option,
    paths_argument,
    seed_option,
    set_option,
    settings_options,
    sweep_option,
    table_option,
    workers_options,
)
from amalthea_uros.cli.output import Output, checked_outputs, output_option, show_result, write_runs
from amalthea_uros.cli.parameters import OUTPUT_FILE, PICTURE, Parsed, assignment, picture_path
from amalthea_uros.cli.patience import working
from amalthea_uros.cli.pictures import Pictures
from amalthea_uros.design.campaign.run import count_runs
from amalthea_uros.design.campaign.simulations import CampaignResult
from amalthea_uros.design.campaign.tables import table_format, write_table
from amalthea_uros.design.changes.change import Change, Sweep
from amalthea_uros.services.changed import open_changed
from amalthea_uros.services.simulate import SimulationResult, simulate_campaign, simulate_changed
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Duration, Time, parse_time, time_text


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
@paths_argument
@duration_option("Model time of a run, e.g. 5min.", default="1 s")
@seed_option("Seed of all random values.")
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
@bus_option("simulate")
@metrics_option
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
@click.option("--gantt", type=PICTURE, metavar="FILE", help="Draw what all processes do in a part of the run, as SVG.")
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
    type=assignment("PROCESS=FILE", picture_path),
    help="Draw the states of a process in a part of the run, as SVG; may be repeated.",
)
@click.option(
    "--histogram",
    "histograms",
    multiple=True,
    type=assignment("NAME=FILE", picture_path),
    help="Draw the response times of a process, the latencies of a chain, or another of its quantities, e.g. "
    "Task.net_execution_time=net.svg; may be repeated.",
)
@click.option(
    "--window",
    type=Parsed("FROM..TO", _window),
    help="Part of the run for --gantt and --timeline; default: around the job that comes closest to its deadline.",
)
@sweep_option("Simulate")
@click.option(
    "--runs",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Number of runs of each variant, with the seeds from --seed on.",
)
@workers_options("runs")
@table_option("Write a row for each run to a .csv, .json or .parquet file.")
@output_option("CampaignResult")
def simulate(
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
    table: Path | None,
    outputs: tuple[Output, ...],
    **where: Any,
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
    if where["cluster"] is not None and not is_campaign:
        raise click.UsageError("--cluster executes the runs of --sweep or --runs; add one of them")
    if trace_window is not None and not traces:
        raise click.UsageError("--trace-window needs --trace FILE")
    streamed = [("--trace", path) for path in traces]
    outputs = checked_outputs(outputs, [*pictures.files, ("--table", table)], streamed)
    if table is not None:
        table_format(table)
    window = trace_window or (0, duration)
    traced = (Duration(window[0]), Duration(window[1])) if traces else None
    options = Options(
        duration=Duration(duration), seed=seed, mode=SimulationMode(mode), settings=settings, traced=traced, labels=labels
    )
    if is_campaign:
        with working("Simulating", count_runs(sweeps, runs)) as progress:
            campaign = simulate_campaign(
                paths,
                options,
                changes=changes,
                sweeps=sweeps,
                repetitions=runs,
                with_bus=with_bus,
                on_outcome=progress.step,
                **where,
            )
        sys.exit(_show_campaign(campaign, table, outputs))
    if trace_window is not None and trace_window[0] >= duration:
        start, end = time_text(trace_window[0]), time_text(duration)
        raise click.UsageError(f"the window of the trace starts at {start}, but the run ends at {end}")
    changed = open_changed(paths, settings, changes, with_bus=with_bus)
    pictures.check(changed.system, options)
    try:
        with working(f"Simulating {time_text(duration)}"):
            result = simulate_changed(changed, options, traces, with_metrics=with_metrics)
        _show(result, table, outputs)
        with working("Drawing"):
            pictures.write(result)
    except KeyboardInterrupt:
        click.echo("interrupted: the run is not finished; traces of unfinished runs are not kept", err=True)
        sys.exit(INTERRUPTED)
    sys.exit(1 if result.is_failed else 0)


def _show(result: SimulationResult, table: Path | None, outputs: Sequence[Output]) -> None:
    from amalthea_uros.report.documents.simulation import closing_line

    if table is not None:
        write_table(table, [result.simulation.record()])
    show_result(result, outputs, closing=closing_line(result.simulation) if result.is_failed else "")


def _show_campaign(result: CampaignResult, table: Path | None, outputs: Sequence[Output]) -> int:
    """Show and write the runs; the exit code."""
    from amalthea_uros.report.documents.simulation import campaign_line

    write_runs(table, result)
    show_result(result, outputs, closing=campaign_line(result) if result.is_failed else "", is_complete=result.is_complete)
    if result.is_complete:
        return 1 if result.is_failed else 0
    click.echo(f"interrupted: {len(result.outcomes):,} of {counted(result.planned, 'run')} finished", err=True)
    return INTERRUPTED
