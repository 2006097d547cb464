"""The language server: what `check` and `analyze` say about a file while somebody edits it."""
