# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Pictures read side by side: one thread decodes one picture, and a large sweep waits mostly for that."""
import collections
import concurrent.futures
import functools
import os

MOST = 4  # more would wait for the disk, and hold too many pictures


@functools.cache
def readers():
    """The threads, always the same ones: each keeps some memory of its own."""
    return concurrent.futures.ThreadPoolExecutor(threads())


def threads():
    return min(MOST, len(os.sched_getaffinity(0)))


def in_order(function, items):
    """function(item) of each of the items, some of them computed at the same time."""
    waiting = collections.deque()
    try:
        for item in items:
            waiting.append(readers().submit(function, item))
            if len(waiting) > threads():
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        for task in waiting:
            task.cancel()
