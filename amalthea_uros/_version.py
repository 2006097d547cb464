"""The version, apart from the public interface, so that no room has to import that."""

__version__ = "0.1.0"
