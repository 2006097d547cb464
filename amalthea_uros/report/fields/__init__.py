"""The names and values of results for programs: each class declares its fields once, for JSON, records and data frames."""

_MODULES = {
    "analysis": ("AnalysisResult",),
    "descriptions": ("BuildResult", "GenerateResult", "MetaCheck"),
    "measurement": ("Calibration", "Comparison", "Measurement"),
    "models": ("CheckResult", "DiffResult", "InfoResult", "MigrationResult", "RulesResult"),
    "search": ("Optimization", "SweepResult"),
    "simulation": ("CampaignResult", "SimulationResult"),
}
#: The classes of results that JSON can be made of, and the modules that declare their fields.
FIELDS = {name: module for module, names in _MODULES.items() for name in names}
