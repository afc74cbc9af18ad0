"""The exception tree: wrong calls, files and configuration.  The user's program gets Diagnostics instead.

NccompileError
+-- UsageError            a wrong option or argument (exit code 2)
+-- MachineError          a machine file that does not hold together (exit code 2)
+-- QueueError            a file that is not a sound OutQueue (exit code 2)
+-- RuntimeFault          the cyclic task or a drive had to stop (exit code 1)
+-- InvalidToolpath       our own bug: an invariant of the toolpath does not hold (exit code 3)

Cancelled                 no error: whoever asked for the work does not want it any more
"""

__all__ = [
    "Cancelled",
    "InvalidToolpath",
    "MachineError",
    "NccompileError",
    "QueueError",
    "RuntimeFault",
    "UsageError",
]


class Cancelled(Exception):
    """Whoever asked for the work does not want it any more."""


class NccompileError(Exception):
    """The base of all errors this package raises on purpose."""

    exit_code = 2


class UsageError(NccompileError):
    """A wrong option, argument or file kind."""


class MachineError(NccompileError):
    """A machine file with an unknown key, a wrong unit or a value out of bounds."""


class QueueError(NccompileError):
    """A file that is not an OutQueue, or that was truncated or altered."""


class RuntimeFault(NccompileError):
    """The cyclic task stopped on a fault: drive limit, following error, data underrun without supply."""

    exit_code = 1


class InvalidToolpath(NccompileError):
    """A toolpath breaks one of its invariants: a bug of the stage that made it."""

    exit_code = 3
