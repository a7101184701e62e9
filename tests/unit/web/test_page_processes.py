"""The processes that work for the page: a few for all visitors, each visitor in turn, memory given back."""

import sys
import threading
import time

import pytest

from frahm.web.sessions import Processes, Worker

# Does nothing for the time it is asked for, and says that it did.
SLEEPER = """
import json, sys, time
for line in sys.stdin:
    job = json.loads(line)
    time.sleep(job["arguments"]["seconds"])
    print(json.dumps({"result": {"name": job["name"]}}), flush=True)
"""


class Someone:
    pass


@pytest.fixture
def processes():
    made = Processes(most=2, rest=0.2, command=(sys.executable, "-c", SLEEPER))
    yield made
    made.close()


def finished(jobs):
    """The names of jobs in the order in which they end."""
    order, lock = [], threading.Lock()

    def wait(job):
        assert job.done.wait(30)
        with lock:
            order.append(job.name)

    threads = [threading.Thread(target=wait, args=(job,)) for job in jobs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return order


def test_twenty_visitors_share_two_processes(processes):
    most, stop = [], threading.Event()

    def watch():
        while not stop.wait(0.005):
            most.append(len(processes._busy) + len(processes._idle))

    watcher = threading.Thread(target=watch)
    watcher.start()
    jobs = [Worker(processes, Someone()).start(f"{number}", {}, seconds=0.02) for number in range(20)]
    assert len(finished(jobs)) == 20
    assert all(job.result == {"name": job.name} for job in jobs)
    stop.set()
    watcher.join()
    assert max(most) <= 2


def test_who_asks_much_does_not_keep_others_waiting(processes):
    busy, other = Someone(), Someone()
    holds = [Worker(processes, Someone()).start("hold", {}, seconds=0.5) for _ in range(2)]
    time.sleep(0.1)
    many = [Worker(processes, busy).start(f"many {number}", {}, seconds=0.15) for number in range(8)]
    time.sleep(0.05)
    one = Worker(processes, other).start("one", {}, seconds=0.05)
    order = finished([*holds, *many, one])
    assert order.index("one") <= 4


def test_long_jobs_leave_a_process_to_the_others(processes):
    long = [Worker(processes, Someone(), long=True).start("long", {}, seconds=1.0) for _ in range(3)]
    time.sleep(0.1)
    quick = Worker(processes, Someone()).start("quick", {}, seconds=0.0)
    assert finished([quick, *long])[0] == "quick"


def test_cancelled_jobs_leave_the_queue_and_free_their_process(processes):
    workers = [Worker(processes, Someone()) for _ in range(4)]
    jobs = [worker.start(f"{number}", {}, seconds=60.0) for number, worker in enumerate(workers)]
    time.sleep(0.1)
    for worker in reversed(workers):
        worker.cancel()
    assert [job.problem for job in jobs] == 4 * ["Cancelled."]
    assert finished([Worker(processes, Someone()).start("next", {}, seconds=0.0)]) == ["next"]


def test_a_process_with_nothing_to_do_gives_its_memory_back(processes):
    job = Worker(processes, Someone()).start("one", {}, seconds=0.0)
    finished([job])
    processes.end_idle()
    assert job.process.poll() is None
    time.sleep(0.3)
    processes.end_idle()
    assert job.process.poll() is not None
