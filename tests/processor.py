"""The machine that tests run on, in one line for a report: what decides how numbers are rounded."""

from __future__ import annotations

import os

import llvmlite.binding
import numpy as np

from frictionlab.runner.folder_files import machine_and_versions

SETTINGS = "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES", "NPY_DISABLE_CPU_FEATURES", "OPENBLAS_CORETYPE"
"""What the environment may ask of compilers and libraries."""


def this_machine() -> str:
    """Name the processor, versions of what computes, and what the environment asks of them."""
    about = machine_and_versions(["numba", "llvmlite", "numpy", "scipy", "hypothesis"])
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    asked = [f"{name}={os.environ[name]!r}" for name in SETTINGS if os.environ.get(name)]
    return ", ".join(
        [
            f"{about['processor']} ({llvmlite.binding.get_host_cpu_name()})",
            about["platform"],
            f"Python {about['python']}",
            *(" ".join(each) for each in about["packages"].items()),
            f"BLAS {blas['name']} {blas['version']}",
            *asked,
        ]
    )
