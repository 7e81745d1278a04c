"""Commands of `run.py`: machine, environment, and a module for each group of commands."""
