"""Why a response time or a latency is so long."""

from __future__ import annotations

from amalthea_uros.analyze.callback_explanation import explain_callback
from amalthea_uros.analyze.chains.explanation import explain_chain
from amalthea_uros.analyze.explanation import explain_process
from amalthea_uros.analyze.results import Quantity
from amalthea_uros.services.analyze import Analyzed, Explanation, analysis_result
from amalthea_uros.services.improvements import check_explained, improvements
from amalthea_uros.services.names import require


def explain(analyzed: Analyzed, name: str, quantity: Quantity = Quantity.MAX_REDUCED_REACTION_TIME) -> Explanation:
    """Explain the response time of a process or callback, or a maximum latency of a chain: why is it so long?

    >>> print(explain("app.yaml", "factor-to-output"))  # doctest: +SKIP

    Parameters
    ----------
    analyzed : an analysis, or what `analyze` takes
    quantity : of a chain, one of `MAX_REACTION_TIME`, `MAX_REDUCED_REACTION_TIME`, `MAX_DATA_AGE` and `MAX_REDUCED_DATA_AGE`

    Raises
    ------
    InvalidArgumentError : there is no such process, callback or chain, or another quantity.
    """
    result = analysis_result(analyzed)
    system, analysis = result.system, result.analysis
    check_explained(quantity)
    callbacks = [callback.name for callback in analysis.callbacks]
    require("process, callback or chain", [name], dict.fromkeys((*system.processes, *callbacks, *system.chains)))
    return Explanation(
        name=name,
        process=explain_process(analysis, name) if name in system.processes else None,
        chain=explain_chain(analysis, name, quantity) if name in system.chains else None,
        callbacks=explain_callback(analysis, name),
        improvements=improvements(result, name, quantity) if name in system.chains else None,
    )
