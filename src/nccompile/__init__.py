"""nccompile: an offline compiler and path toolchain for CNC part programs.

text -> blocks -> toolpath -> passes -> plan -> queue -> cycle; each stage is a folder that imports only
from the stages before it (docs/architecture.md).
"""

from nccompile.version import VERSION

__all__ = ["__version__"]

__version__ = VERSION
