"""What all tests share: this folder, whose observations and motions they import, and patience."""

from hypothesis import settings

settings.register_profile("patient", deadline=None)
settings.load_profile("patient")
