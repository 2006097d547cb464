"""Why something cannot be simulated."""

from __future__ import annotations


class NotSimulatedError(Exception):
    """A process, stimulus or chain cannot be simulated as it is modelled; the text says why."""
