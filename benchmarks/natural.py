"""Regenerated motions beside those of people who reach and carry, and pictures of both.

``python benchmarks/natural.py [ACTION ...] [--pictures FOLDER]``: speeds, accelerations and jerk of
joints and hands, how fast elbows swing about the line from shoulder to hand, how far feet slide,
and how long before the hand comes somewhere it is looked there. ``all`` are ten actions. People
are bodies fitted to the recordings of others, where these are.
"""

import argparse
import os
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scene
from jaxtyping import Float
from PIL import Image, ImageChops, ImageOps
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

from capar.body.body_fitting import fit_body
from capar.body.gaze_control import lines_of_sight
from capar.body.human import Human
from capar.body.scripted_actions import action_capture
from capar.body.sensor_fitting import Fit
from capar.pipelines.round_trips import body, observed_source
from capar.regeneration.captures import capture_of
from capar.regeneration.motion import Motion
from capar.regeneration.scenes import Scene
from capar.regeneration.search import regenerate
from capar.views.viewer.snapshot import EYE, snapshot
from capar.views.viewer.stage import Stage, StagedBody, body_parts, is_ground, stage
from extractors.readers.bundle.capture_toml import read_capture

EXAMPLES = Path(__file__).parents[1] / "examples"
AGENTS = ("man", "woman", "child")
ACTIONS = ("sip", "touch", "touch_from_rest", "slide", "turn", "push", "pick_up", "carry", "drink",
           "pour")  # fmt: skip
RATE_HZ = 30.0
CUTOFF_HZ = 6.0  # Everything is filtered so before it is derived, as recordings have noise [Hz].
MOVING_MPS = 0.05  # A hand that is slower than this is at rest [m/s].
BENT_M = 0.03  # An elbow that is nearer to the line from shoulder to hand swings about nothing [m].
LOOKED_RAD = float(np.radians(12.0))  # What is nearer to the line of sight is looked at [rad].
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
    """How long before the hand comes to where it goes it is looked there for good [s]."""


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
    where = human.sites(postures, {*names, "right_foot", "left_foot"})
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
    leads = []
    for side, frame in goals:
        spots, ways = lines_of_sight(human, postures[: frame + 1])
        aims = where[f"{side}_hand"][0][frame] - spots
        off = np.arccos((aims * ways).sum(axis=1) / np.linalg.norm(aims, axis=1))
        away = np.flatnonzero(off > LOOKED_RAD)
        leads.append((frame - (int(away[-1]) + 1 if len(away) else 0)) / rate_hz)
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
        reaches.append(_of_fit(made))
    yield "people reaching (smartbody_mocap_reaching)", reaches
    for file in sorted((folder / "omomo_intermimic" / "npz").glob("sub2_*.npz")):
        made = _fitted(f"{EXAMPLES / 'omomo_intermimic' / 'capture.toml'}:{file.stem}")
        carries.append(_of_fit(made))
    yield "people carrying (omomo_intermimic)", carries


def _fitted(place: str) -> Fit:
    return fit_body(place, read_capture(place))


def _of_fit(made: Fit) -> Measured:
    rate_hz = (len(made.times) - 1) / float(made.times[-1] - made.times[0])
    return measured(made.human, made.motion, rate_hz, ())


def of_motion(motion: Motion) -> Measured:
    """Of a regenerated motion."""
    source = motion.plan.source
    goals = [(hold.side, hold.first) for hold in source.holds if hold.first > 0]
    return measured(motion.plan.human, motion.postures, source.rate_hz, goals)


def staged(motion: Motion) -> Stage:
    """A regenerated motion as it is shown: the body with its fingers, and the objects."""
    source = motion.plan.source
    shown = stage(capture_of(motion, name=source.capture.name, agent=""))
    human, postures = motion.fingered
    parts = body_parts(human, postures[np.searchsorted(source.times, shown.times)])
    return bodies_alone(replace(shown, bodies=(*shown.bodies, *parts)))


