"""Ctrl-C ends a command within seconds whatever its main thread is in."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time

import pytest
from profiles import some

from frictionlab import cli
from frictionlab.cli import interrupts

START = """
import sys, time
import click
from frictionlab import cli
from frictionlab.cli import interrupts

def command(arguments):
    WORK

interrupts.PATIENCE = 0.5
cli._invoke = command
sys.exit(cli.main([]))
"""
IN_COMPILED_CODE = """
    import numba
    wait = numba.njit("f8(f8)", nogil=True)(endless)
    print("compiled", flush=True)
    wait(1.0)
"""
ENDLESS = """
def endless(a):
    while a > 0.0:
        a = a * 1.0000001 if a < 2.0 else 1.0
    return a
"""
LOSING = """
    class Loses:
        def __del__(self):
            time.sleep(1.0)
    print("compiled", flush=True)
    Loses()
    time.sleep(60.0)
"""
PATIENT = """
    print("compiled", flush=True)
    time.sleep(60.0)
"""


@some(1, "a process each")
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize(
    "work", [IN_COMPILED_CODE, LOSING, PATIENT], ids=["a kernel", "a callback", "Python"]
)
def test_an_interrupt_ends_a_command_within_seconds(work):
    program = ENDLESS + START.replace("\n    WORK\n", work)
    command = [sys.executable, "-c", program]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if line == "compiled\n":
                break
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        problems = process.communicate(timeout=30)[1]

    assert (process.returncode, problems) == (130, "interrupted\n")


def test_an_interrupted_command_ends_neither_its_caller_nor_the_threads_of_its_caller(monkeypatch):
    def command(arguments):
        signal.signal(signal.SIGINT, signal.default_int_handler)  # another handler than the one that tells
        signal.raise_signal(signal.SIGINT)

    ended, over = [], threading.Event()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    monkeypatch.setattr(cli.os, "_exit", ended.append)
    monkeypatch.setattr(interrupts, "NOTICED_WITHIN", 0.05)
    monkeypatch.setattr(cli, "_invoke", command)
    threading.Thread(target=over.wait, daemon=True).start()
    try:
        assert cli.main([]) == 130
        time.sleep(0.1)
    finally:
        over.set()
        signal.signal(signal.SIGINT, before)

    assert ended == []
