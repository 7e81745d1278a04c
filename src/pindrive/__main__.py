"""`python -m pindrive`: the command line."""

from pindrive.cli.app import main

main()
