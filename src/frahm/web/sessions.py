"""Visitors and the processes that work for them: nobody sees, delays or stops what another one started."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
import threading
import time
from dataclasses import dataclass, field
from typing import Any

# A browser wakes the timers of a page in the background once a minute: a visitor is given up after more than that.
SILENCE = 150.0
_LOOK_AROUND = 2.0
_PATIENCE = 3.0
MOST_SESSIONS = 64
_CANCELLED, _REPLACED, _CLOSED = "Cancelled.", "Replaced by a newer one.", "The page was closed."
ENDED = (_CANCELLED, _REPLACED, _CLOSED)  # why a job has no result, where nothing went wrong


@dataclass
class Job:
    """One computation, and how far it is.

    Attributes
    ----------
    name : str
    case : dict
        The case it is about.
    progress : tuple
        What is being done, number of steps done, number of steps (0 if not known).
    result : dict or None
        What came out.
    problem : str
        Why nothing came out; empty otherwise.
    done : Event
        Set at the end, whatever it is.
    process : Popen or None
        What does it.
    """

    name: str
    case: dict[str, Any]
    progress: tuple[str, int, int] = ("starting", 0, 0)
    result: dict[str, Any] | None = None
    problem: str = ""
    done: threading.Event = field(default_factory=threading.Event)
    started: float = field(default_factory=time.monotonic)
    process: subprocess.Popen[str] | None = None
    _ending: threading.Lock = field(default_factory=threading.Lock)

    def end(self, problem: str, result: dict[str, Any] | None = None) -> bool:
        """End the job this way, unless it has ended already; return whether it had not."""
        with self._ending:
            if self.done.is_set():
                return False
            self.problem, self.result = problem, result
            self.done.set()
            return True

    @property
    def seconds(self) -> float:
        """Time since the start [s]."""
        return time.monotonic() - self.started


class Processes:
    """Processes that wait for a job: one that is free is taken before another one is started.

    Parameters
    ----------
    spare : int
        Most that are kept without work.
    """

    def __init__(self, spare: int = 2) -> None:
        self._spare = spare
        self._idle: list[subprocess.Popen[str]] = []
        self._lock = threading.Lock()
        self._closed = False

    def take(self) -> subprocess.Popen[str]:
        """A process without work."""
        with self._lock:
            while self._idle:
                process = self._idle.pop()
                if process.poll() is None:
                    return process
        return subprocess.Popen(
            [sys.executable, "-m", "frahm.web.worker"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8",
        )  # fmt: skip

    def give_back(self, process: subprocess.Popen[str]) -> None:
        """The process has done its work: keep it for the next, or end it if there are enough."""
        with self._lock:
            if not self._closed and len(self._idle) < self._spare and process.poll() is None:
                self._idle.append(process)
                return
        end_process(process)

    def close(self) -> None:
        """End all that wait, and whatever is given back from now on."""
        with self._lock:
            self._closed, idle, self._idle = True, self._idle, []
        for process in idle:
            end_process(process)


def end_process(process: subprocess.Popen[str]) -> None:
    """End a process at once."""
    process.kill()
    process.wait()
    for stream in filter(None, (process.stdin, process.stdout)):
        with contextlib.suppress(OSError, ValueError):  # what it had not read yet is lost with it
            stream.close()


class Worker:
    """Does one job at a time for one page, each in a process.

    Parameters
    ----------
    processes : Processes
        Where they come from.
    """

    def __init__(self, processes: Processes) -> None:
        self._processes = processes
        self._lock = threading.Lock()
        self._asked: dict[str, int] = {}
        self._turn = threading.Lock()
        self._closed = False
        self.job: Job | None = None

    def start(self, name: str, case: dict[str, Any], **arguments: Any) -> Job:
        """Start a job; one that is still running is cancelled."""
        with self._lock:
            self._end_job(_REPLACED)
            job = self.job = Job(name, case)
            if self._closed:
                job.end(_CLOSED)
                return job
            job.process = self._processes.take()
            threading.Thread(target=self._follow, args=(job,), daemon=True).start()
            with contextlib.suppress(OSError):  # it has died: whoever follows it finds out
                assert job.process.stdin is not None
                job.process.stdin.write(json.dumps({"name": name, "case": case, "arguments": arguments}) + "\n")
                job.process.stdin.flush()
        return job

    def ask(self, name: str, case: dict[str, Any], **arguments: Any) -> Job | None:
        """Do a short job and wait for it; None if a newer question of the same name came meanwhile."""
        mine = self._asked[name] = self._asked.get(name, 0) + 1
        running = self.job
        if running is not None and running.name == name and not running.done.is_set() and running.seconds > _PATIENCE:
            self.cancel()
        with self._turn:
            if mine != self._asked[name]:
                return None
            job = self.start(name, case, **arguments)
            job.done.wait()
        return job if mine == self._asked[name] else None

    def cancel(self) -> None:
        """End the job that is running, at once."""
        with self._lock:
            self._end_job(_CANCELLED)

    def close(self) -> None:
        """End the job that is running, and take no more."""
        with self._lock:
            self._closed = True
            self._end_job(_CLOSED)

    def _end_job(self, reason: str) -> None:
        if self.job is not None and self.job.end(reason) and self.job.process is not None:
            end_process(self.job.process)

    def _follow(self, job: Job) -> None:
        """Hear what the process says about a job until it is done."""
        process = job.process
        assert process is not None
        assert process.stdout is not None
        try:
            while True:
                line = process.stdout.readline()
                if not line:
                    raise EOFError
                said = json.loads(line)
                if "progress" not in said:
                    break
                title, at, total = said["progress"]
                job.progress = (str(title), int(at), int(total))
        except (EOFError, ValueError, OSError):
            if job.end("The process that computed this has ended unexpectedly."):
                end_process(process)
            return
        if job.end(said.get("problem", ""), said.get("result")):
            self._processes.give_back(process)


@dataclass
class Session:
    """One open page.

    Attributes
    ----------
    quick, deciding, long : Worker
        For jobs of a moment, for the decision that follows them, and for what is asked for and takes its time.
    heard : float
        When it was last heard of [s].
    newest : int
        Number of the newest values drawn: an answer to older ones is dropped.
    exact : str
        Digest of the case whose exact response is drawn; empty if there is none.
    """

    quick: Worker
    deciding: Worker
    long: Worker
    heard: float = field(default_factory=time.monotonic)
    newest: int = 0
    exact: str = ""

    def close(self) -> None:
        """End its work."""
        self.quick.close()
        self.deciding.close()
        self.long.close()


class Sessions:
    """All open pages, by their identifier; those that fall silent are closed."""

    def __init__(self, silence: float = SILENCE) -> None:
        self._silence = silence
        self._processes = Processes()
        self._sessions: dict[str, Session] = {}
        self._lock = threading.Lock()
        self._stop = threading.Event()
        threading.Thread(target=self._look_around, daemon=True).start()

    def of(self, name: str) -> Session:
        """Session of a page; a new one, or one given up before, begins afresh."""
        with self._lock:
            if name not in self._sessions and len(self._sessions) >= MOST_SESSIONS:
                oldest = min(self._sessions, key=lambda key: self._sessions[key].heard)
                threading.Thread(target=self._sessions.pop(oldest).close, daemon=True).start()
            session = self._sessions.get(name)
            if session is None:
                session = self._sessions[name] = Session(
                    Worker(self._processes), Worker(self._processes), Worker(self._processes)
                )
            session.heard = time.monotonic()
            return session

    def close(self, name: str) -> None:
        """A page was closed: end what it had started."""
        with self._lock:
            session = self._sessions.pop(name, None)
        if session is not None:
            session.close()

    def close_all(self) -> None:
        """End everything."""
        self._stop.set()
        self._processes.close()
        for name in list(self._sessions):
            self.close(name)

    def _look_around(self) -> None:
        while not self._stop.wait(_LOOK_AROUND):
            now = time.monotonic()
            for name in [key for key, session in list(self._sessions.items()) if now - session.heard > self._silence]:
                self.close(name)
