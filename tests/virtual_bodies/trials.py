"""Virtual captures of a moving body, and how far a fit is from its truth."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.body.anthropometry import Measures, estimate_measures, ready_made
from capar.body.human import ROOT_SIZE, Human
from capar.body.sensor_fitting import Fit
from capar.body.sensors import Tracker, places, sense, strap_on
from capar.model.capture import Stream
from virtual_bodies.moving import swinging

RATE_HZ = 103.3
MEASURED = (
    "stature", "mass", "acromial_height", "cervicale_height", "thigh", "shank",
    "upper_arm", "forearm",
)  # fmt: skip
ARM = ("upper_arm", "forearm")
UNSEEN = ("eye", "knuckle", "finger", "thumb", "toe")


@dataclass(frozen=True, eq=False)
class Trial:
    """A body that moved, and what the tracker recorded of it."""

    human: Human
    times: Float[np.ndarray, "frames"]
    motion: Float[np.ndarray, "frames posture"]
    streams: dict[str, Stream]


def virtual_trial(
    who: str = "man",
    *,
    seed: int = 1,
    seconds: float = 4.0,
    tracker: Tracker | None = None,
    where: Iterable[str] | None = None,
) -> Trial:
    """Someone stands still for half a second, then swings every joint."""
    tracker = tracker or Tracker()
    human = Human.of(ready_made(who))
    times = np.arange(0.0, seconds, 1.0 / RATE_HZ)
    motion = swinging(human, times, seed)
    rng = np.random.default_rng(seed)
    mounts = strap_on(human, where or places(), tracker, rng)
    streams = sense(human, times, motion, mounts, tracker, rng)
    return Trial(human, times, motion, streams)


def measured(measures: Measures, *, arms: float = 1.0) -> Measures:
    """What someone with a tape measure would have taken down, arms off by a factor."""
    wrong = dict.fromkeys(ARM, arms)
    given = {name: measures[name] * wrong.get(name, 1.0) for name in MEASURED}
    return estimate_measures(sex=measures.sex, age=measures.age, given=given)


def guessed(measures: Measures, *, arms: float) -> Measures:
    """The same with arms that nobody measured: estimated, and off by a factor."""
    known = measured(measures)
    usual = estimate_measures(sex=measures.sex, age=measures.age)
    values = {**known.values, **{name: arms * measures[name] for name in ARM}}
    deviations = {**known.deviations, **{name: usual.deviations[name] for name in ARM}}
    return Measures(known.sex, known.age, values, known.given - set(ARM), deviations)


def palm_errors_m(trial: Trial, fit: Fit) -> Float[np.ndarray, "samples"]:
    """Distance of both palms from where they truly were [m]."""
    palms = ("right_palm", "left_palm")
    true, found = (
        h.sites(q, palms) for h, q in ((trial.human, trial.motion), (fit.human, fit.motion))
    )
    return np.concatenate([np.linalg.norm(true[p][0] - found[p][0], axis=1) for p in palms])


def joint_errors_rad(trial: Trial, fit: Fit) -> Float[np.ndarray, "frames hinges"]:
    """Error of every hinge that the sensors see [rad]."""
    seen = [n for n, joint in enumerate(fit.human.joints) if not any(u in joint for u in UNSEEN)]
    return (fit.motion - trial.motion)[:, ROOT_SIZE:][:, seen]


def rms(values: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
