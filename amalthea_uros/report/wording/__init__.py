"""Values, verdicts, chains and findings in words, once for all documents and fields."""
