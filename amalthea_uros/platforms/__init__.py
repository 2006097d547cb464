"""Controllers as data: what `hardware: {platform: NAME}` refers to. A user's own file looks the same."""
