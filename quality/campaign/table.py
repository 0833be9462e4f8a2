"""What was tried, what survived and what was lost."""

import sys
import threading
import time


class Table:
    """The counts of each test, in the order in which they began."""

    def __init__(self, quiet=False):
        self.rows = {}
        self.reasons = []
        self.quiet = quiet
        self.lock = threading.Lock()
        self.began = time.monotonic()
        self.told = self.began

    def begin(self, test):
        """Has a row for a test, also when nothing comes of it."""
        with self.lock:
            self.rows.setdefault(test, [0, 0, None])

    def survived(self, test):
        """Counts what survived."""
        with self.lock:
            self.rows.setdefault(test, [0, 0, None])[0] += 1
            now = time.monotonic()
            if now - self.told > 10:
                self.told = now
                self.say(self.line(test))

    def lost(self, test, why, command, folder):
        """Counts what was lost, and says how to see it again."""
        with self.lock:
            self.rows.setdefault(test, [0, 0, None])[1] += 1
            self.reasons.append(why)
            self.say(f"LOST {test}: {why}\n  command: {command}\n  kept: {folder}")

    def not_run(self, test, why):
        """A test that cannot be run here: it has not survived."""
        with self.lock:
            self.rows.setdefault(test, [0, 0, None])[2] = why
            self.say(f"{test}: not run: {why}")

    def say(self, text):
        """Prints progress."""
        if not self.quiet:
            seconds = time.monotonic() - self.began
            print(f"[{seconds:7.1f} s] {text}", flush=True)

    def line(self, test):
        """A row in words."""
        survived, lost, why = self.rows[test]
        if why:
            return f"{test}: not run: {why}"
        return f"{test}: {survived + lost} / {survived} / {lost}"

    def losses(self):
        """The tests that lost something, or that tried nothing and do not say why."""
        return [
            test
            for test, (survived, lost, why) in self.rows.items()
            if lost or (survived == 0 and not why)
        ]

    def print(self):
        """Prints all rows."""
        print("\ntest: tried / survived / lost")
        for test in self.rows:
            print(self.line(test))
        sys.stdout.flush()
