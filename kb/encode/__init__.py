"""From an observation to statements, and facts back."""

from kb.encode.observation import encode as encode
