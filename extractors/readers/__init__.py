"""Captures read from files: bundles and their schema, formats, drafts, and names of joints."""
