"""Why a response time or a latency is so long, and what would shorten it."""

from __future__ import annotations

from amalthea_uros.analyze.explanations.chains import explain_chain
from amalthea_uros.analyze.explanations.processes import explain_callback, explain_process
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.design.description.origin import DescriptionOrigin
from amalthea_uros.design.improvements import Improvements, check_explained, improvements_of
from amalthea_uros.names import require
from amalthea_uros.services.analyze import AnalysisResult, Analyzed, Explanation, analysis_result
from amalthea_uros.uros.application.callbacks import body_name


def explain(
    analyzed: Analyzed, name: str, quantity: LatencyQuantity = LatencyQuantity.MAX_REDUCED_REACTION_TIME
) -> Explanation:
    """Explain the response time of a process or callback, or a maximum latency of a chain: why is it so long?

    >>> print(explain("app.yaml", "factor-to-output"))  # doctest: +SKIP

    Parameters
    ----------
    analyzed : an analysis, or what `analyze` takes
    name : a callback in an executor also by its name in the `app.yaml`
    quantity : of a chain, one of `MAX_REACTION_TIME`, `MAX_REDUCED_REACTION_TIME`, `MAX_DATA_AGE` and `MAX_REDUCED_DATA_AGE`

    Raises
    ------
    InvalidArgumentError : there is no such process, callback or chain, or another quantity.
    """
    result = analysis_result(analyzed)
    system, analysis = result.system, result.analysis
    check_explained(quantity)
    known = dict.fromkeys((*system.processes, *(callback.name for callback in analysis.callbacks), *system.chains))
    if name not in known and body_name(name) in known:
        name = body_name(name)
    require("process, callback or chain", [name], known)
    chain = explain_chain(analysis, name, quantity) if name in system.chains else None
    return Explanation(
        name=name,
        process=explain_process(analysis, name) if name in system.processes else None,
        chain=chain,
        callbacks=explain_callback(analysis, name),
        improvements=None if chain is None else improvements_of(analysis, chain, result.task_periods, _source(result)),
    )


def improvements(
    analyzed: Analyzed, chain: str, quantity: LatencyQuantity = LatencyQuantity.MAX_REDUCED_REACTION_TIME
) -> Improvements:
    """Try single changes of a system, and rank those that shorten a latency of a chain.

    Parameters
    ----------
    analyzed : an analysis, or what `analyze` takes
    quantity : one of `MAX_REACTION_TIME`, `MAX_REDUCED_REACTION_TIME`, `MAX_DATA_AGE` and `MAX_REDUCED_DATA_AGE`

    Raises
    ------
    InvalidArgumentError : there is no such chain, or another quantity.
    """
    result = analysis_result(analyzed)
    require("chain", [chain], result.system.chains)
    check_explained(quantity)
    explained = explain_chain(result.analysis, chain, quantity)
    return improvements_of(result.analysis, explained, result.task_periods, _source(result))


def _source(result: AnalysisResult) -> DescriptionOrigin | None:
    """The description that was analysed, with the changes of values; None for other systems."""
    return None if result.changed is None else result.changed.source
