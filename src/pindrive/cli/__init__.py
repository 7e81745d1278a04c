"""The command line: one file for the commands of each topic, and what they share."""
