"""From an observation to statements: one file a kind of thing."""

from kb.encode.observation import encode as encode
