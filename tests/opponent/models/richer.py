"""Random models with constraints."""

from __future__ import annotations

from opponent.models.generator import RandomModel, constrained, random_model


def richer_model(seed: int) -> RandomModel:
    """The model of a number, with constraints."""
    return constrained(random_model(seed), seed)
