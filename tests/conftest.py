"""What all tests share: this folder, whose observations and motions they import, and patience."""

import signal

from hypothesis import settings

# The same examples every time: what a build says depends on the code alone.
settings.register_profile("patient", deadline=None, derandomize=True)
settings.load_profile("patient")

# In the background of a shell Ctrl-C is ignored, by all that is started from there too.
signal.signal(signal.SIGINT, signal.default_int_handler)
