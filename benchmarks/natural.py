"""Regenerated motions beside those of people who reach and carry, and pictures of both.

``python benchmarks/natural.py [ACTION ...] [--pictures FOLDER]``: speeds, accelerations and jerk of
joints and hands, how fast elbows swing about the line from shoulder to hand, how far feet slide,
and how long before the hand the face turns to where the hand goes. ``all`` are ten actions. People
are bodies fitted to the recordings of others, where these are.
"""

import argparse
import os
from collections.abc import Iterable, Iterator, Sequence
from io import BytesIO
from itertools import chain, pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scene
from jaxtyping import Float
from PIL import Image
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

from capar.body.body_fitting import fit_body
from capar.body.human import Human
from capar.body.scripted_actions import action_capture
from capar.body.sensor_fitting import Fit
from capar.pipelines.round_trips import body, observed_source
from capar.regeneration.captures import capture_of
from capar.regeneration.motion import Motion
from capar.regeneration.search import regenerate
from capar.views.viewer.snapshot import snapshot
from capar.views.viewer.stage import Stage, stage, with_mannequin
from extractors.readers.bundle.capture_toml import read_capture

EXAMPLES = Path(__file__).parents[1] / "examples"
AGENTS = ("man", "woman", "child")
ACTIONS = ("sip", "touch", "touch_from_rest", "slide", "turn", "push", "pick_up", "carry", "drink",
           "pour")  # fmt: skip
RATE_HZ = 30.0
CUTOFF_HZ = 6.0  # Everything is filtered so before it is derived, as recordings have noise [Hz].
MOVING_MPS = 0.05  # A hand that is slower than this is at rest [m/s].
BENT_M = 0.03  # An elbow that is nearer to the line from shoulder to hand swings about nothing [m].
FACED_RAD = float(np.radians(30.0))  # What is less far aside of the face is faced [rad].
WALKS_M = 0.1  # Feet that go further step [m].
SIDES = ("right", "left")


class Measured(NamedTuple):
    """Values of one motion, of both arms together, at frames in which their hands move."""

    joints: list[Float[np.ndarray, "frames 3"]]
    """Angular speed, acceleration and jerk of shoulder, elbow and wrist [rad/s, ...]."""

    hands: list[Float[np.ndarray, "frames 3"]]
    """Speed, acceleration and jerk of wrists [m/s, ...]."""

    swings: list[Float[np.ndarray, "frames"]]
    """Speed of elbows about the line from shoulder to hand [rad/s]."""

    slid_m: float
    leads_s: list[float]
    """How long before the hand comes to where it goes the face points there for good [s]."""


def derived(values: Float[np.ndarray, "frames 3"], rate_hz: float) -> Float[np.ndarray, "frames 3"]:
    """Lengths of the first three derivatives of a filtered path."""
    row, out = _filtered(values, rate_hz), []
    for _ in range(3):
        row = np.gradient(row, 1.0 / rate_hz, axis=0)
        out.append(np.linalg.norm(row, axis=1))
    return np.stack(out, axis=1)


def _filtered(values: np.ndarray, rate_hz: float) -> np.ndarray:
    return sosfiltfilt(butter(2, CUTOFF_HZ, fs=rate_hz, output="sos"), values, axis=0)


