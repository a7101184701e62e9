"""The command `frahm app` where it cannot serve: one message and exit code 2; and its end."""

import signal
import socket
import subprocess
import sys

from browsing import start

FRAHM = [sys.executable, "-m", "frahm"]


def run(*arguments):
    return subprocess.run([*FRAHM, *arguments], capture_output=True, text=True, check=False, timeout=240)


def test_without_dash_it_says_what_to_install():
    hidden = "import sys; sys.modules['dash'] = None; sys.argv = ['frahm', 'app']; from frahm.cli import main; main()"
    done = subprocess.run([sys.executable, "-c", hidden], capture_output=True, text=True, check=False, timeout=240)
    assert done.returncode == 2
    assert 'pip install "frahm[app]"' in done.stderr
    assert "Traceback" not in done.stderr


def test_a_port_in_use_is_named():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = run("app", "--port", str(port))
    assert done.returncode == 2
    assert f"--port: given {port}" in done.stderr
    assert "Traceback" not in done.stderr


def test_an_interruption_ends_it_with_all_it_started():
    server = start()
    server.process.send_signal(signal.SIGINT)
    assert server.process.wait(60) == 130
    assert "Traceback" not in server.process.stderr.read()
