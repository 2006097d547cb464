"""The difference of two models by meaning."""