def measured(
    human: Human,
    postures: Float[np.ndarray, "frames posture"],
    rate_hz: float,
    goals: Iterable[tuple[str, int]],
) -> Measured:
    """What is measured of a motion; goals are sides of hands, and when they come there."""
    chain_of = ("thorax_upper", "upper_arm", "forearm", "hand")
    names = [name if name == chain_of[0] else f"{s}_{name}" for s in SIDES for name in chain_of]
    where = human.sites(postures, {*names, "between_eyes", "right_foot", "left_foot"})
    joints, hands, swings = [], [], []
    for at in (0, 4):
        own = names[at : at + 4]
        path = derived(where[own[3]][0], rate_hz)
        moves = path[:, 0] > MOVING_MPS
        hands.append(path[moves])
        turns = [Rotation.from_quat(where[name][1], scalar_first=True) for name in own]
        for upper, lower in pairwise(turns):
            local = upper.inv() * lower
            steps = (local[:-1].inv() * local[1:]).as_rotvec()
            turned = np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])
            joints.append(derived(turned, rate_hz)[moves])
        spots = [_filtered(where[name][0], rate_hz) for name in own[1:]]
        swings.append(_swing(*spots)[moves[1:]] * rate_hz)
    feet = (where[f"{side}_foot"][0] for side in SIDES)
    slid = max(float(np.linalg.norm(spots - spots[0], axis=1).max()) for spots in feet)
    spots, turned = where["between_eyes"]
    ahead = Rotation.from_quat(turned, scalar_first=True).apply([1.0, 0.0, 0.0])
    leads = []
    for side, frame in goals:
        aims = where[f"{side}_hand"][0][frame] - spots
        bearings = (np.arctan2(each[:, 1], each[:, 0]) for each in (aims, ahead))
        turned_rad = np.abs(np.remainder(np.subtract(*bearings) + np.pi, 2.0 * np.pi) - np.pi)
        away = np.flatnonzero(turned_rad[: frame + 1] > FACED_RAD)
        leads.append(float(frame - (away[-1] + 1 if len(away) else 0)) / rate_hz)
    return Measured(joints, hands, swings, slid, leads)


def _swing(shoulder: np.ndarray, elbow: np.ndarray, hand: np.ndarray) -> np.ndarray:
    """Angles that an elbow turns about the line from shoulder to hand, from frame to frame."""
    line = hand - shoulder
    line /= np.linalg.norm(line, axis=1, keepdims=True)
    off = elbow - shoulder
    off -= (off * line).sum(axis=1, keepdims=True) * line
    bent = np.linalg.norm(off, axis=1) > BENT_M
    one, two = off[:-1], off[1:]
    one = one - (one * line[1:]).sum(axis=1, keepdims=True) * line[1:]
    angles = np.arctan2((np.cross(one, two) * line[1:]).sum(axis=1), (one * two).sum(axis=1))
    return np.where(bent[:-1] & bent[1:], np.abs(angles), 0.0)


def line(name: str, found: Sequence[Measured]) -> str:
    """A row of the table: 95 % of frames, and the worst one."""
    cells = []
    for rows in (chain.from_iterable(each.joints for each in found),
                 chain.from_iterable(each.hands for each in found)):  # fmt: skip
        every = np.concatenate([*rows])
        cells += [f"{np.percentile(c, 95):.1f}, {c.max():.1f}" for c in every.T]
    swings = np.degrees(np.concatenate([s for each in found for s in each.swings]))
    cells.append(f"{np.percentile(swings, 95):.0f}, {swings.max():.0f}")
    slid_m = max(each.slid_m for each in found)
    cells.append("walk" if slid_m > WALKS_M else f"{1e3 * slid_m:.1f}")
    leads = [lead for each in found for lead in each.leads_s]
    cells.append(f"{np.median(leads):.2f}, {min(leads):.2f}" if leads else "-")
    return f"| {name} | {len(found)} | {' | '.join(cells)} |"


def people() -> Iterator[tuple[str, list[Measured]]]:
    """Those who reach and carry, as bodies fitted to their joints."""
    folder = Path(os.environ["CAPAR_DATA"])
    reaches, carries = [], []
    for file in sorted((folder / "smartbody_mocap_reaching" / "npz").glob("*.npz")):
        made = _fitted(f"{EXAMPLES / 'smartbody_mocap_reaching'}:{file.stem}")
        apex = int(np.argmin(np.abs(made.times - float(np.load(file)["apex_time"]))))
        reaches.append(_of_fit(made, [("right", apex)]))
    yield "people reaching (smartbody_mocap_reaching)", reaches
    for file in sorted((folder / "omomo_intermimic" / "npz").glob("sub2_*.npz")):
        made = _fitted(f"{EXAMPLES / 'omomo_intermimic' / 'capture.toml'}:{file.stem}")
        first = int(np.argmax(np.load(file)["contact_obj"] > 0))
        carries.append(_of_fit(made, [("right", first)]))
    yield "people carrying (omomo_intermimic)", carries


