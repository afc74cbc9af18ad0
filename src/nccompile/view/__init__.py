"""Pictures: `drawing` turns a toolpath into polylines, `motion` set positions into curves over time, `plot` draws.

matplotlib is imported by `plot` alone; import it where a picture is asked for.
"""
