"""Demonstrations of a simulator of others, judged by what that simulator itself says of each frame.

In an environment with robosuite 1.5 (``pip install robosuite h5py "mujoco<3.4"``):
``python benchmarks/demonstrations.py record FOLDER [--episodes 14] [--seed 0]`` writes a file for
each task: lift, stack, pick and place, open a door, by policies that follow a plan, some of them
disturbed. With the states stand, for each frame, the simulator's own checks: grasp, height, hinge,
success. PLANS states as which steps each policy's episodes should be named.

In ours: ``CAPAR_ASSETS=.../robosuite/models/assets python benchmarks/demonstrations.py judge
FOLDER [--json]`` observes them and prints F1 of the frames in hand, borders within 0.1 s, and the
share of episodes whose steps have the right names: those of the plan, in its order, and between
them only what the simulator shows as well, by its contacts and poses (``shown``). Disturbed
policies do brush and push. Without recordings nothing is done.
"""

import argparse
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

RELEASE = "ResumePosture|Withdraw"
PICK = ["Reach", "Lift"]
PLANS: dict[str, tuple[str, list[str]]] = {
    # policy: task, steps about its object; A|B either, A? may be missing
    "lift": ("Lift", PICK),
    "lift_noisy": ("Lift", PICK),
    "lift_hesitant": ("Lift", PICK),
    "lift_missed": ("Lift", PICK),
    "lift_pushed": ("Lift", PICK),
    "lift_back": ("Lift", [*PICK, "Lower|PutDown", RELEASE]),
    "lift_dropped": ("Lift", [*PICK, "Lower", "Drop", *PICK]),
    "stack": ("Stack", [*PICK, "Carry|MoveObj?", "Lower|PutDown", RELEASE]),
    "stack_noisy": ("Stack", [*PICK, "Carry|MoveObj?", "Lower|PutDown", RELEASE]),
    "stack_hesitant": ("Stack", [*PICK, "Carry|MoveObj?", "Lower|PutDown", RELEASE]),
    "place": ("PickPlaceCan", [*PICK, "Carry", "Lower|PutDown", RELEASE]),
    "place_noisy": ("PickPlaceCan", [*PICK, "Carry", "Lower|PutDown", RELEASE]),
    "place_hesitant": ("PickPlaceCan", [*PICK, "Carry", "Lower|PutDown", RELEASE]),
    "place_dropped": ("PickPlaceCan", [*PICK, "Carry", "Drop"]),
    "door": ("Door", ["Reach", "Open"]),
    "door_noisy": ("Door", ["Reach", "Open"]),
    "door_released": ("Door", ["Reach", "Open", RELEASE]),
    "door_closed": ("Door", ["Reach", "Open", "Close", RELEASE]),
}
"""Stated before anything was observed, but for Lower in ``lift_dropped``, whose policy lowers;
cubes of a stack may lie near each other, and what is moved aside a little is named MoveObj."""

PAUSES = {"Touch", "TouchWith"}
"""As which pauses of a gripper that has something are named; they may stand anywhere."""

DONE = {"Lift": "Lift", "Door": "Open", "Stack": RELEASE, "PickPlaceCan": f"{RELEASE}|Drop"}
"""In which step a task succeeds, by the simulator's own check of height, hinge or place."""

BODIES = {
    "Lift": "cube_main",
    "Stack": "cubeA_main",
    "PickPlaceCan": "Can_main",
    "Door": "Door_door",
}
OBJECTS = {"Lift": "cube", "Stack": "cube_a", "PickPlaceCan": "can", "Door": "door_door"}
HZ = 20.0
WITHIN_S = 0.1
UP = np.array([0.0, 0.0, 1.0])


