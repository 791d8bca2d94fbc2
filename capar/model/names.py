"""What sensors and objects may be called."""

import re

NAME = re.compile(r"[a-z][A-Za-z0-9_]*")
"""What sensors and objects may be called: such a name is a constant of the rules, unquoted."""
