"""The command line, `pindrive` or `python -m pindrive`; Ctrl-C ends it in a line from here on."""

import sys

from pindrive.cli.interrupts import INTERRUPTED, STOPPED, ignore_more, interruptible


def main() -> None:
    """Import the program and run it."""
    interruptible()
    try:
        from pindrive.cli.app import main as run

        run()
    except KeyboardInterrupt:
        ignore_more()
        print(STOPPED, file=sys.stderr)
        sys.exit(INTERRUPTED)


if __name__ == "__main__":
    main()
