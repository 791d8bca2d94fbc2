"""Round trips of actions on three bodies in drawn scenes: what comes out, and how good.

Run as ``PYTHONPATH=.:tests python benchmarks/regeneration.py ACTION ...``. With ``--results FILE``
each trip is added to that file when it is done, and those that are in it already are not done
again; ``--search`` then tries what was refused by an independent search; ``--table`` sums it up.
"""

import argparse
import json
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from reach_search import search
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.scripted_actions import ACTIONS, action_capture
from capar.pipelines.round_trips import (
    SAME,
    Trip,
    body,
    numbered_scene,
    observed_source,
    round_trip,
)
from capar.regeneration.motion import Motion
from capar.regeneration.scenes import DRAWS, Scene
from capar.regeneration.sources import Source

AGENTS = ("man", "woman", "child")
SEED = 7
RATE_HZ = 30.0
KEY = ("action", "agent", "scene", "rules", "draw")
"""What tells a trip from others."""

Row = dict[str, Any]


def rows(options: argparse.Namespace, before: list[Row]) -> Iterator[Row]:
    """What came of each trip that is not done yet."""
    done = {_key(row) for row in before}
    bodies: dict[str, Human] = {}
    for action in options.actions or ACTIONS:
        source: Source | None = None
        for number in options.scenes:
            for agent in options.agents:
                key = (action, agent, number, options.rules, options.draw)
                if key not in done:
                    source = source or _source(action, options.rules)
                    human = bodies.setdefault(agent, body(agent, source))
                    scene = numbered_scene(source, number, SEED, DRAWS[options.draw])
                    made = tried(source, agent, human, number, scene)
                    yield dict(zip(KEY, key, strict=True)) | made


def searched(some: list[Row]) -> Iterator[Row]:
    """Trips with what an independent search says of them."""
    for row in some:
        if row["solved"] is None:
            source = _source(row["action"], row["rules"])
            scene = numbered_scene(source, row["scene"], SEED, DRAWS[row["draw"]])
            found = search(source, scene, body(row["agent"], source))
            yield row | {"solved": found.solved, "search": found.sentence}


@cache
def _source(action: str, rules: str) -> Source:
    return observed_source(action_capture(action, rate_hz=RATE_HZ), rules=rules)


def _key(row: Row) -> tuple[Any, ...]:
    return tuple(row[name] for name in KEY)


def tried(source: Source, agent: str, human: Human, number: int, scene: Scene) -> Row:
    """One trip as plain values."""
    began = time.process_time()
    trip = round_trip(source, agent, human, number, scene)
    seconds = time.process_time() - began
    if agent == SAME and not number and trip.motion:
        print("from the recorded paths [mm], planned and performed:", off_paths(trip.motion))
    times = {"seconds": round(seconds, 1), "motion_s": float(source.times[-1])}
    return told(trip) | times | {"solved": None, "search": "not searched"}


def off_paths(motion: Motion) -> dict[str, tuple[float, float]]:
    """How far hands and things are from where they were recorded, at worst [mm]."""
    plan = motion.plan
    out = {}
    for name, path in plan.source.paths.items():
        off = _apart(plan.things[name], path)
        out[name] = off, off
    sites = plan.human.sites(motion.postures, [f"{side}_palm" for side in plan.hands])
    for side, hand in plan.source.hands.items():
        palm = RigidTransform.from_components(
            sites[f"{side}_palm"][0],
            Rotation.from_quat(sites[f"{side}_palm"][1], scalar_first=True),
        )
        made = palm * plan.frames.palms[side].inv()
        out[f"{side} hand"] = _apart(plan.hands[side], hand.path), _apart(made, hand.path)
    return out


def _apart(one: RigidTransform, other: RigidTransform) -> float:
    off = np.linalg.norm(one.translation - other.translation, axis=1)
    return round(1e3 * float(off.max()), 1)


