"""Observation while it happens: frames in, segments out, provisional first and settled soon.

``LiveObserver`` measures a sliding window and asks the rules about it: segments are provisional
0.4 s after their end, settled 0.5 to 0.75 s after it, and not changed then while the recording goes
on. ``finish`` observes the whole recording, whose frames lie on disk, with the same calibration:
the result is that of the offline run, byte for byte.

Later is settled what later frames may decide (``undecided``): whether a hand takes what it touches
or who takes over an object (2 s), whether a contact goes on while bodies stay near (0.9 s) or one
is out of sight (2 s), whether what has begun to move goes on (0.2 s), where an object came to rest
(0.7 s). Purposes that nobody states are announced with the action that follows.
"""
