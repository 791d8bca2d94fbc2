"""Which test motions a human body can perform: within its joints' limits, and without falling over.

``benchmarks/possible_motions.py`` prints them all; what is missed is the worst of all frames.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import motions
import numpy as np
from motions.doors import DOORS
from motions.encounters import ENCOUNTERS
from motions.uses import USES
from motions.whole import WHOLE

from capar.body.anthropometry import measures_of
from capar.body.human import Human
from capar.body.scripts import SIDES
from capar.model.capture import Capture
from virtual_bodies.following import Course, Follow, Follower, chosen_frames, followed

NEAR_M, NEAR_RAD = 0.010, float(np.radians(10.0))
"""A motion is possible if nothing is missed by more [m, rad]: by skin, and by another grip."""

FASTEST_RADPS = 25.0
"""... and no joint is faster [rad/s]: elbows of throwers reach about forty."""

BESIDE_M = 0.0
"""... and the centre of mass is no further than this beyond the soles that bear weight [m]."""

PLACES = (
    (0.0, 0.0), (0.15, 0.0), (-0.15, 0.0), (0.0, 0.15), (0.0, -0.15), (0.15, 0.15), (0.15, -0.15),
    (-0.15, 0.15), (-0.15, -0.15),
)  # fmt: skip
"""Where the feet may stand, of which a motion that does not track them tells nothing [m]."""

ARMS = (
    {"shoulder_abduction": 70.0, "elbow_flexion": 90.0},
    {"shoulder_flexion": 60.0, "elbow_flexion": 60.0},
    {"shoulder_flexion": -30.0, "elbow_flexion": 120.0},
    {"shoulder_flexion": 60.0, "shoulder_rotation": 50.0, "elbow_flexion": 90.0},
)
"""Other postures of the arms from which a place is tried to be met [degrees]."""

PUBLISHED = (
    motions.drink_from_mug, motions.touch_from_rest, motions.touch_cycle, motions.slide_object,
    motions.pick_up_with_both_hands, motions.hit, motions.touch_with, motions.move_obj,
    motions.move_obj_to, motions.resume_posture, motions.touch, motions.roll_object,
    motions.stand_on_one_leg,
)  # fmt: skip
ACTS: tuple[Callable[..., motions.Trial], ...] = (*PUBLISHED, *USES, *ENCOUNTERS, *DOORS, *WHOLE)
"""All that one person does; ``hand_over``, of two people, is not judged."""


@dataclass(frozen=True)
class Missed:
    """How well a body follows a motion, at worst."""

    metres: float
    radians: float
    what: str
    """Where it is missed by most, and when [s]."""

    frame: int
    """Which frame that is."""

    fastest_radps: float
    beside_m: float = 0.0
    """How far the centre of mass is beyond the soles that bear weight [m]; negative above them."""

    stands: tuple[float, float] = (0.0, 0.0)
    """Where the feet, which are not tracked, stay throughout, from the motion's origin [m]."""

    falls: bool = False
    """Whether it is possible for a body that may fall over, if it is not possible."""

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why it is not possible, in words."""
        out = []
        if self.metres > NEAR_M or self.radians > NEAR_RAD:
            far, turned = f"{1e3 * self.metres:.0f} mm", f"{np.degrees(self.radians):.0f} degrees"
            out.append(f"{self.what} is missed, by {far} and {turned} at worst")
        if self.fastest_radps > FASTEST_RADPS:
            out.append(f"a joint turns at {self.fastest_radps:.0f} rad/s")
        if self.beside_m > BESIDE_M:
            out.append(f"the weight is {1e3 * self.beside_m:.0f} mm beside the soles")
        return (*out, *["only who fell over could do it"] * self.falls) if out else ()

    @property
    def possible(self) -> bool:
        return not self.reasons


def missed(capture: Capture) -> Missed:
    """How well the body of a capture's first agent can do what its sensors did.

    Feet that are not tracked stay where they are, and the weight stays above those that bear it.
    Where the way from the first posture on is not possible, others are tried: from other places to
    stand, and then over other postures of the arm at the moment at which most was missed.
    """
    human = Human.of(measures_of(capture.agent))
    wanted = list(followed(capture, human))
    times = capture.times[chosen_frames(capture)]
    follower = Follower(times, human, wanted, PLACES[0])
    course = follower.run(0, follower.rest)
    assert course is not None
    first = judged(course, wanted, PLACES[0])
    if first.possible:
        return first
    for other in _others(times, human, wanted, first.frame):
        if other.possible:
            return other
    falling = Follower(times, human, wanted, PLACES[0], balanced=False)
    course = falling.run(0, falling.rest)
    assert course is not None
    unbalanced = replace(judged(course, wanted, PLACES[0]), beside_m=0.0)
    return replace(first, falls=unbalanced.possible)


def _others(times: np.ndarray, human: Human, wanted: list[Follow], frame: int) -> Iterator[Missed]:
    """What is missed on the other ways, one after the other, but of those that were given up."""
    led = any(place.frame.endswith("_foot") for place in wanted)
    places = PLACES[:1] if led else PLACES
    enough = (NEAR_M, NEAR_RAD)
    for stands in places[1:]:
        follower = Follower(times, human, wanted, stands)
        course = follower.run(0, follower.rest, enough=enough)
        if course is not None:
            yield judged(course, wanted, stands)
    for stands in places:
        follower = Follower(times, human, wanted, stands)
        for arm in ARMS:
            angles = {f"{s}_{n}": float(np.radians(a)) for n, a in arm.items() for s in SIDES}
            posture = human.posture(angles, place=(*stands, 0.0))
            course = follower.run(frame, posture, enough=enough)
            if course is not None:
                yield judged(course, wanted, stands)


def judged(course: Course, wanted: list[Follow], stands: tuple[float, float]) -> Missed:
    """The worst of a course."""
    if not wanted:
        return Missed(0.0, 0.0, "nothing of the body is tracked", 0, 0.0)
    errors = course.errors
    relative = np.maximum(errors[..., 0] / NEAR_M, errors[..., 1] / NEAR_RAD)
    frame, place = np.unravel_index(int(relative.argmax()), relative.shape)
    steps_s = np.diff(course.times)[:, None]
    speeds = np.abs(np.diff(course.postures[:, 7:], axis=0)) / steps_s
    return Missed(
        float(errors[..., 0].max()),
        float(errors[..., 1].max()),
        f"{wanted[place].frame} at {course.times[frame]:.2f} s",
        int(frame),
        float(speeds.max(initial=0.0)),
        float(course.beside.max()),
        stands,
    )
