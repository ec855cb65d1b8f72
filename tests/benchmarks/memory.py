"""Whether memory stays flat while the same is done again and again."""

import numpy as np


def memory_of(pid):
    """Megabytes of memory that a process has now (Linux)."""
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        line = next(line for line in file if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


def slope(values):
    """By how much a row of equally spaced values grows from one to the next: that of a line through them."""
    return float(np.polyfit(np.arange(len(values)), values, 1)[0])
