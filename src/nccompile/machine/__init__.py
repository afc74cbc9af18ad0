"""The machine file: axes, limits, path defaults, kinematics and runtime sizes.

`nccompile.machine.model` reads and validates it, `nccompile.machine.limits` gives its numbers as arrays.
Nothing is imported here, so that commands which need no machine do not pay for pydantic.
"""
