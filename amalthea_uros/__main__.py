"""`python -m amalthea_uros` is the command `amuros`."""

from amalthea_uros.cli.main import main

if __name__ == "__main__":
    main()
