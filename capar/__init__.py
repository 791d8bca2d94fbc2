"""Knowledge of what somebody did in a motion capture: observed, explained, stored and replayed."""

__version__ = "0.1.0"
