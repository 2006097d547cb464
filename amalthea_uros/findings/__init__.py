"""What kinds of findings exist, and what is done with findings: suppression, baseline, grouping, target tools."""
