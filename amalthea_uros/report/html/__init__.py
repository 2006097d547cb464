"""A report as one HTML page: each section is a module in `sections`, which prepares blocks that the templates write."""
