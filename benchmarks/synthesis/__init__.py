"""The parts of the generator of synthetic models."""
