"""`python -m pindrive`: the command line."""

from pindrive.cli import main

main()
