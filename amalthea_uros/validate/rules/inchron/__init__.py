"""Rules about models that INCHRON's importer am2inc (December 2024) refuses, crashes at, loses or changes parts of."""