class Episode:
    """One episode of a task: moves of the gripper, the states, and what the simulator says."""

    def __init__(self, env: Any, policy: str, rng: np.random.Generator) -> None:
        env.reset()
        self.env, self.policy, self.rng = env, policy, rng
        self.robot = env.robots[0]
        self.site = self.robot.eef_site_id["right"]
        self.xml = env.sim.model.get_xml()
        self.states: list[np.ndarray] = []
        self.truth: list[tuple[float, ...]] = []
        self.closed, self.noise, self.shove = False, np.zeros(3), 0
        self.task = PLANS[policy][0]
        self.keep()

    @property
    def body(self) -> int:
        """The body that the task is about."""
        return self.env.sim.model.body_name2id(BODIES[self.task])

    @property
    def place(self) -> np.ndarray:
        """Where it is [m]."""
        return np.array(self.env.sim.data.body_xpos[self.body])

    @property
    def hand(self) -> np.ndarray:
        """Where the gripper is, between its fingertips [m]."""
        return np.array(self.env.sim.data.site_xpos[self.site])

    def keep(self) -> None:
        """The state of this frame, and the simulator's checks of it."""
        env, data = self.env, self.env.sim.data
        model = {"Lift": "cube", "Stack": "cubeA"}.get(self.task)
        geoms: Any = ["Door_handle", "Door_handle_base"]
        if model:
            geoms = getattr(env, model)
        elif self.task == "PickPlaceCan":
            geoms = env.objects[env.object_id]
        held = env._check_grasp(gripper=self.robot.gripper["right"], object_geoms=geoms)
        hinge = float(data.qpos[env.hinge_qpos_addr]) if self.task == "Door" else 0.0
        self.states.append(env.sim.get_state().flatten())
        self.truth.append((held, self.place[2], hinge, env._check_success()))

    def step(self, move: np.ndarray, turn: np.ndarray) -> None:
        """One step of control: so far [m], so much about each axis [rad]."""
        if self.policy.endswith("noisy"):
            self.noise = 0.8 * self.noise + self.rng.normal(scale=0.08, size=3)
        action = np.zeros(self.env.action_dim)
        action[:3] = np.clip(move / 0.05, -1, 1) + self.noise
        action[3:6] = np.clip(turn / 0.5, -0.6, 0.6)
        action[6] = 1.0 if self.closed else -1.0
        force = self.env.sim.data.xfrc_applied
        force[self.body] = 0.0
        if self.shove:
            force[self.body, 0], self.shove = 0.7, self.shove - 1
        self.env.step(np.clip(action, -1, 1))
        self.keep()

    def level(self) -> np.ndarray:
        """The turn [rad] that brings the fingers to the nearest sides of a box, level."""
        data, model = self.env.sim.data, self.env.sim.model
        ends = [
            data.body_xpos[model.body_name2id(f"gripper0_right_{side}finger")]
            for side in ("left", "right")
        ]
        own, fingers = data.body_xmat[self.body].reshape(3, 3)[:, 0], ends[1] - ends[0]
        angle = np.arctan2(own[1], own[0]) - np.arctan2(fingers[1], fingers[0])
        return np.array([0.0, 0.0, (angle + np.pi / 4) % (np.pi / 2) - np.pi / 4])

    def upright(self) -> np.ndarray:
        """The turn [rad] that points the gripper at the door, a finger above and one below."""
        data = self.env.sim.data
        own = Rotation.from_matrix(data.site_xmat[self.site].reshape(3, 3))
        ahead = data.body_xmat[self.body].reshape(3, 3)[:, 1]
        turns = []
        for sign in (1.0, -1.0):
            up = np.array([0.0, 0.0, sign])
            wanted = Rotation.from_matrix(np.stack([up, np.cross(ahead, up), ahead], axis=1))
            turns.append((wanted * own.inv()).as_rotvec())
        return min(turns, key=np.linalg.norm)

    def go(
        self, target: Any, *, turn: Any = None, near: float = 0.008, limit: float = 0.03,
        most: int = 90,
    ) -> None:  # fmt: skip
        """Go to a place, which may move, no faster than a limit a step, until near it."""
        for _ in range(most):
            away = np.asarray(target() if callable(target) else target) - self.hand
            about = turn() if turn else np.zeros(3)
            if np.linalg.norm(away) < near and np.linalg.norm(about) < 0.06:
                return
            self.step(np.clip(0.6 * away, -limit, limit), 0.6 * about)

    def wait(self, seconds: float) -> None:
        """Stay."""
        for _ in range(round(seconds * HZ)):
            self.step(np.zeros(3), np.zeros(3))

    def grip(self, closed: bool, seconds: float = 0.5) -> None:
        """Close the gripper, or open it, and give it time."""
        self.closed = closed
        self.wait(seconds)


def pick(run: Episode, *, rise: float) -> None:
    """Reach, grasp and lift."""
    turn = None if run.task == "PickPlaceCan" else run.level
    run.go(lambda: run.place + 0.12 * UP, turn=turn)
    if run.policy.endswith("missed"):
        run.go(lambda: run.place + np.array([-0.09, 0.0, 0.01]))
        run.grip(True)
        run.go(lambda: run.place + np.array([-0.09, 0.0, 0.1]))
        run.grip(False)
        run.go(lambda: run.place + 0.12 * UP, turn=turn)
    if run.policy.endswith("pushed"):
        run.shove = 4
        run.wait(1.0)
        run.go(lambda: run.place + 0.12 * UP, turn=turn)
    if run.policy.endswith("hesitant"):
        run.wait(run.rng.uniform(0.6, 1.2))
    down = 0.01 if run.task == "PickPlaceCan" else 0.0
    run.go(lambda: run.place + down * UP, near=0.006)
    run.grip(True)
    if run.policy.endswith("hesitant"):
        run.wait(run.rng.uniform(0.4, 0.8))
    run.go(run.hand + rise * UP)


