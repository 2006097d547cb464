"""The file format: reading, writing, references, multi-file models, compression."""
