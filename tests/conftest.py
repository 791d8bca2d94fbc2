"""What all tests share: this folder, whose observations and motions they import, and patience."""

from hypothesis import settings

# The same examples every time: what a build says depends on the code alone.
settings.register_profile("patient", deadline=None, derandomize=True)
settings.load_profile("patient")
