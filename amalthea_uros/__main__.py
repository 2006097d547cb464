"""`python -m amalthea_uros` is the command `amuros`."""

from amalthea_uros.cli.process import run

if __name__ == "__main__":
    run()
