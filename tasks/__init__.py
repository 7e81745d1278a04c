"""What `run.py` does: the machine, the environment, and a module for each group of commands."""
