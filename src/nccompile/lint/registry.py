"""All rules: every module of `nccompile.lint.rules` holds one."""

from __future__ import annotations

import functools
import importlib
import pkgutil

from nccompile.lint import rules
from nccompile.lint.base import Rule

__all__ = ["RULES", "all_rules"]


@functools.cache
def all_rules() -> tuple[Rule, ...]:
    """One object of each rule, in the order of their codes."""
    for module in pkgutil.iter_modules(rules.__path__):
        importlib.import_module(f"{rules.__name__}.{module.name}")
    return tuple(sorted((kind() for kind in Rule.__subclasses__()), key=lambda rule: rule.code))


RULES = all_rules()
"""All rules."""
