"""nccompile: an offline compiler and path toolchain for CNC part programs.

text -> blocks -> toolpath -> passes -> plan -> queue -> cycle; each stage is a folder that imports only
from the stages before it (docs/architecture.md).
"""

from nccompile.version import VERSION as __version__

__all__ = ["__version__"]
