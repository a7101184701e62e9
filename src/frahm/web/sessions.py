"""Visitors and the processes that work for them: nobody sees, delays or stops what another one started."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

# A browser wakes the timers of a page in the background once a minute: a visitor is given up after more than that.
SILENCE = 150.0
_LOOK_AROUND = 2.0
_PATIENCE = 3.0
MOST_SESSIONS = 64
_DECIDING = 120.0  # [s] a decision may take: nobody asked for it, and others wait for its process
_COMMAND = (sys.executable, "-m", "frahm.web.worker")
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
    progress: tuple[str, int, int] = ("waiting for its turn", 0, 0)
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

    def given(self, process: subprocess.Popen[str]) -> bool:
        """Give the job to a process, unless it has ended already; return whether it had not."""
        with self._ending:
            if self.done.is_set():
                return False
            self.process = process
            return True

    @property
    def seconds(self) -> float:
        """Time since the start [s]."""
        return time.monotonic() - self.started


@dataclass(eq=False)
class Turn:
    """A place in the queue.

    Attributes
    ----------
    visitor : object
        Who asks.
    long : bool
        Whether it may take its time: such jobs never hold all processes.
    number : int
        In order of asking.
    """

    visitor: object
    long: bool
    number: int


class Processes:
    """A few processes for the jobs of all visitors: whoever was served longest ago is next.

    Parameters
    ----------
    most : int, optional
        Most at work at a time; by default one a core, and at least two, so that a long job leaves one to the others.
    rest : float
        Time [s] after which one that has nothing to do ends, to give its memory back.
    command : sequence of str
        What starts one.
    """

    def __init__(self, most: int | None = None, rest: float = 60.0, command: Sequence[str] = _COMMAND) -> None:
        self.most = most or max(2, os.cpu_count() or 1)
        self._rest, self._command = rest, command
        self._idle: list[tuple[subprocess.Popen[str], float]] = []
        self._waiting: list[Turn] = []
        self._busy: list[Turn] = []
        self._served: weakref.WeakKeyDictionary[Any, int] = weakref.WeakKeyDictionary()
        self._count = 0
        self._changed = threading.Condition()
        self._closed = False

    def take(self, visitor: object, long: bool, unwanted: threading.Event) -> tuple[subprocess.Popen[str], Turn] | None:
        """A process without work, as soon as it is this visitor's turn; None if it is unwanted before that."""
        with self._changed:
            self._count += 1
            turn = Turn(visitor, long, self._count)
            self._waiting.append(turn)
            self._changed.wait_for(lambda: unwanted.is_set() or self._closed or self._next() is turn)
            self._waiting.remove(turn)
            self._changed.notify_all()
            if unwanted.is_set() or self._closed:
                return None
            self._busy.append(turn)
            self._served[visitor] = self._count
            while self._idle:
                process, _ = self._idle.pop()
                if process.poll() is None:
                    return process, turn
        return self._started(), turn

    def _next(self) -> Turn | None:
        """Who is next; nobody while all processes are at work."""
        if len(self._busy) >= self.most:
            return None
        full = sum(turn.long for turn in self._busy) >= max(1, self.most - 1)
        able = [turn for turn in self._waiting if not (turn.long and full)]
        return min(able, key=lambda turn: (self._served.get(turn.visitor, 0), turn.number), default=None)

    def _started(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
        )

    def look(self) -> None:
        """Look at the queue anew: a job has become unwanted."""
        with self._changed:
            self._changed.notify_all()

    def give_back(self, process: subprocess.Popen[str], turn: Turn) -> None:
        """The process has done its work, or has ended: it is kept for the next, and the next may begin."""
        with self._changed:
            self._busy.remove(turn)
            keep = not self._closed and process.poll() is None
            if keep:
                self._idle.append((process, time.monotonic()))
            self._changed.notify_all()
        if not keep:
            end_process(process)

    def end_idle(self) -> None:
        """End those that have had nothing to do for a while."""
        now = time.monotonic()
        with self._changed:
            ended = [process for process, since in self._idle if now - since >= self._rest]
            self._idle = [(process, since) for process, since in self._idle if now - since < self._rest]
        for process in ended:
            end_process(process)

    def close(self) -> None:
        """End all that wait, and whatever is given back from now on."""
        with self._changed:
            self._closed, idle, self._idle = True, self._idle, []
            self._changed.notify_all()
        for process, _ in idle:
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
    visitor : object
        Whose page it is.
    long : bool
        Whether its jobs may take their time.
    most : float, optional
        Time [s] after which a job that is waited for is ended.
    """

    def __init__(self, processes: Processes, visitor: object, long: bool = False, most: float | None = None) -> None:
        self._most = most
        self._processes, self._visitor, self._long = processes, visitor, long
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
            text = json.dumps({"name": name, "case": case, "arguments": arguments}) + "\n"
            threading.Thread(target=self._do, args=(job, text), daemon=True).start()
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
            if not job.done.wait(self._most) and job is self.job:
                with self._lock:
                    self._end_job(f"It took more than {self._most:g} s; the full report has no such limit.")
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
        if self.job is None or not self.job.end(reason):
            return
        if self.job.process is not None:
            end_process(self.job.process)
        self._processes.look()

    def _do(self, job: Job, text: str) -> None:
        """Wait for a process, and give it the job."""
        taken = self._processes.take(self._visitor, self._long, job.done)
        if taken is None:
            job.end(_CLOSED)
            return
        process, turn = taken
        try:
            if job.given(process):
                self._follow(job, process, text)
        finally:
            self._processes.give_back(process, turn)

    def _follow(self, job: Job, process: subprocess.Popen[str], text: str) -> None:
        """Hear what the process says about a job until it is done."""
        assert process.stdin is not None
        assert process.stdout is not None
        with contextlib.suppress(OSError, ValueError):  # it has died: reading from it tells
            process.stdin.write(text)
            process.stdin.flush()
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
        job.end(said.get("problem", ""), said.get("result"))


class _Visitor:
    """Nobody but oneself."""


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

    @classmethod
    def of(cls, processes: Processes) -> Session:
        """A session whose jobs share these processes with those of others."""
        visitor = _Visitor()
        deciding = Worker(processes, visitor, long=True, most=_DECIDING)
        return cls(Worker(processes, visitor), deciding, Worker(processes, visitor, long=True))

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
                session = self._sessions[name] = Session.of(self._processes)
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
            self._processes.end_idle()
            now = time.monotonic()
            for name in [key for key, session in list(self._sessions.items()) if now - session.heard > self._silence]:
                self.close(name)