def perform(run: Episode) -> None:
    """Follow the policy's plan."""
    task, rng, policy = run.task, run.rng, run.policy
    if task == "Door":
        open_door(run)
        return
    rise = rng.uniform(0.14, 0.2)
    pick(run, rise=rise)
    if policy.endswith("hesitant"):
        run.wait(rng.uniform(0.6, 1.2))
    if task == "Lift":
        if policy.endswith("back"):
            run.go(run.hand - (rise + 0.002) * UP, near=0.004)
        if policy.endswith("dropped"):
            run.go(run.hand - (rise - 0.08) * UP)
            run.grip(False, 0.8)
            run.go(run.hand + 0.08 * UP)
            pick(run, rise=rise)
        if policy.endswith("back"):
            run.grip(False)
            run.go(run.hand + 0.15 * UP)
        run.wait(0.5)
        return
    if task == "Stack":
        below = run.env.sim.data.body_xpos[run.env.cubeB_body_id]
        run.go(lambda: np.array([*below[:2], run.hand[2]]) + (run.hand - run.place) * [1, 1, 0])
        high = run.place[2] - below[2] - 0.0455
    else:
        at = run.env.target_bin_placements[run.env.object_id]
        run.go(lambda: np.array([*at[:2], run.hand[2]]), most=120)
        high = run.place[2] - run.env.bin2_pos[2] - 0.065
    if policy.endswith("hesitant"):
        run.wait(rng.uniform(0.6, 1.0))
    if policy.endswith("dropped"):
        run.grip(False, 1.0)
    else:
        run.go(run.hand - high * UP, near=0.004)
        run.grip(False)
    run.go(run.hand + 0.12 * UP)
    run.wait(0.5)


def open_door(run: Episode) -> None:
    """Take the handle from above, pull it along its arc, and perhaps let go or push it back."""
    sim = run.env.sim
    model, data = sim.model, sim.data
    handle = model.geom_name2id("Door_handle")
    joint = model.joint_name2id("Door_hinge")

    def at(open_by: float = 0.0) -> np.ndarray:
        """Where the handle would be, were the door so much further open."""
        axis, pivot = data.xaxis[joint], data.xanchor[joint]
        away = data.geom_xpos[handle] - pivot
        turned = away * np.cos(open_by) + np.cross(axis, away) * np.sin(open_by)
        return pivot + turned + axis * (axis @ away) * (1 - np.cos(open_by))

    def swing(by: float, until: Callable[[float], bool]) -> None:
        for _ in range(120):
            if until(data.qpos[run.env.hinge_qpos_addr]):
                return
            run.step(np.clip(at(by) - run.hand, -0.02, 0.02), run.upright())

    def back(far: float) -> np.ndarray:
        return data.body_xmat[run.body].reshape(3, 3)[:, 1] * -far

    run.go(run.hand + np.array([0.0, 0.1, 0.1]))
    run.go(lambda: at() + back(0.12), turn=run.upright, most=140)
    if run.policy.endswith("noisy"):
        run.wait(0.5)
    run.go(at, turn=run.upright, near=0.01)
    run.grip(True)
    swing(0.08, lambda angle: angle > 0.36)
    run.wait(0.6)
    if run.policy.endswith("closed"):
        swing(-0.08, lambda angle: angle < 0.03)
        run.wait(0.4)
    if run.policy.endswith(("closed", "released")):
        run.grip(False)
        run.go(lambda: at() + back(0.15))
        run.wait(0.5)


def attempt(env: Any, policy: str, rng: np.random.Generator) -> Episode:
    """An episode that succeeds, as robosuite keeps, with as many grasps as its plan has."""
    while True:
        run = Episode(env, policy, rng)
        perform(run)
        held, _, _, success = np.array(run.truth, dtype=float).T
        grasps = borders(held > 0.5)
        if success.any() and len(grasps) == sum(
            step in {"Lift", "Open"} for step in PLANS[policy][1]
        ):
            return run


