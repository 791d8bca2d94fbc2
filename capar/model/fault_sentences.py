"""Sentences of notices about faults of a recording, each with what to state instead.

Texts are templates over the bodies by number and the other fields by name.
"""

from collections.abc import Mapping, Sequence
from typing import Any

ORDER_CONTRADICTED = (
    "{0} and {1} turn as one, but with quaternions read as {declared} {1} strays by "
    "{stray_m:g} m in the frame of {0}, as in {stretches} stretches of a second; as {order} it "
    'does not: state order = "{order}"'
)

FALL_RATE = (
    "{0!r} falls with {acceleration_mps2:g} m/s2 from {start_s:.2f} to {end_s:.2f} s, not with "
    "9.81: frames came at {rate_hz:g} a second, not at {declared_hz:g}; state rate_hz = "
    "{rate_hz:g} for its file, or correct its time stamps"
)

SHAPE_SIZE = (
    "the shape of {0!r}, {shape}, is {size_m:g} m long, and {0!r} is moved by hand: state "
    'unit = "{unit}" in its shape'
)

SIDES_EXCHANGED = (
    "{0!r} is on the left of {1!r} as {2!r} looks, in {share:.0%} of what shows their sides: "
    'exchange the names, correct the gaze of {2!r}, or state handedness = "left" if the file '
    "has a left-handed world (the other way round if it is stated)"
)


def up_contradicted(bodies: Sequence[str], fields: Mapping[str, Any]) -> str:
    """Gravity or rests that the declared upward axis does not fit."""
    if fields["shown"] == "rest":
        found = f"{bodies[0]!r} rests {fields['where']} {bodies[1]!r}, with nothing under it"
    else:
        found = (
            f"{bodies[0]!r} falls freely from {fields['start_s']:.2f} to {fields['end_s']:.2f} s, "
            f"{fields['angle_deg']:.0f} degrees off the declared down"
        )
    if not fields["up"]:
        return f"{found}; no axis of its file points up: level the world before it is read"
    remedy = f'state up = "{fields["up"]}" for its file'
    return f'{found}: {remedy}, which was read with "{fields["declared"]}"'


def unit_contradicted(bodies: Sequence[str], fields: Mapping[str, Any]) -> str:
    """Lengths that no person has, and falls by another acceleration than gravity's."""
    if fields["shown"] == "person":
        first, second = bodies
        found = f"{first!r} and {second!r} of one person are {fields['size_m']:g} m apart at most"
    elif fields["shown"] == "speed":
        found = f"{bodies[0]!r} is faster than {fields['speed_mps']:g} m/s for a tenth of the time"
    else:
        found = (
            f"{bodies[0]!r} falls with {fields['acceleration_mps2']:g} m/s2 from "
            f"{fields['start_s']:.2f} to {fields['end_s']:.2f} s, not with 9.81"
        )
    remedy = f'state unit = "{fields["unit"]}" for its file'
    return f"{found}: {remedy}, which was read in {fields['declared']}"


def distance_contradicted(bodies: Sequence[str], fields: Mapping[str, Any]) -> str:
    """A stated distance that sure contact does not fit."""
    first, second = bodies
    taken, shown = (1e3 * float(fields[name]) for name in ("touch_m", "shown_m"))
    return (
        f"{first!r} and {second!r} are stated to touch within {taken:.0f} mm, but "
        f"{fields['frames']} frames of sure contact show {shown:.0f} mm; "
        "state that, or leave distance_m out"
    )


def mount_gap(bodies: Sequence[str], fields: Mapping[str, Any]) -> str:
    """Surfaces that do not meet where one body carries another."""
    first, second = bodies
    gap, taken = (1e3 * float(fields[name]) for name in ("shown_m", "touch_m"))
    return (
        f"{first!r} carries {second!r} steadily in {fields['frames']} frames with a gap of "
        f"{gap:.0f} mm, but surfaces touch within {taken:.0f} mm: a mount, a mesh or a fit is off"
    )


WHY_UNMOVED: Mapping[str, str] = {
    "nobody": "nothing that is recorded was near and went with it: is a sensor missing, is the "
    "unit of a file wrong, or was it tracked wrongly?",
    "beyond_reach": "something went with it beyond reach: is a mount, a distance or a unit wrong?",
    "left_behind": "what touched it rested meanwhile: is a distance of contact too large, or a "
    "sensor missing?",
}
"""What would explain that nothing moves an object, by what the rules found."""


def no_mover(bodies: Sequence[str], fields: Mapping[str, Any]) -> str:
    """Motion that nothing explains."""
    share = 100.0 * float(fields["share"])
    often = "" if fields["times"] == 1 else f", the longest of {fields['times']} times"
    return (
        f"nothing moves {bodies[0]!r} in {share:.1f} % of its motion, from {fields['start_s']:.2f} "
        f"to {fields['end_s']:.2f} s{often}; {WHY_UNMOVED[str(fields['why'])]}"
    )
