"""How hard Hypothesis looks: profile dev (default), ci (wherever CI is set) or deep, or $HYPOTHESIS_PROFILE.

No profile has a deadline: the first case may have to compile a kernel. Compiled kernels are kept between runs in
the folder the program itself uses.
"""

from __future__ import annotations

import os

from hypothesis import HealthCheck, settings

settings.register_profile("dev", max_examples=20, deadline=None)
settings.register_profile("ci", max_examples=50, deadline=None, derandomize=True)
settings.register_profile(
    "deep", max_examples=5_000, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)


def _profile() -> str:
    on_ci = os.environ.get("CI", "").lower() not in ("", "0", "false")
    return os.environ.get("HYPOTHESIS_PROFILE") or ("ci" if on_ci else "dev")


settings.load_profile(_profile())