def record(folder: Path, episodes: int, seed: int) -> None:
    """Write a file of demonstrations for each task, as robomimic lays them out."""
    import h5py
    import robosuite

    folder.mkdir(parents=True, exist_ok=True)
    for task in OBJECTS:
        rng = np.random.default_rng(seed)
        arguments: dict[str, Any] = {
            "robots": "Panda", "has_renderer": False, "has_offscreen_renderer": False,
            "use_camera_obs": False, "control_freq": HZ, "ignore_done": True,
        }  # fmt: skip
        if task == "Door":
            arguments["use_latch"] = False
        env = robosuite.make(task, **arguments, seed=seed)
        policies = [name for name, (own, _) in PLANS.items() if own == task]
        with h5py.File(folder / f"{task.lower()}.hdf5", "w") as file:
            data = file.create_group("data")
            data.attrs["env_args"] = json.dumps({"env_name": task, "env_kwargs": arguments})
            for number in range(episodes):
                run = attempt(env, policies[number % len(policies)], rng)
                demo = data.create_group(f"demo_{number}")
                demo.attrs["model_file"], demo.attrs["policy"] = run.xml, run.policy
                demo["states"] = np.array(run.states)
                demo["truth"] = np.array(run.truth, dtype=float)
                held, _, hinge, success = np.array(run.truth, dtype=float).T
                print(
                    f"{task} {number} {run.policy}: {len(held)} frames, in hand {held.mean():.0%}, "
                    f"hinge to {hinge.max():.2f}, success {bool(success.any())}"
                )


def borders(frames: np.ndarray) -> list[tuple[int, int]]:
    """First and last frame of each run of true ones."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], frames.astype(int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def named(found: list[str], wanted: list[str]) -> bool:
    """Whether names are those of a plan."""
    if not wanted:
        return not found
    first, optional = wanted[0].removesuffix("?"), wanted[0].endswith("?")
    here = bool(found) and found[0] in first.split("|") and named(found[1:], wanted[1:])
    return here or (optional and named(found, wanted[1:]))


def beyond(found: list[str], wanted: list[str]) -> list[int] | None:
    """Which names stand between those of a plan; None unless these come, in their order."""
    planned: list[int] = []
    for step in wanted:
        names = step.removesuffix("?").split("|")
        here = [n for n, name in enumerate(found) if name in names and n not in planned]
        here = [n for n in here if not planned or n > planned[-1]]
        if here:
            planned.append(here[0])
        elif not step.endswith("?"):
            return None
    return [n for n in range(len(found)) if n not in planned]


def simulated(place: str, task: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What MuJoCo says of each frame: whether the gripper touches the thing, and its pose."""
    import mujoco

    from extractors.readers.formats.demonstrations import _Scene

    path, _, demo = place.rpartition(":")
    scene = _Scene.of(Path(path), demo)
    model, data = scene.model, mujoco.MjData(scene.model)
    body = model.body(BODIES[task]).id
    own = model.body_rootid[model.geom_bodyid] == model.body_rootid[body]
    names = [model.body(number).name for number in model.geom_bodyid]
    gripper = np.array(["gripper" in name or "finger" in name for name in names])
    touched, places, turns = [], [], []
    for state in scene.states:
        data.qpos[:], data.qvel[:] = np.split(state[1 : 1 + model.nq + model.nv], [model.nq])
        mujoco.mj_forward(model, data)
        pairs = data.contact.geom[: data.ncon]
        touched.append(bool((own[pairs].any(axis=1) & gripper[pairs].any(axis=1)).any()))
        places.append(data.xpos[body].copy())
        turns.append(data.xquat[body].copy())
    return np.array(touched), np.array(places), np.array(turns)


def shown(name: str, first: int, last: int, told: tuple[np.ndarray, ...]) -> bool:
    """Whether the simulator shows a step as well.

    A Reach ends where the gripper comes to touch the thing, within 0.1 s; a ResumePosture or
    Withdraw begins where it no longer does. In any other step it touches the thing in most frames,
    and moves it by a millimetre or turns it by a degree, up in a Lift and down in a Lower.
    """
    touched, places, turns = told
    near = round(WITHIN_S * HZ)

    def about(frame: int) -> bool:
        return bool(touched[max(frame - near, 0) : frame + near + 1].any())

    if name == "Unknown":
        return False
    if name == "Reach":
        return about(last)
    if name in RELEASE.split("|"):
        return about(first)
    during = slice(first, last + 1)
    moved = np.linalg.norm(places[during] - places[first], axis=1).max() >= 0.001
    turned = 2 * np.arccos(np.abs(turns[during] @ turns[first]).clip(0, 1)).max() >= np.radians(1)
    rise = (places[min(last, len(places) - 1)] - places[first]) @ UP
    along = {"Lift": rise > 0, "Lower": rise < 0}.get(name, True)
    return bool(touched[during].mean() > 0.5 and (moved or turned) and along)


