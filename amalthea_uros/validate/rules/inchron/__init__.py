"""What INCHRON's importer am2inc refuses, crashes at, drops or changes, as of its version of December 2024."""
