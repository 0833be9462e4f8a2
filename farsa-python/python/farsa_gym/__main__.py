"""The command `farsa` as `python -m farsa_gym`."""

import signal
import sys

from ._farsa_gym import main

if __name__ == "__main__":
    # The command handles Ctrl-C itself, and a closed pipe ends it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(main(["farsa", *sys.argv[1:]]))
