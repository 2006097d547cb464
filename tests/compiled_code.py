"""Keep what Python and numba compile in one folder, for the other workers, for the commands that tests start, and for the next run.

This holds also where Python shall not write beside the sources: without it, each command compiles the package again, and each worker
what pytest rewrites, for which this module is imported before any of that.
"""

import os
import sys
from pathlib import Path

COMPILED = Path(__file__).parents[1] / "build" / "compiled"
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
os.environ.setdefault("PYTHONPYCACHEPREFIX", str(COMPILED / "python"))
os.environ.setdefault("NUMBA_CACHE_DIR", str(COMPILED / "numba"))
sys.dont_write_bytecode, sys.pycache_prefix = False, os.environ["PYTHONPYCACHEPREFIX"]
