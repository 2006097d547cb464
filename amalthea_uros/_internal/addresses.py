"""Where the product is found; `[project.urls]` states the same addresses."""

REPOSITORY = "https://github.com/amuros/amuros"
DOCUMENTATION = "https://amuros.github.io/amuros"
