# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How much memory there is to use."""
import ctypes
import pathlib
import re

M_MMAP_THRESHOLD = -3  # of malloc.h
LARGE = 2 ** 20        # bytes that are asked of the system and given back to it
SHARE = 0.6  # of what is free
UNITS = {'': 2 ** 30, 'K': 2 ** 10, 'M': 2 ** 20, 'G': 2 ** 30, 'T': 2 ** 40}


def bytes_of(text):
    """'6G', '6' or '6GiB', '800M'."""
    match = re.fullmatch(r'([0-9]+(?:\.[0-9]+)?)\s*([KMGT]?)(?:i?B)?', text.strip(), re.IGNORECASE)
    if not match or float(match[1]) <= 0:
        raise ValueError(f'{text} is no amount of memory: write 6G or 800M')
    return float(match[1]) * UNITS[match[2].upper()]


def number_in(path):
    try:
        return int(pathlib.Path(path).read_text())
    except (OSError, ValueError):  # 'max', or no such group
        return None


def free_bytes(meminfo='/proc/meminfo', group='/sys/fs/cgroup'):
    """What this process could have: what the machine has free, and what its control group lets it have."""
    available = re.search(r'^MemAvailable:\s+(\d+) kB', pathlib.Path(meminfo).read_text(), re.MULTILINE)
    free = int(available[1]) * 1024 if available else 2 ** 31
    limit, used = number_in(f'{group}/memory.max'), number_in(f'{group}/memory.current')
    return min(free, max(limit - (used or 0), 0)) if limit else free


def to_use(asked):
    """Bytes: at most what --memory says, and no more than is free."""
    return SHARE * free_bytes() if asked is None else min(asked, free_bytes())


def use_sparingly():
    """Lets the C library give back what is large as soon as it is freed. By itself it keeps it for later, a share for each thread,
    of which every run of the elements has new ones: a stack in twenty slabs would take twice its memory."""
    ctypes.CDLL(None).mallopt(M_MMAP_THRESHOLD, LARGE)


def give_back():
    ctypes.CDLL(None).malloc_trim(0)
