"""When motions are told to begin and end, against when the things of the scenes truly did.

``python benchmarks/edges.py [--rates 30 100 240] [--noises 0 0.5 1.5] [--draws 1] [--every 16]
[--worst 10] [--json]``; ``--draws 3 --every 1`` takes all scenes.

Every mobile thing of the batteries' scenes moves in closed form: its edge is the first or last
instant at which that form moves it at all. The same path is sampled at each rate [Hz], with each
noise [mm] (rotations have a fifth of a degree for each millimetre), in each draw, and measured
alone. Errors stand by rate and noise, and by kind: how long the thing takes from its edge to the
floor of motion (at once: under 0.05 s, quick: under 0.2 s, slow), at the begin and at the end.
``kept`` asks of the same edge how far it is from that of 100 Hz and 0.5 mm in draw 0.
"""

import argparse
import json
import sys
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Stream, TagObject, TagType
from extractors.bodies.poses import poses_of
from extractors.motion.motion_edges import motion_edges
from extractors.motion.object_motion import motion_floor, moving, rest_poses
from extractors.signals.intervals import frame_rate
from extractors.thresholds import Thresholds

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from scenes.batteries import SCENES
from scenes.hands.paths import Body
from scenes.hands.stage import Noise

LIMITS = Thresholds()
NEAR_S = 0.05
"""An edge is right when it is no further from the truth [s] (spec 10)."""

FINE_HZ = 1000.0
"""At this rate the closed form is asked when it moves [Hz]."""

STANDS_M = 1e-9
"""A thing stands while it moves less from one such instant to the next [m]: rounding."""

KINDS = (("at once", 0.05), ("quick", 0.2), ("slow", float("inf")))
USUAL = (100.0, 0.5, 0)


@dataclass(frozen=True)
class Track:
    """A thing's true path, finely."""

    name: str
    body: Body
    duration_s: float
    motions: tuple[tuple[float, float], ...]
    """Begin and end of each true motion [s]."""


@dataclass(frozen=True)
class Edge:
    """One edge as it was told, beside the truth."""

    thing: str
    side: str
    kind: str
    rate_hz: float
    noise_mm: float
    draw: int
    true_s: float
    error_s: float
    """Told less true [s]."""


def paths(every: int) -> Iterator[Track]:
    """The mobile things of one scene in so many."""
    for name, scene in list(SCENES.items())[::every]:
        stage = scene.stage
        for thing in stage.things:
            if thing.tag is TagType.MOBILE:
                motions = true_motions(thing.body, stage.duration_s)
                if motions:
                    yield Track(f"{name}: {thing.name}", thing.body, stage.duration_s, motions)


def true_motions(body: Body, duration_s: float) -> tuple[tuple[float, float], ...]:
    """Begin and end of each motion of a closed form; rests shorter than a rest's least are none."""
    times = np.arange(round(duration_s * FINE_HZ) + 1) / FINE_HZ
    poses = body.poses(times)
    # A tenth of a metre off its pivot it moves by turning, too.
    points = np.concatenate([poses[:, :3, 3], *(0.1 * poses[:, :3, axis] for axis in range(3))], 1)
    stands = np.abs(np.diff(points, axis=0)).max(axis=1) < STANDS_M
    least = round(LIMITS.rest_minimum_s * FINE_HZ)
    for first, last in geometry.runs(stands):
        if last - first + 1 < least and first > 0 and last < len(stands) - 1:
            stands[first : last + 1] = False
    return tuple((float(times[a]), float(times[b + 1])) for a, b in geometry.runs(~stands))


def recorded(path: Track, rate_hz: float, noise_mm: float, draw: int) -> TagObject:
    """The thing as a tracker records it."""
    times = np.arange(round(path.duration_s * rate_hz) + 1) / rate_hz
    random = np.random.default_rng([draw, sum(map(ord, path.name))])
    noise = Noise(noise_mm / 1000.0, float(np.radians(0.2 * noise_mm)))
    poses = noise.added(path.body.poses(times), random)
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_quat(scalar_first=True)
    return TagObject(path.name, TagType.MOBILE, Stream(times, poses[:, :3, 3], turns))


def edges(path: Track, rate_hz: float, noise_mm: float, draw: int) -> Iterator[Edge]:
    """Each edge that is told of a thing in one recording, beside the true one."""
    poses = poses_of(recorded(path, rate_hz, noise_mm, draw), LIMITS)
    floor = motion_floor(poses.noise, frame_rate(poses.filled.times), own_m=None, thresholds=LIMITS)
    rests = rest_poses(poses, floor, LIMITS)
    times = poses.filled.times
    for core in moving(poses, rests, floor, LIMITS):
        told = times[list(motion_edges(poses, core, rests, floor, LIMITS))]
        for side, at, mine in (("begin", core[0], told[0]), ("end", core[1], told[1])):
            true = _true(path, side, float(times[at]))
            if true is not None and 0.0 < true < times[-1]:
                kind = _kind(path, side, true)
                yield Edge(path.name, side, kind, rate_hz, noise_mm, draw, true, float(mine) - true)


