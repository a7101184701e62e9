"""Processes of this machine as an executor."""

from __future__ import annotations

import contextlib
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from multiprocessing import get_context

from frahm.errors import check_count


@contextlib.contextmanager
def processes(count: int) -> Iterator[Executor]:
    """Give an executor of processes that leave an interruption to the one that writes the store.

    Parameters
    ----------
    count : int
        Number of processes. A script that uses them needs ``if __name__ == "__main__":``, as every script with
        processes does.
    """
    count = check_count("processes", count, at_most=_most())
    pool = ProcessPoolExecutor(count, mp_context=get_context("spawn"), initializer=_deaf)
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _most() -> int:
    """Processes a pool can wait for."""
    return 61 if sys.platform == "win32" else 1024


def _deaf() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
