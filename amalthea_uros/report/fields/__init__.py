"""The names and values of results for programs: each class declares its fields once, for JSON, records and data frames."""
