"""Toolpath to toolpath, one folder or file a pass; velocity planning is the last one (`passes.velocity`)."""
