"""A Dask cluster as an executor; the only file that knows Dask."""

from __future__ import annotations

import contextlib
import logging
import re
from collections.abc import Iterator
from concurrent.futures import Executor

from frahm.errors import ParameterError

_ADDRESS = re.compile(r"([a-z]+://)?\S+[:/]\d{1,5}")
_REACHED = 10.0  # seconds within which a scheduler answers
_JOINED = 30.0  # seconds within which a worker has joined it
_ALLOWED = "the address of a Dask scheduler that answers, such as tcp://127.0.0.1:8786"


@contextlib.contextmanager
def scheduler(address: str) -> Iterator[Executor]:
    """Give the executor of a Dask scheduler that is already running.

    Parameters
    ----------
    address : str
        Such as ``"tcp://127.0.0.1:8786"``.

    Raises
    ------
    ParameterError
        If Dask is not installed, the scheduler does not answer, or it has no workers.
    """
    try:
        from distributed import Client
    except ImportError:
        hint = "Dask is not installed: pip install 'frahm[cluster]'."
        raise ParameterError("scheduler", address, "left out without the extra cluster", hint=hint) from None
    if not _ADDRESS.fullmatch(address):
        raise ParameterError("scheduler", address, _ALLOWED)
    with _quiet():
        try:
            client = Client(address, timeout=_REACHED, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            hint = f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else 'no answer'}."
            raise ParameterError("scheduler", address, _ALLOWED, hint=hint) from None
    with contextlib.closing(client):
        try:
            client.wait_for_workers(1, timeout=_JOINED)
        except TimeoutError:
            hint = f"It answers, but no worker has joined it within {_JOINED:g} s."
            raise ParameterError("scheduler", address, "a scheduler with workers", hint=hint) from None
        yield client.get_executor(pure=False)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Without the messages Dask logs about a connection that is being tried again."""
    log = logging.getLogger("distributed")
    before = log.level
    log.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        log.setLevel(before)