def bodies_alone(shown: Stage) -> Stage:
    """The stage without sensors and floors."""
    kept = (b for b in shown.bodies if b.kind not in {"sensor", "looks", "self"})
    return replace(shown, bodies=tuple(b for b in kept if not is_ground(b)))


WIDE, TALL, COLOURS, TITLE = 300, 320, 48, 0.07
"""Width and height of one moment, how many colours a sheet has, and the share of the height of a
picture that its title has [1]."""

ABREAST_M = 0.25  # Between performers who are drawn beside each other [m].


def abreast(shown: Sequence[tuple[Stage, float, Scene]]) -> Stage:
    """Performers beside each other at their times [s], to one scale and facing the same way."""
    bodies, edge_m = list[StagedBody](), 0.0
    across = np.cross([0.0, 0.0, 1.0], EYE) / np.hypot(*EYE[:2])
    for own, time_s, where in shown:
        frame, turn = own.nearest(time_s), Rotation.from_euler("z", -where.heading)
        origin, placed = np.array([*where.place, where.floor_m]), list[StagedBody]()
        for one in (one for one in own.bodies if not np.isnan(one.positions[frame, 0])):
            turned = turn * Rotation.from_quat(one.orientations[[frame]], scalar_first=True)
            spots = turn.apply(one.positions[[frame]] - origin)
            ways = turned.as_quat(scalar_first=True)
            placed.append(replace(one, positions=spots, orientations=ways))
        corners = np.concatenate([_corners(one) @ across for one in placed])
        by = (edge_m - corners.min()) * across
        bodies += [replace(one, positions=one.positions + by) for one in placed]
        edge_m += float(np.ptp(corners)) + ABREAST_M
    return Stage("", np.zeros(1), tuple(bodies))


def _corners(one: StagedBody) -> np.ndarray:
    """Corners of a body's surface in the world at the first frame [m]."""
    if one.shape is None:
        return one.positions[:1]
    turn = Rotation.from_quat(one.orientations[0], scalar_first=True)
    return np.asarray(turn.apply(np.array(one.shape.vertices)) + one.positions[0])


def sheet(
    rows: Sequence[tuple[Stage, Sequence[float]]],
    path: Path,
    *,
    cell: tuple[int, int] = (WIDE, TALL),
) -> None:
    """Moments of several performers in a picture: a row each, from left to right in time [s]."""
    most = max(len(moments) for _, moments in rows)
    wide, tall = cell
    page = Image.new("RGB", (wide * most, tall * len(rows)), "white")
    for down, (shown, moments) in enumerate(rows):
        drawn = [_drawn(shown, float(time_s)) for time_s in moments]
        boxes = np.array([ImageChops.invert(one).getbbox() for one in drawn])
        box = (*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0))
        for across, one in enumerate(drawn):
            small = ImageOps.contain(one.crop(box), (wide - 12, tall - 12))
            corner = np.array([across, down]) * cell + 6
            page.paste(small, tuple(int(each) for each in corner))
    page.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def _drawn(shown: Stage, time_s: float) -> Image.Image:
    """A moment, without its title."""
    with tempfile.NamedTemporaryFile(suffix=".png") as file:
        snapshot(shown, time_s, Path(file.name))
        made = Image.open(file.name).convert("RGB")
    return made.crop((0, round(TITLE * made.height), made.width, made.height))


def main() -> None:
    """Print the table, and draw what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("actions", nargs="*", metavar="ACTION", help=", ".join(("all", *ACTIONS)))
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="one for each action")
    asked = parser.parse_args()
    actions = asked.actions or ["touch", "drink"]
    print("95 % of frames, worst; joints in rad/s and its derivatives, hands in m/s likewise")
    print("| who | motions | joint speed | acceleration | jerk | hand speed | acceleration | jerk "
          "| swing of elbows [deg/s] | feet [mm] | gaze before hand, least [s] |")  # fmt: skip
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
