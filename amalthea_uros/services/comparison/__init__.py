"""Predictions of a model compared with what was measured."""