def _true(path: Track, side: str, inside_s: float) -> float | None:
    """The edge of the true motion under way at an instant, or nearest to it."""
    away = [max(begin - inside_s, inside_s - end, 0.0) for begin, end in path.motions]
    nearest = int(np.argmin(away))
    return path.motions[nearest][0 if side == "begin" else 1] if away[nearest] < 0.1 else None


def _kind(path: Track, side: str, true_s: float) -> str:
    """How long it takes from its edge to the floor of motion."""
    way = 1.0 if side == "begin" else -1.0
    times = true_s + way * np.arange(0.0, 1.0, 0.005)
    poses = path.body.poses(times)
    far = np.linalg.norm(poses[:, :3, 3] - poses[0, :3, 3], axis=1) / LIMITS.motion_floor_m
    turns = Rotation.from_matrix(poses[0, :3, :3]).inv() * Rotation.from_matrix(poses[:, :3, :3])
    away = np.flatnonzero(np.maximum(far, turns.magnitude() / LIMITS.motion_floor_rad) > 1.0)
    took_s = 0.005 * int(away[0]) if away.size else float("inf")
    return next(name for name, most in KINDS if took_s <= most)


def table(found: Iterable[Edge]) -> list[dict[str, str | int | float]]:
    """A row for each rate, noise, side and kind."""
    found = list(found)
    usual = {_place(edge): edge.error_s for edge in found if _way(edge) == USUAL}
    sides, kinds = ("begin", "end", "both"), (*(name for name, _ in KINDS), "all")
    ways = sorted({(edge.rate_hz, edge.noise_mm) for edge in found})
    rows = []
    for way, side, kind in product([*ways, None], sides, kinds):
        some = [
            edge
            for edge in found
            if way in (None, (edge.rate_hz, edge.noise_mm))
            and side in ("both", edge.side)
            and kind in ("all", edge.kind)
        ]
        if some:
            rows.append(_row(way, side, kind, some, usual))
    return rows


def _row(
    way: tuple[float, float] | None,
    side: str,
    kind: str,
    some: list[Edge],
    usual: dict[tuple[str, str, float], float],
) -> dict[str, str | int | float]:
    errors = np.array([edge.error_s for edge in some])
    kept = np.array(
        [abs(edge.error_s - usual[_place(edge)]) for edge in some if _place(edge) in usual]
    )
    return {
        "rate_hz": way[0] if way else "any",
        "noise_mm": way[1] if way else "any",
        "side": side,
        "kind": kind,
        "edges": len(some),
        "right_percent": share(errors),
        "kept_percent": share(kept),
        "median_ms": round(1000.0 * float(np.median(errors))),
        "p90_abs_ms": round(1000.0 * float(np.quantile(np.abs(errors), 0.9))),
    }


def share(errors_s: Float[np.ndarray, "edges"]) -> float:
    """Errors within 50 ms [%]."""
    return (
        round(100.0 * float(np.mean(np.abs(errors_s) <= NEAR_S + 1e-9)), 1)
        if len(errors_s)
        else 0.0
    )


def _place(edge: Edge) -> tuple[str, str, float]:
    return edge.thing, edge.side, edge.true_s


def _way(edge: Edge) -> tuple[float, float, int]:
    return edge.rate_hz, edge.noise_mm, edge.draw


def main() -> None:
    """Print the errors by rate and noise, and by kind."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rates", type=float, nargs="+", default=[30.0, 100.0, 240.0])
    parser.add_argument("--noises", type=float, nargs="+", default=[0.0, 0.5, 1.5])
    parser.add_argument("--draws", type=int, default=1)
    parser.add_argument("--every", type=int, default=16, help="one scene in so many")
    parser.add_argument("--worst", type=int, default=0, help="how many of the worst are told")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    ways = [
        (rate, noise, draw)
        for rate, noise in product(options.rates, options.noises)
        for draw in (range(options.draws) if noise else (0,))
    ]
    ways += [USUAL] if USUAL not in ways else []
    found = [edge for path in paths(options.every) for way in ways for edge in edges(path, *way)]
    rows = table(found)
    worst = sorted(found, key=lambda edge: -abs(edge.error_s))[: options.worst]
    if options.json:
        print(json.dumps({"rows": rows, "worst": [asdict(edge) for edge in worst]}, indent=1))
        return
    print("  ".join(f"{name:>13}" for name in rows[0]))
    for row in rows:
        print("  ".join(f"{value!s:>13}" for value in row.values()))
    for edge in worst:
        print(edge)


if __name__ == "__main__":
    main()
