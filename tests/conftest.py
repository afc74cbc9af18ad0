"""Settings of the property tests.

Without time limits, which only measure how busy the computer is, and with the same examples in every run, so that
a change and not chance makes a test fail.  NCCOMPILE_EXPLORE=1 takes new examples each time.
"""

from __future__ import annotations

import os
import signal

from hypothesis import settings

# A test run in the background of a script starts with interrupts ignored, and so would the commands it interrupts.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.register_profile("explore", deadline=None)
settings.load_profile("explore" if os.environ.get("NCCOMPILE_EXPLORE") else "repeatable")
