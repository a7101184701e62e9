"""A process that does one job after the other: lines of JSON in on stdin, lines of JSON out on stdout.

It is a process, not a thread, so that a job can be ended at any moment and never slows the page down. It ends when its
stdin closes, that is, with the server.
"""

from __future__ import annotations

import json
import os
import queue
import sys
import threading
from typing import Any, TextIO

from frahm.errors import ParameterError
from frahm.web.jobs import do


def serve(source: TextIO, sink: TextIO) -> None:
    """Do the jobs that come in on `source` until it closes; the process ends with it, even amid a job."""
    waiting: queue.SimpleQueue[str] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(source, waiting), daemon=True).start()
    while True:
        answer(json.loads(waiting.get()), sink)


def _read(source: TextIO, waiting: queue.SimpleQueue[str]) -> None:
    for line in source:
        waiting.put(line)
    os._exit(0)


def answer(job: dict[str, Any], sink: TextIO) -> None:
    """Do one job and say how it went."""

    def say(**words: Any) -> None:
        sink.write(json.dumps(words) + "\n")
        sink.flush()

    try:
        result = do(job["name"], job["case"], job["arguments"], lambda *step: say(progress=step))
    except ParameterError as error:
        say(problem=str(error))
    except Exception as error:  # whatever it is, the visitor must hear of it; the traceback goes to the terminal
        sys.excepthook(*sys.exc_info())
        say(problem=f"This computation failed: {type(error).__name__}: {error}")
    else:
        say(result=result)


def main() -> None:
    """Entry of the process."""
    sink = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # nothing a library prints may mix with the answers
    serve(os.fdopen(os.dup(sys.stdin.fileno()), encoding="utf-8"), sink)


if __name__ == "__main__":
    main()
