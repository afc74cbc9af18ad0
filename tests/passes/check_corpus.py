"""Takes every .nc program of folders through every pass, turned on for the whole program, with --verify.

python -m tests.passes.check_corpus FOLDER|FILE.. [--only NAME]

Prints one line a program and pass, failures with the reason; exit 1 if there were any.
"""

from __future__ import annotations

import argparse
import sys
import time
import traceback

from nccompile.diagnostics import Severity
from nccompile.errors import UsageError
from nccompile.machine.model import default_machine
from nccompile.passes.base import Report
from nccompile.passes.option import parse
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options
from tests.corpus import programs
from tests.passes.every import EVERY, Turned

__all__ = ["check"]

_CHOOSY = ("split", "move-start")
"""Passes that refuse a path without the segment they are told."""


def check(source: Source, turned: Turned) -> Report | None:
    """One program through one pass, verified behind every stage up to the plan; what the pass reported.

    Returns:  None if the pass refuses the program as the user's mistake (a contour that is not closed).
    Raises:   AssertionError: an error in the program that it has not got without the pass.
    """
    passes = parse(turned.spec)
    made = Compilation(source, Options(default_machine(), verify=True, passes=passes, measure=True))
    try:
        rows = sum(len(chunk) for chunk in made.planned())
    except UsageError:
        assert turned.made.name in _CHOOSY, turned.spec
        return None
    errors = [d for d in made.diagnostics if d.severity == Severity.ERROR]
    assert not errors, errors[0]
    (report,) = passes.reports
    assert rows > 0
    assert report.segments_out > 0
    assert report.deviation is not None
    return report


def main(arguments: list[str]) -> int:
    """The exit code."""
    options = argparse.ArgumentParser(prog="python -m tests.passes.check_corpus")
    options.add_argument("places", nargs="+")
    options.add_argument("--only", default="", help="passes whose name holds this")
    given = options.parse_args(arguments)
    failed = 0
    for path in programs(given.places):
        source = Source.read(path)
        for turned in EVERY:
            if given.only not in turned.spec:
                continue
            begin = time.process_time()
            try:
                report = check(source, turned)
                words = "refused" if report is None else (
                    f"{report.segments_in} -> {report.segments_out} segments, deviation {report.deviation:.6f} mm"
                )  # fmt: skip
            except Exception as error:  # any failure is what this script looks for
                failed += 1
                words = f"FAILED {type(error).__name__}: {error}"
                traceback.print_exc()
            spent = time.process_time() - begin
            print(f"{path.name:20} {turned.made.name:16} {spent:7.1f} s  {words}", flush=True)
    print(f"{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
