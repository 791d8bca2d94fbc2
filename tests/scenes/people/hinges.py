"""Virtual bodies whose hinges turn: what their stance foot stands on decides where they go."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.performing import RELAXED
from capar.body.scripts import SIDES
from scenes.hands.paths import Times, min_jerk
from scenes.people.stage import PeopleStage
from scenes.people.virtual import RATE_HZ, Figure, figure, human


@dataclass(frozen=True)
class Bend:
    """A hinge that turns by an angle [degrees] from rest to rest between two times [s]."""

    joint: str
    start: float
    end: float
    angle: float


@dataclass(frozen=True)
class Sway:
    """A hinge that swings about where it is by an angle [degrees], so many times."""

    joint: str
    start: float
    rate_hz: float
    cycles: int
    angle: float

    @property
    def end(self) -> float:
        """When it has swung [s]."""
        return self.start + self.cycles / self.rate_hz


def moved(
    s: PeopleStage, who: str, end: float, acts: Sequence[Bend | Sway], *, stance: str = "right"
) -> Figure:
    """A body that stands on a foot and turns hinges; what it stands on decides where it goes.

    Args:
        s: The stage.
        who: ``man``, ``woman`` or ``child``.
        end: When it is over [s].
        acts: What hinges do; they are added up.
        stance: The foot that stays where it is.
    """
    body = human(who)
    times = np.arange(0.0, end + 0.5 / RATE_HZ, 1.0 / RATE_HZ)
    easy = {f"{side}_{name}": float(np.radians(a)) for name, a in RELAXED.items() for side in SIDES}
    easy = {name: angle for name, angle in easy.items() if "knee" not in name}
    motion = np.tile(body.posture(easy), (len(times), 1))
    for each in acts:
        motion[:, body.index(each.joint)] += np.radians(_angles(each, times))
    assert not body.outside(motion).any()
    foot = f"{stance}_foot"
    places, turns = body.sites(motion, [foot])[foot]
    own = RigidTransform.from_components(places, Rotation.from_quat(turns, scalar_first=True))
    root = RigidTransform.from_components(
        motion[:, :3], Rotation.from_quat(motion[:, 3:7], scalar_first=True)
    )
    kept = own[0] * own.inv() * root
    motion[:, :3] = kept.translation
    motion[:, 3:7] = kept.rotation.as_quat(scalar_first=True)
    seen = figure(s, who, times, motion)
    seen.phases.append((0.0, float(times[-1])))
    return seen


def _angles(act: Bend | Sway, times: Times) -> Times:
    if isinstance(act, Bend):
        return np.asarray(act.angle * min_jerk((times - act.start) / (act.end - act.start)))
    since = times - act.start
    inner = np.minimum(since, act.end - times) * 2.0 * act.rate_hz
    wave = min_jerk(inner) * np.sin(2.0 * np.pi * act.rate_hz * since)
    return np.asarray(act.angle * np.where((since > 0) & (times < act.end), wave, 0.0))


def both(joint: str, start: float, end: float, angle: float) -> list[Bend]:
    """The same turn of a hinge at both sides."""
    return [Bend(f"{side}_{joint}", start, end, angle) for side in SIDES]