def judged(place: str, truth: np.ndarray, policy: str) -> dict[str, Any]:
    """What was observed of an episode beside what the simulator says."""
    import capar

    task, plan = PLANS[policy]
    thing = OBJECTS[task]
    rows = list(capar.label([place], per_frame=True))
    rows = [row for row in rows if row["effector"] == "right_gripper"]
    held = np.array([thing in row["holds"] for row in rows])
    steps: list[str] = []
    spans: list[list[int]] = []
    before = None
    for frame, row in enumerate(rows):
        if row["objects"][:1] == [thing] and row["name"] not in PAUSES:
            if row["segment"] != before:
                steps.append(row["name"])
                spans.append([frame, frame])
            spans[-1][1] = frame
        before = row["segment"]
    others = beyond(steps, plan)
    told = simulated(place, task) if others else ()
    wrong = [steps[n] for n in others or () if not shown(steps[n], *spans[n], told)]
    true = truth[:, 0] > 0.5
    since = int(np.argmax(truth[:, 3]))
    about = {row["name"] for row in rows[max(since - 2, 0) : since + 3]}
    ends = []
    for span in borders(true):
        near = min(borders(held), default=(-99, -99), key=lambda own: abs(own[0] - span[0]))
        ends.append([(own - its) / HZ for own, its in zip(near, span, strict=True)])
    return {
        "place": place, "policy": policy, "exact": named(steps, plan), "steps": steps,
        "in_order": others is not None, "beyond": len(others or ()), "not_shown": wrong,
        "right": others is not None and not wrong, "done": bool(about & {*DONE[task].split("|")}),
        "both": int((held & true).sum()), "ours": int(held.sum()), "theirs": int(true.sum()),
        "ends_s": ends,
    }  # fmt: skip


def recordings(folder: Path) -> Iterator[tuple[str, np.ndarray, str]]:
    """Each episode's place, truth and policy."""
    import h5py

    for path in sorted(folder.glob("*.hdf5")):
        with h5py.File(path) as file:
            for name in sorted(file["data"], key=lambda each: int(each.rpartition("_")[2])):
                demo = file["data"][name]
                yield f"{path}:{name}", demo["truth"][()], str(demo.attrs["policy"])


def judge(folder: Path, *, as_json: bool) -> None:
    """Print how far what is observed is what the simulator says."""
    if not any(folder.glob("*.hdf5")):
        print("no recordings of others: `record` writes them")
        return
    results = [judged(*each) for each in recordings(folder)]
    if as_json:
        print(json.dumps(results))
        return
    both, ours, theirs = (sum(each[key] for each in results) for key in ("both", "ours", "theirs"))
    ends = [end for each in results for end in each["ends_s"]]
    near = [all(abs(away) <= WITHIN_S + 1e-9 for away in end) for end in ends]
    right, done = (sum(each[key] for each in results) for key in ("right", "done"))
    for each in results:
        off = max((abs(away) for end in each["ends_s"] for away in end), default=0.0)
        mark = "" if each["right"] else f"NAMES {each['not_shown'] or 'not as planned'} "
        mark += "" if off <= WITHIN_S + 1e-9 else f"ENDS {each['ends_s']} "
        print(f"{Path(each['place']).name} {each['policy']}: {mark}{' '.join(each['steps'])}")
    print(f"in hand, by frames: F1 {2 * both / max(ours + theirs, 1):.3f}")
    print(f"both ends within {WITHIN_S} s: {sum(near)} of {len(near)}")
    print(f"lifted, opened, placed within {WITHIN_S} s of such a step: {done} of {len(results)}")
    print(f"names of all steps right: {right} of {len(results)} episodes")
    exact, ordered, others = (
        sum(episode[key] for episode in results) for key in ("exact", "in_order", "beyond")
    )
    calm = [each["exact"] for each in results if not each["policy"].endswith("noisy")]
    print(f"... no others than planned: {exact}, without noise {sum(calm)} of {len(calm)}")
    print(f"... the planned ones in their order: {ordered} of {len(results)}")
    wrong = sum(len(each["not_shown"]) for each in results)
    print(f"steps beyond the plans that the simulator shows: {others - wrong} of {others}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("record", "judge"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--episodes", type=int, default=14)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    if given.what == "record":
        record(given.folder, given.episodes, given.seed)
    else:
        judge(given.folder, as_json=given.json)


if __name__ == "__main__":
    main()
