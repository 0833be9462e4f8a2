"""The memory of a process while a run goes on, against the generations that it has finished."""

import time
from pathlib import Path


def resident(pid):
    """The resident memory of a process [byte], or None when it has ended."""
    try:
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("VmRSS:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return None


class Lines:
    """Counts the lines of a file that grows."""

    def __init__(self, path):
        self.path, self.count, self.place = path, 0, 0

    def now(self):
        """The lines so far."""
        try:
            with self.path.open("rb") as file:
                file.seek(self.place)
                while block := file.read(1 << 20):
                    self.count += block.count(b"\n")
                    self.place += len(block)
        except OSError:
            pass
        return self.count


def watch(process, log, seconds=None):
    """Pairs of generations and resident memory, until the process ends or the time is over."""
    samples, lines, end = [], Lines(log), time.monotonic() + (seconds or 86400)
    while process.poll() is None and time.monotonic() < end:
        memory = resident(process.pid)
        generations = lines.now() - 1
        if memory and generations > 0:
            samples.append((generations, memory))
        time.sleep(0.1)
    return samples


def slope(samples):
    """Bytes of memory for each generation: least squares over the second half of the samples."""
    last = samples[-1][0]
    late = [(x, y) for x, y in samples if x >= 0.3 * last]
    if len(late) < 3:
        return None
    mean_x = sum(x for x, _ in late) / len(late)
    mean_y = sum(y for _, y in late) / len(late)
    square = sum((x - mean_x) ** 2 for x, _ in late)
    product = sum((x - mean_x) * (y - mean_y) for x, y in late)
    return product / square if square else None
