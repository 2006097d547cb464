"""`amuros optimize`: changes with which all limits are met, each proved by the analysis."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from amalthea_uros._internal.file_writing import result_path
from amalthea_uros.cli.ends import INTERRUPTED
from amalthea_uros.cli.key_completion import OfKey
from amalthea_uros.cli.options import paths_argument, seed_option, settings_options, workers_options
from amalthea_uros.cli.output import Output, checked_outputs, output_option, refuse_input, show_line, show_result
from amalthea_uros.cli.parameters import MODEL_OR_DESCRIPTION, PICTURE, POSITIVE, Parsed
from amalthea_uros.cli.patience import working
from amalthea_uros.design.changes.change import SWEEP_EXAMPLE, parse_sweep
from amalthea_uros.design.optimize.choices import DEFAULT, Vary
from amalthea_uros.design.optimize.goals import GOALS
from amalthea_uros.design.optimize.judged import INTERRUPTED as ENDED_BY_USER
from amalthea_uros.design.optimize.quantities import LIMIT_EXAMPLE, LIMIT_FORM, parse_limit
from amalthea_uros.report.documents.search import is_met, optimization_line
from amalthea_uros.services import optimize as service
from amalthea_uros.services.changed_model import write_proposal
from amalthea_uros.services.files import save_text
from amalthea_uros.services.optimize import MOST_DESIGNS, MOST_PROPOSALS


def _vary(text: str) -> tuple[Vary, ...]:
    found = tuple(filter(None, map(str.strip, text.split(","))))
    if unknown := [each for each in found if each not in list(Vary)]:
        raise ValueError(f"{unknown[0]!r} cannot be varied; expected some of {', '.join(Vary)}")
    return tuple(map(Vary, found))


@click.command("optimize")
@paths_argument
@click.option(
    "--limit",
    "limits",
    multiple=True,
    type=Parsed(LIMIT_FORM, parse_limit),
    help=f"What must hold beside the limits of the model, e.g. '{LIMIT_EXAMPLE}'; may be repeated.",
)
@click.option(
    "--goal",
    "goals",
    multiple=True,
    metavar="GOAL",
    help=f"What to minimise: {', '.join(GOALS)}, or OBJECT.QUANTITY; may be repeated, the first counts most. Default: the number "
    "of changes.",
)
@click.option(
    "--vary",
    type=Parsed(",".join(Vary), _vary),
    default=",".join(DEFAULT),
    show_default=True,
    help="What may change: periods are those that the app.yaml offers, and only shorter ones; callbacks run in tasks "
    "of their own or in the executor, there in any order; communication is implicit or LET; memory is that of labels.",
)
@click.option(
    "--offer",
    "offers",
    multiple=True,
    type=OfKey("OBJECT.KEY=VALUES", parse_sweep),
    help=f"Values that a property may have, a range or a list, e.g. {SWEEP_EXAMPLE}; may be repeated.",
)
@click.option(
    "--keep", multiple=True, metavar="OBJECT[.KEY]", help="What must not change, e.g. a supplier's task; may be repeated."
)
@click.option("--rate-monotonic", "is_rate_monotonic", is_flag=True, help="Let priorities follow the periods.")
@click.option(
    "--may-be-later", is_flag=True, help="Allow that a chain answers later than now, counted from the arrival of its message."
)
@settings_options
@click.option("--all", "is_complete", is_flag=True, help="Judge all designs, also if some with few changes meet all limits.")
@click.option(
    "--designs",
    type=click.IntRange(min=1),
    default=MOST_DESIGNS,
    show_default=True,
    help="Judge at most so many designs.",
)
@click.option(
    "--time-limit",
    type=POSITIVE,
    metavar="SECONDS",
    help="End with the best design so far after this time; what is found then depends on the computer.",
)
@seed_option("Seed of random choices.")
@workers_options("designs", "one for each core, if there are many")
@click.option(
    "--proposals", type=click.IntRange(min=1), default=MOST_PROPOSALS, show_default=True, help="Show at most so many proposals."
)
@click.option("--pareto", type=PICTURE, metavar="FILE", help="Judge all designs, and draw what each goal costs, as SVG.")
@click.option(
    "-o", "--out", "target", type=MODEL_OR_DESCRIPTION, metavar="FILE", help="Write a proposal, as app.yaml or .amxmi."
)
@click.option(
    "--proposal", "number", type=click.IntRange(min=1), default=1, show_default=True, help="With -o: the proposal to write."
)
@output_option("Optimization")
def optimize(
    paths: tuple[Path, ...],
    pareto: Path | None,
    is_complete: bool,
    target: Path | None,
    number: int,
    outputs: tuple[Output, ...],
    **wishes: Any,
) -> None:
    """Search for changes with which all deadlines, requirements and limits are met, and then for the best ones.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. Every proposal is proved by the full analysis,
    and shown with all that it improves and makes worse. That nothing better, or nothing at all, exists is only said if it is proved.
    The exit code is 1 if no design was found that meets all limits. After Ctrl-C the best design so far is shown, files are written
    beside those that are named, as result.partial.json, and the exit code is 130.
    """
    outputs = checked_outputs(outputs, [("-o", target), ("--pareto", pareto)])
    wishes["proposals"] = max(wishes["proposals"], number if target is not None else 1)
    with working("Judging designs", wishes["designs"]) as progress:
        result = service.optimize(
            paths,
            is_complete=is_complete or pareto is not None,
            progress=progress.reach,
            **wishes,
        )
    is_finished = result.search.ended != ENDED_BY_USER
    if pareto is not None:
        from amalthea_uros.report.pictures.pareto import draw_pareto

        save_text(result_path(pareto, is_complete=is_finished), draw_pareto(result))
    closing = "" if is_met(result) else optimization_line(result)
    show_result(result, outputs, closing=closing, is_complete=is_finished)
    if target is not None and (is_finished or number <= len(result.proposals)):
        target = result_path(target, is_complete=is_finished)
        refuse_input(target, "-o")
        write_proposal(result, number, target)
        show_line(f"wrote proposal {number} to {target}")
    sys.exit(INTERRUPTED if not is_finished else 0 if is_met(result) else 1)
