"""Limits of time that are those of a machine with nothing else to do, and longer by as much as it is busy."""

import os
import subprocess
import time


def crowd():
    """How many threads want to run for each processor, at least 1."""
    return max(1.0, os.getloadavg()[0] / os.cpu_count())


class Patience:
    """Whether a time is over, of a machine with nothing else to do."""

    def __init__(self, seconds):
        self.seconds, self.began = seconds, time.monotonic()

    def is_over(self):
        return time.monotonic() - self.began > self.seconds * crowd()


def run(command, seconds, **more):
    """As subprocess.run() with all that is said in one text. Ends a program that takes too long, and raises TimeoutExpired."""
    patience = Patience(seconds)
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more) as process:
        while True:
            try:
                said, _ = process.communicate(timeout=2)
                return subprocess.CompletedProcess(command, process.returncode, said)
            except subprocess.TimeoutExpired as late:
                if patience.is_over():
                    process.kill()  # and not to the end of what it says: a program that it has started may go on
                    raise subprocess.TimeoutExpired(command, seconds, (late.output or b"").decode(errors="replace"))
