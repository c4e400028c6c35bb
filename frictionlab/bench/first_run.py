"""What the first curve costs on a machine that has no kernels: a process of its own with an empty cache."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Sequence

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.scene.scene import Scene

SCRIPT = """
import pickle, sys, time
method, scenes, law, tolerance = pickle.load(sys.stdin.buffer)
from frictionlab.bench.solvers import whole_task
whole_task(method, scenes, law, tolerance)()
print(time.process_time())
"""


def first_run(method: Method, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> float:
    """Processor time [s] of every column of a curve, imports and compiling included.

    Raises CalledProcessError where the method raises.
    """
    with tempfile.TemporaryDirectory() as empty:
        environment = {name: value for name, value in os.environ.items() if name != "FRICTIONLAB_COMPILE"}
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            input=pickle.dumps((method, list(scenes), law, tolerance)),
            env=environment | {"FRICTIONLAB_CACHE": empty},
            stdout=subprocess.PIPE,
            check=True,
        )
    return float(done.stdout)