def told(trip: Trip) -> Row:
    """A trip as plain values."""
    gates = trip.quality.gates if trip.quality else ()
    return {
        "refused": trip.refused,
        "same_par": trip.same_par,
        "same_contacts": trip.same_contacts,
        "same_relations": trip.same_relations,
        "names": trip.names,
        "constraint_way_mm": next(
            (round(g.value, 3) for g in gates if g.name == "constraint way"), None
        ),
        "failed": [
            f"{g.name} {g.value:.2f} {g.unit} {g.bodies} at frame {g.frame}"
            for g in gates
            if not g.passed
        ],
    }


def line(row: Row) -> str:
    """One trip on one line."""
    head = f"{row['action']:8} {row['agent']:6} scene {row['scene']:2} {row['seconds']:5.1f} s  "
    if row["refused"]:
        return f"{head}not performed: {row['refused']}; {row['search']}"
    same = "same PAR" if row["same_par"] else f"another PAR ({row['names']})"
    if row["same_par"] and not row["same_contacts"]:
        same += ", other contacts"
    if row["same_par"] and not row["same_relations"]:
        same += ", other relations"
    return f"{head}{same}; {'; '.join(row['failed']) or 'every gate passed'}"


def table(found: list[Row]) -> str:
    """How many of each action and agent are in reach, the same PAR, and pass every gate."""
    names = "action, agent, asked, in reach, wrongly refused, same PAR, every gate, both"
    out = [f"| {names.replace(', ', ' | ')} |", "|---" * 8 + "|"]
    for action in [*dict.fromkeys(row["action"] for row in found), "all"]:
        for agent in (*AGENTS, "all"):
            some = [
                row
                for row in found
                if action in {row["action"], "all"} and agent in {row["agent"], "all"}
            ]
            if some:
                numbers = " | ".join(str(number) for number in counts(some))
                out.append(f"| {action} | {agent} | {numbers} |")
    return "\n".join(out)


def counts(some: list[Row]) -> tuple[int, ...]:
    """Asked, in reach, wrongly refused, same PAR, every gate, both."""
    done = [row for row in some if not row["refused"]]
    same = [row for row in done if row["same_par"]]
    good = [row for row in done if not row["failed"]]
    wrong = [row for row in some if row["refused"] and row["solved"]]
    both = [row for row in same if not row["failed"]]
    return len(some), len(done), len(wrong), len(same), len(good), len(both)


def read(path: Path | None) -> list[Row]:
    """The trips of a file of results, each as it was written last."""
    if path is None or not path.exists():
        return []
    found = [json.loads(text) for text in path.read_text("utf-8").splitlines()]
    return list({_key(row): row for row in found}.values())


def options() -> argparse.Namespace:
    """What is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("actions", nargs="*", metavar="ACTION", help=", ".join(ACTIONS))
    parser.add_argument(
        "--scenes", type=int, nargs="+", default=[1, 2], help="numbers; 0 as recorded"
    )
    parser.add_argument("--agents", nargs="+", default=list(AGENTS))
    parser.add_argument("--rules", default="extended", help="profile by which is observed")
    parser.add_argument(
        "--draw", choices=DRAWS, default="usual", help="ranges from which scenes are drawn"
    )
    parser.add_argument("--results", type=Path, help="file to which each trip is added")
    parser.add_argument("--search", action="store_true", help="try what was refused otherwise")
    parser.add_argument(
        "--validate", type=int, help="let the search try one in so many of what was performed"
    )
    parser.add_argument("--table", action="store_true", help="sum the results up, and do no more")
    return parser.parse_args()


def main() -> None:
    """Do what is asked for."""
    asked = options()
    before = read(asked.results)
    if asked.validate:
        performed = [row for row in before if not row["refused"]][:: asked.validate]
        found = [row["solved"] for row in searched(performed)]
        print(f"of {len(found)} that the planner performed the search solves {sum(found)}")
        return
    refused = [row for row in before if row["refused"]]
    if not asked.table:
        for row in searched(refused) if asked.search else rows(asked, before):
            print(line(row), flush=True)
            if asked.results:
                with asked.results.open("a", encoding="utf-8") as out:
                    out.write(json.dumps(row) + "\n")
            else:
                before.append(row)
    print(table(read(asked.results) if asked.results else before))


if __name__ == "__main__":
    main()