def _fitted(place: str) -> Fit:
    return fit_body(place, read_capture(place))


def _of_fit(made: Fit, goals: list[tuple[str, int]]) -> Measured:
    rate_hz = (len(made.times) - 1) / float(made.times[-1] - made.times[0])
    return measured(made.human, made.motion, rate_hz, goals)


def of_motion(motion: Motion) -> Measured:
    """Of a regenerated motion."""
    source = motion.plan.source
    goals = [(hold.side, hold.first) for hold in source.holds if hold.first > 0]
    return measured(motion.plan.human, motion.postures, source.rate_hz, goals)


def staged(motion: Motion) -> Stage:
    """A regenerated motion as it is shown: the body and the objects."""
    plan, times = motion.plan, motion.plan.source.times
    shown = stage(capture_of(motion, name=plan.source.capture.name, agent=""))
    shown = with_mannequin(shown, Fit(plan.human, times, motion.postures, {}, {}, {}, 0.0))
    return without_sensors(shown)


def without_sensors(shown: Stage) -> Stage:
    """The stage with bodies and objects alone."""
    bodies = tuple(b for b in shown.bodies if b.kind not in {"sensor", "looks", "self"})
    return Stage(shown.title, shown.times, bodies)


WIDE, TALL, COLOURS = 300, 233, 48
"""Width and height of one moment, and how many colours a sheet has [1]."""


def sheet(rows: Sequence[tuple[Stage, Sequence[float]]], path: Path) -> None:
    """Moments of several performers in a picture: a row each, from left to right in time [s]."""
    most = max(len(moments) for _, moments in rows)
    page = Image.new("RGB", (WIDE * most, TALL * len(rows)), "white")
    for down, (shown, moments) in enumerate(rows):
        for across, time_s in enumerate(moments):
            drawn = BytesIO()
            snapshot(shown, float(time_s), drawn)
            small = Image.open(drawn).convert("RGB").resize((WIDE, TALL), Image.Resampling.LANCZOS)
            page.paste(small, (WIDE * across, TALL * down))
    page.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def main() -> None:
    """Print the table, and draw what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("actions", nargs="*", metavar="ACTION", help=", ".join(("all", *ACTIONS)))
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="one for each action")
    asked = parser.parse_args()
    actions = asked.actions or ["touch", "drink"]
    print("95 % of frames, worst; joints in rad/s and its derivatives, hands in m/s likewise")
    print("| who | motions | joint speed | acceleration | jerk | hand speed | acceleration | jerk "
          "| swing of elbows [deg/s] | feet [mm] | face before hand, least [s] |")  # fmt: skip
    print("|---" * 11 + "|")
    if scene.recordings():
        for name, found in people():
            print(line(name, found), flush=True)
    made: dict[str, list[Measured]] = {agent: [] for agent in AGENTS}
    for action in ACTIONS if actions == ["all"] else actions:
        source, rows = observed_source(action_capture(action, rate_hz=RATE_HZ)), []
        for agent in AGENTS:
            motion, _ = regenerate(source, body(agent, source))
            made[agent].append(of_motion(motion))
            spans = [(hold.first + hold.last) / 2 for hold in source.holds[:1]]
            middle = source.times[round(spans[0])]
            first = source.times[source.holds[0].first]
            rows.append((staged(motion), (0.7 * first, middle, source.times[-1])))
        if asked.pictures:
            asked.pictures.mkdir(parents=True, exist_ok=True)
            sheet(rows, asked.pictures / f"{action}.png")
    for agent, found in made.items():
        print(line(f"regenerated by the {agent}", found), flush=True)


if __name__ == "__main__":
    main()
