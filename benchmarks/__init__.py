"""Benchmarks: `make bench` runs them, README.md beside this file has measured figures."""
