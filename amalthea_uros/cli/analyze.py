"""`amuros analyze` and `amuros chains`: response times, loads, latencies and verdicts; paths and their latencies."""

from __future__ import annotations

import shlex
import sys
from dataclasses import replace
from pathlib import Path

import click

from amalthea_uros._internal.files import is_standard_output
from amalthea_uros._internal.paths import is_description
from amalthea_uros.analyze.results.chains import EXPLAINED, LatencyQuantity
from amalthea_uros.cli.options import FAILING, analysis_options, fail_on_option, metrics_option, paths_argument, set_option
from amalthea_uros.cli.output import Output, beside_files, output_option, refuse_input, show_findings, show_result, show_text
from amalthea_uros.cli.parameters import INPUT, MODEL_OR_DESCRIPTION
from amalthea_uros.cli.patience import working
from amalthea_uros.design.changes.change import EXAMPLE, Change
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.analyze import analyze_files, chain_detail
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import shortened


@click.command("analyze")
@paths_argument
@set_option
@click.option(
    "-o",
    "--out",
    "target",
    type=MODEL_OR_DESCRIPTION,
    metavar="FILE",
    help="With --set: write the changed model (.amxmi) or app.yaml; only the changed values differ from the given one.",
)
@analysis_options
@click.option("--chain", metavar="CHAIN", help="Show all values of one event chain, and the links between its events.")
@click.option(
    "--method",
    type=click.Choice(["auto", "all"]),
    default="auto",
    show_default=True,
    help="With --chain: show the tightest values (auto), or those of all methods.",
)
@click.option(
    "--explain",
    "explained",
    metavar="NAME",
    help="Show why a process, a callback or an event chain takes as long as it does, and what would shorten it.",
)
@click.option(
    "--quantity",
    type=click.Choice([str(quantity) for quantity in EXPLAINED]),
    default=str(LatencyQuantity.MAX_REDUCED_REACTION_TIME),
    show_default=True,
    help="With --explain of a chain: the latency.",
)
@click.option(
    "--sensitivity",
    "with_sensitivity",
    is_flag=True,
    help="Show by how much execution times can increase before a limit is missed.",
)
@fail_on_option
@click.option("--assign-priorities", "with_priorities", is_flag=True, help="Propose priorities that meet all deadlines.")
@metrics_option
@click.option(
    "--keys",
    "with_keys",
    is_flag=True,
    help="Only list the values that --set, --sweep and --offer can change, with their present values.",
)
@click.option(
    "--matching",
    metavar="TEXT",
    help="With --keys: only values whose names contain the text; of a model, these can be all attributes of its objects.",
)
@output_option("AnalysisResult")
def analyze(
    paths: tuple[Path, ...],
    changes: tuple[Change, ...],
    target: Path | None,
    settings: Settings,
    chain: str | None,
    method: str,
    explained: str | None,
    quantity: str,
    fail_on: str,
    with_keys: bool,
    matching: str | None,
    outputs: tuple[Output, ...],
    **wanted: bool,
) -> None:
    """Compute response times, loads, end-to-end latencies of event chains, and verdicts.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. Each number has a method and a claim
    (exact, or a safe bound), and the assumptions are listed. The last line says whether all deadlines, requirements and constraints
    are met; the exit code is 1 if one of them is missed, an activation is lost, or a core is overloaded. With --set the system is
    changed first, and a table compares the results before and after.
    """
    if with_keys or matching is not None:
        _list_keys(paths, matching or "")
        return
    if target is not None:
        if not changes:
            raise click.UsageError(f"-o writes a changed model; add a change, e.g. --set {EXAMPLE}")
        refuse_input(target, "-o")
    outputs = beside_files(outputs, [("-o", target)])
    is_whole = chain is None and explained is None
    result = analyze_files(paths, settings, changes=changes, all_methods=method == "all", with_missing=is_whole, **wanted)
    if explained is not None:
        from amalthea_uros.services.explain import explain

        with working("Explaining"):
            result = replace(result, explanation=explain(result, explained, LatencyQuantity(quantity)))
    elif is_whole:
        from amalthea_uros.services.first_answer import first_answer

        with working("Trying changes"):
            result = replace(result, answer=first_answer(result))
    as_text = result.explanation or (chain_detail(result, chain) if chain is not None else None)
    if target is not None:
        from amalthea_uros.services.changed_model import write_changed

        write_changed(paths, changes, settings, target)
    summary = result.analysis.summary
    show_result(result, outputs, as_text, "" if summary.schedulable is Schedulable.YES else closing_line(summary))
    sys.exit(1 if summary.schedulable in FAILING[fail_on] else 0)


def _list_keys(paths: tuple[Path, ...], matching: str) -> None:
    """Print values that can be changed; if there are none, say so, and of a model how to list more of them."""
    from amalthea_uros.services.keys import keys

    values = keys(paths, matching=matching)
    width, terminal = max((len(each.name) for each in values), default=0), Terminal(sys.stdout)
    room = 40 if terminal.width is None else max(10, terminal.width - width - len("  ..."))
    for each in values:
        terminal.line(f"{each.name:<{width}}  {shortened(each.value, room)}")
    if not values:
        Terminal(sys.stderr).line(f"no value has {matching!r} in its name")
    elif not matching and not is_description(paths[0]):
        name = values[0].name.rpartition(".")[0]
        Terminal(sys.stderr).line(f"all attributes of objects are keys, too; for example: --matching {shlex.quote(name)}")


@click.command("chains")
@click.argument("model", type=INPUT, metavar="MODEL_OR_YAML")
@click.option("--from", "start", required=True, metavar="NAME", help="Process, runnable or label where paths start.")
@click.option("--to", "end", required=True, metavar="NAME", help="Process, runnable or label where paths end.")
@click.option("--add", "name", metavar="CHAIN", help="Add a path to the model as an event chain with this name.")
@click.option("--path", "number", type=int, default=1, show_default=True, help="Number of the path to add.")
@click.option(
    "-o", "output", type=MODEL_OR_DESCRIPTION, metavar="FILE", help="File to which the model with the event chain is written."
)
def chains(model: Path, start: str, end: str, name: str | None, number: int, output: Path | None) -> None:
    """List the paths from one process, runnable or label to another, with their end-to-end latencies.

    Each process of a path writes a label or channel that the next one reads, or triggers it. With --add, one of the paths is added
    to the model as an event chain, and the model is written to another file. Exit code 1 if there is no path.
    """
    from amalthea_uros.services.chains import add_path, chosen_path, find_paths

    if (name is None) != (output is None):
        raise click.UsageError("--add CHAIN and -o FILE must be given together")
    result = find_paths(model, start, end)
    show_findings(result.findings)
    if not result.paths:
        show_text(result)
        sys.exit(1)
    chosen_path(result, number)
    is_piped = output is not None and is_standard_output(output)
    show_text(result, on_error_stream=is_piped)
    if name is not None and output is not None:
        add_path(result, number, name, output)
        Terminal(sys.stderr if is_piped else sys.stdout).line(f"path {number} is now the chain {name} in {output}")
