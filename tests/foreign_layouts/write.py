"""Writes one trial in each layout of the motion capture exports next to this file.

A right hand reaches an object on a table, takes it, lifts it, carries it aside, puts it down, lets
go and returns. README.md says what each file holds; ``python write.py`` writes them again.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

FOLDER = Path(__file__).parent
NOISE_M = 0.0005
NOISE_DEG = 0.2
PALM_M = 0.015
"""Half the thickness of the hand: its middle to the palm."""

Vector = tuple[float, float, float]
Places = dict[str, Vector]

GRASP = Rotation.from_euler("y", 90, degrees=True)
"""From the palm down to the palm to the left, the thumb up."""

Y_UP_FACING_MINUS_Z = ((1, 0, 0), (0, 0, 1), (0, -1, 0))
Y_UP_FACING_Z = ((-1, 0, 0), (0, 0, 1), (0, 1, 0))
Y_UP_FACING_X = ((0, 1, 0), (0, 0, 1), (1, 0, 0))
Z_UP_FACING_Y = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
Z_UP_FACING_MINUS_Y = ((-1, 0, 0), (0, -1, 0), (0, 0, 1))
Z_UP_FACING_MINUS_X = ((0, -1, 0), (1, 0, 0), (0, 0, 1))

HAND_MARKERS: Places = {
    "wrist": (0.012, -0.070, 0.022),
    "index": (-0.030, 0.030, 0.022),
    "little": (0.032, 0.015, 0.022),
    "back": (-0.004, -0.015, 0.030),
}
HEAD_MARKERS: Places = {
    "LFHD": (-0.065, 0.095, 0.020),
    "RFHD": (0.068, 0.093, 0.022),
    "LBHD": (-0.070, -0.085, 0.035),
    "RBHD": (0.066, -0.090, 0.050),
}


@dataclass(frozen=True)
class Trial:
    """How the object is moved, in metres and seconds; x to the right, y ahead, z up."""

    rate: float
    size: Vector
    """Of the object along x, y and z."""

    start: float
    """x of the object before it is moved."""

    carry: float
    lift: float
    rest: Vector
    """Middle of the resting hand, above the level of the table."""

    phases: tuple[float, ...]
    """Rest, reach, touch, lift, hold, carry, settle, lower, let go, resume and rest."""

    table: float
    """Height of the table."""

    axes: tuple[tuple[int, int, int], ...]
    """Rows: the axes of the file in x, y and z."""

    seed: int
    turn_deg: float = 0.0
    """How far the object turns to the left while it is carried."""

    origin: Vector = (0.0, 0.0, 0.0)
    """Where the middle of the table's floor is, in the axes of the file."""

    @property
    def ends(self) -> Float[np.ndarray, "phases"]:
        return np.cumsum(self.phases)

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        return np.arange(round(self.ends[-1] * self.rate) + 1) / self.rate

    @property
    def world(self) -> RigidTransform:
        return RigidTransform.from_components(self.origin, Rotation.from_matrix(self.axes))

    def in_file(self, pose: RigidTransform) -> RigidTransform:
        """The pose of a body whose axes are those of the file while it lies as in x, y and z."""
        return self.world * pose * RigidTransform.from_rotation(self.world.rotation.inv())


RIGID = Trial(
    rate=120.0,
    size=(0.10, 0.12, 0.16),
    start=0.10,
    carry=-0.30,
    lift=0.22,
    rest=(0.34, -0.38, 0.12),
    phases=(0.8, 1.0, 0.3, 0.6, 0.2, 0.9, 0.15, 0.6, 0.35, 1.0, 0.6),
    table=0.74,
    axes=Y_UP_FACING_MINUS_Z,
    seed=1,
    origin=(0.12, 0.0, -0.35),
)
SKELETON = Trial(
    rate=60.0,
    size=(0.06, 0.16, 0.24),
    start=0.14,
    carry=-0.30,
    lift=0.25,
    rest=(0.30, -0.38, 0.13),
    phases=(0.3, 0.65, 0.2, 0.45, 0.0, 0.65, 0.0, 0.45, 0.2, 0.65, 0.15),
    table=0.72,
    axes=Y_UP_FACING_Z,
    seed=2,
    origin=(-0.2, 0.0, 0.5),
)
TRAJECTORIES = Trial(
    rate=100.0,
    size=(0.09, 0.14, 0.12),
    start=-0.10,
    carry=0.30,
    lift=0.20,
    rest=(0.42, -0.40, 0.12),
    phases=(0.6, 0.9, 0.4, 0.55, 0.3, 0.8, 0.3, 0.55, 0.3, 0.9, 0.4),
    table=0.75,
    axes=Z_UP_FACING_MINUS_X,
    seed=3,
    origin=(0.85, -0.4, 0.0),
)
SEGMENTS = Trial(
    rate=120.0,
    size=(0.07, 0.07, 0.22),
    start=0.12,
    carry=-0.30,
    lift=0.24,
    rest=(0.36, -0.39, 0.14),
    phases=(0.5, 0.8, 0.25, 0.5, 0.1, 1.0, 0.1, 0.6, 0.25, 0.8, 0.3),
    table=0.76,
    axes=Z_UP_FACING_MINUS_Y,
    seed=4,
    turn_deg=20.0,
    origin=(-0.3, 0.6, 0.0),
)
SPACES = Trial(
    rate=60.0,
    size=(0.10, 0.10, 0.15),
    start=-0.12,
    carry=0.30,
    lift=0.21,
    rest=(0.40, -0.40, 0.13),
    phases=(1.0, 1.2, 0.5, 0.8, 0.3, 1.2, 0.2, 0.7, 0.4, 1.2, 0.3),
    table=0.73,
    axes=Z_UP_FACING_Y,
    seed=5,
    origin=(0.0, 0.9, 0.0),
)
TABS = Trial(
    rate=100.0,
    size=(0.08, 0.08, 0.25),
    start=0.13,
    carry=-0.30,
    lift=0.23,
    rest=(0.35, -0.37, 0.15),
    phases=(0.4, 0.85, 0.3, 0.6, 0.15, 0.85, 0.15, 0.6, 0.3, 0.9, 0.4),
    table=0.74,
    axes=Y_UP_FACING_X,
    seed=6,
    turn_deg=-10.0,
    origin=(0.6, 0.0, 0.1),
)


def main() -> None:
    write_rigid_bodies(FOLDER / "motive_rigid_bodies.csv")
    write_skeleton(FOLDER / "motive_skeleton_and_markers.csv")
    write_trajectories(FOLDER / "nexus_trajectories.csv")
    write_segments(FOLDER / "nexus_segments.csv")
    write_spaces(FOLDER / "markers_spaces.trc")
    write_tabs(FOLDER / "markers_tabs.trc")


def minimum_jerk(tau: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "frames"]:
    """Share of the way at a share of the time (Flash and Hogan 1985)."""
    t = np.clip(tau, 0.0, 1.0)
    return t**3 * (10.0 - 15.0 * t + 6.0 * t**2)


def share(trial: Trial, phase: int) -> Float[np.ndarray, "frames"]:
    """Share of the way that is done of a move, by its index in ``Trial.phases``."""
    end, duration = trial.ends[phase], trial.phases[phase]
    return minimum_jerk((trial.times - end + duration) / duration)


def object_pose(trial: Trial) -> RigidTransform:
    """The middle of the object, with its axes along x, y and z before it is moved."""
    raised = trial.lift * (share(trial, 3) - share(trial, 7))
    carried = share(trial, 5)
    places = np.zeros((len(trial.times), 3))
    places[:, 0] = trial.start + trial.carry * carried
    places[:, 2] = trial.table + trial.size[2] / 2 + raised
    return RigidTransform.from_components(places, turned("z", trial.turn_deg * carried))


def hand_pose(trial: Trial) -> RigidTransform:
    """The middle of the hand: x to the little finger, y along the fingers, z out of the back."""
    palm_on_side = RigidTransform.from_components((trial.size[0] / 2 + PALM_M, 0.0, 0.01), GRASP)
    held = object_pose(trial) * palm_on_side
    rest = np.add(trial.rest, (0.0, 0.0, trial.table))
    near = (share(trial, 1) * (1.0 - share(trial, 9)))[:, None]
    early = (trial.times - trial.ends[0]) / trial.phases[1]
    late = (trial.ends[9] - trial.times) / trial.phases[9]
    turn = minimum_jerk(np.minimum(early, late) / 0.65)[:, None]
    tilt = Rotation.from_rotvec(turn * held.rotation.as_rotvec())
    return RigidTransform.from_components(rest + near * (held.translation - rest), tilt)


def head_pose(trial: Trial) -> RigidTransform:
    """A head that follows the object by ten degrees: y ahead, z up."""
    seen = np.sign(trial.carry) * (share(trial, 5) - 0.5)
    rotation = turned("z", -10.0 * seen) * Rotation.from_euler("x", -25.0, degrees=True)
    place = np.tile((0.0, -0.45, trial.table + 0.50), (len(trial.times), 1))
    place[:, 0] += 0.02 * seen
    return RigidTransform.from_components(place, rotation)


def turned(axis: str, degrees: Float[np.ndarray, "frames"]) -> Rotation:
    return Rotation.from_euler(axis, degrees[:, None], degrees=True)


def moved(*offset: float) -> RigidTransform:
    return RigidTransform.from_translation(offset)


def shaken(pose: RigidTransform, draw: np.random.Generator) -> RigidTransform:
    """The pose with the noise of a tracker."""
    size = (len(pose), 3)
    wobble = Rotation.from_rotvec(np.deg2rad(NOISE_DEG) * draw.normal(size=size))
    return RigidTransform.from_components(
        pose.translation + NOISE_M * draw.normal(size=size), pose.rotation * wobble
    )


def markers(
    trial: Trial, pose: RigidTransform, places: Places, draw: np.random.Generator
) -> dict[str, Float[np.ndarray, "frames 3"]]:
    """Where the markers of a body are seen, in the axes of the file [m]."""
    seen = {name: trial.world.apply(pose.apply(place)) for name, place in places.items()}
    return {name: at + NOISE_M * draw.normal(size=at.shape) for name, at in seen.items()}


def hide(
    values: Float[np.ndarray, "frames columns"], *spans: tuple[int, int]
) -> Float[np.ndarray, "frames columns"]:
    """The values without those of frames from the first to before the second of each span."""
    kept = values.copy()
    for first, end in spans:
        kept[first:end] = np.nan
    return kept


# Motive


@dataclass(frozen=True)
class Column:
    """A column of a Motive export with the cells above it."""

    type: str
    name: str
    id: str
    kind: str
    axis: str
    values: Float[np.ndarray, "frames"]
    parent: str = ""


def columns(
    type: str,
    name: str,
    id: str,
    heads: str,
    values: Float[np.ndarray, "frames columns"],
    *,
    parent: str = "",
) -> list[Column]:
    """Columns of one item; in heads r and p are Rotation and Position, as in ``rX rY rZ pX``."""
    kinds = {"r": "Rotation", "p": "Position", "e": "Mean Marker Error"}
    cells = [(kinds[head[0]], head[1:]) for head in heads.split()]
    return [
        Column(type, name, id, kind, axis, value, parent)
        for (kind, axis), value in zip(cells, values.T, strict=True)
    ]


def write_motive(path: Path, trial: Trial, head: str, found: list[Column]) -> None:
    """Writes the columns below a first row; in it %d are frames and %f the rate."""
    rate, frames = f"{trial.rate:.6f}", str(len(trial.times))
    titles = [
        ["", "Type", *(column.type for column in found)],
        ["", "Name", *(column.name for column in found)],
        ["", "ID", *(f'"{column.id}"' for column in found)],
        ["", "Parent", *(column.parent for column in found)],
        ["", "", *(column.kind for column in found)],
        ["Frame", "Time (Seconds)", *(column.axis for column in found)],
    ]
    if "Format Version,1.25" not in head:
        del titles[3]
    rows = [head.replace("%f", rate).replace("%d", frames), "", *map(",".join, titles)]
    table = np.column_stack([column.values for column in found])
    for frame, (time, values) in enumerate(zip(trial.times, table, strict=True)):
        cells = ("" if np.isnan(value) else f"{value:.6f}" for value in values)
        rows.append(",".join([str(frame), f"{time:.6f}", *cells]))
    write_lines(path, rows, end="\r\n")


def write_rigid_bodies(path: Path) -> None:
    trial, draw = RIGID, np.random.default_rng(RIGID.seed)
    still = np.tile((0.0, 0.05, trial.table), (len(trial.times), 1))
    bodies = {
        "RightHand": ("5C1A90F2E3B711EE8A4D7C10C91F22D0", hand_pose(trial)),
        "Box": ("6E27B3C4E3B711EE8A4D7C10C91F22D0", object_pose(trial)),
        "Table": ("7F44D5A8E3B711EE8A4D7C10C91F22D0", RigidTransform.from_translation(still)),
    }
    found = []
    for name, (id, pose) in bodies.items():
        seen = shaken(trial.in_file(pose), draw)
        error = np.abs(0.0003 + 0.00005 * draw.normal(size=(len(trial.times), 1)))
        values = np.hstack([seen.rotation.as_quat(), seen.translation, error])
        found += columns("Rigid Body", name, id, "rX rY rZ rW pX pY pZ e", values)
    head = (
        "Format Version,1.23,Take Name,box_trial_03,Take Notes,,"
        "Capture Frame Rate,%f,Export Frame Rate,%f,"
        "Capture Start Time,2024-03-19 02.41.07.318 PM,Capture Start Frame,15112,"
        "Total Frames in Take,%d,Total Exported Frames,%d,"
        "Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global"
    )
    write_motive(path, trial, head, found)


def write_skeleton(path: Path) -> None:
    trial, draw = SKELETON, np.random.default_rng(SKELETON.seed)
    x, y, z = (side / 2 for side in trial.size)
    box_markers = {
        "1": (-x - 0.007, 0.060, 0.095),
        "2": (-x - 0.007, -0.065, 0.080),
        "3": (0.010, y + 0.007, -0.020),
        "4": (-0.012, -0.020, z + 0.007),
    }
    plate = dict(list(HAND_MARKERS.items())[:3])
    bodies = {
        "Hand_R": ("3B9A2E10F40C11EF", hand_pose(trial), (0.0, 0.0, 0.030), plate),
        "CerealBox": ("44D07A52F40C11EF", object_pose(trial), (0.0, 0.0, 0.0), box_markers),
    }
    lost = {"Hand_R": [(32, 37), (118, 126)], "CerealBox": [(9, 10), (106, 112), (205, 207)]}
    gaps = {
        "Hand_R": ([], [(20, 24), (32, 37), (118, 126)], [(32, 37), (121, 130)]),
        "CerealBox": ([(9, 10), (100, 116)], [(106, 112)], [(0, 30), (106, 112)], [(205, 207)]),
    }
    rigid, solved, labelled = [], [], []
    for number, (name, (id, pose, pivot, places)) in enumerate(bodies.items(), start=1):
        seen = shaken(trial.in_file(pose * moved(*pivot)), draw)
        values = hide(np.hstack([euler_deg(seen), 1000 * seen.translation]), *lost[name])
        rigid += columns("Rigid Body", name, f"{number}:{id}", "rX rY rZ pX pY pZ", values)
        reconstructed = markers(trial, pose, places, draw)
        items = zip(places.items(), reconstructed.values(), gaps[name], strict=True)
        for count, ((_, place), at, gap) in enumerate(items, start=1):
            label, marker = f"{name}:Marker {count:03d}", f"{number}{count:02d}:{id}"
            local = trial.world.rotation.apply(np.subtract(place, pivot))
            expected = hide(1000 * seen.apply(local), *lost[name])
            parent = f"{number}:{id}"
            solved += columns(
                "Rigid Body Marker", label, marker, "pX pY pZ", expected, parent=parent
            )
            labelled += columns(
                "Marker", label, marker, "pX pY pZ", hide(1000 * at, *gap), parent=parent
            )
    bones = []
    ids = {name: f"{number}:A8C15B06F40C11EF" for number, name in enumerate(PARENTS, start=1)}
    for name, pose in bone_poses(trial).items():
        seen = shaken(trial.in_file(pose), draw)
        values = np.hstack([euler_deg(seen), 1000 * seen.translation])
        bones += columns(
            "Bone",
            f"Anna:{name}",
            ids[name],
            "rX rY rZ pX pY pZ",
            values,
            parent=ids.get(PARENTS[name], ""),
        )
    ghosts = {
        "Unlabeled 1041": ((0.55, 0.30, trial.table + 0.004), [(40, 41), (95, 140)]),
        "Unlabeled 1042": ((-0.48, 0.21, trial.table + 0.310), [(0, 61), (88, 223)]),
        "Unlabeled 1057": ((0.02, -0.36, trial.table + 0.450), [(0, 150), (158, 223)]),
    }
    stray = []
    for number, (name, (place, gap)) in enumerate(ghosts.items(), start=1):
        still = RigidTransform.from_translation(np.zeros((len(trial.times), 3)))
        (at,) = markers(trial, still, {name: place}, draw).values()
        id = f"{number:X}F:D842698FB0A611F0"
        stray += columns("Marker", name, id, "pX pY pZ", hide(1000 * at, *gap))
    head = (
        "Format Version,1.25,Take Name,Take 2025-03-11 10.22.47 AM,Take Notes,,"
        "Capture Frame Rate,%f,Export Frame Rate,%f,"
        "Capture Start Time,2025-03-11 10.22.47.512 AM,Capture Start Frame,1204,"
        "Total Frames in Take,%d,Total Exported Frames,%d,"
        "Rotation Type,XYZ,Length Units,Millimeters,Coordinate Space,Global"
    )
    write_motive(path, trial, head, rigid + solved + bones + labelled + stray)


def euler_deg(pose: RigidTransform) -> Float[np.ndarray, "frames 3"]:
    """Angles about x, then the new y, then the new z."""
    return pose.rotation.as_euler("XYZ", degrees=True)


PARENTS = {
    "Hip": "",
    "Ab": "Hip",
    "Chest": "Ab",
    "Neck": "Chest",
    "Head": "Neck",
    "LShoulder": "Chest",
    "LUArm": "LShoulder",
    "LFArm": "LUArm",
    "LHand": "LFArm",
    "RShoulder": "Chest",
    "RUArm": "RShoulder",
    "RFArm": "RUArm",
    "RHand": "RFArm",
}
"""Bones of an upper body, without rotation while it stands in a T."""


def bone_poses(trial: Trial) -> dict[str, RigidTransform]:
    """A sitting upper body whose right arm follows the hand, its origins in the joints."""
    frames = len(trial.times)
    trunk = {
        "Hip": (0.0, -0.48, 0.56),
        "Ab": (0.0, -0.48, 0.64),
        "Chest": (0.0, -0.47, 0.82),
        "Neck": (0.0, -0.46, 1.06),
        "LShoulder": (-0.03, -0.46, 1.02),
        "LUArm": (-0.18, -0.46, 1.02),
        "LFArm": (-0.20, -0.46, 0.74),
        "LHand": (-0.19, -0.24, 0.75),
        "RShoulder": (0.03, -0.46, 1.02),
    }
    left = {"LUArm": (-0.02, 0.0, -0.28), "LFArm": (0.01, 0.22, 0.01), "LHand": (0.0, 1.0, 0.0)}
    poses = {}
    for name, place in trunk.items():
        toward = np.tile(left.get(name, (-1.0, 0.0, 0.0)), (frames, 1))
        poses[name] = RigidTransform.from_components(
            np.tile(place, (frames, 1)), pointing((-1.0, 0.0, 0.0), toward)
        )
    poses["Head"] = head_pose(trial) * moved(0.0, -0.05, -0.10)
    hand = hand_pose(trial)
    wrist = hand.apply((0.0, -0.09, 0.0))
    shoulder = np.tile((0.18, -0.46, 1.02), (frames, 1))
    elbow = elbow_places(shoulder, wrist, upper=0.31, fore=0.29)
    across = (1.0, 0.0, 0.0)
    poses["RUArm"] = RigidTransform.from_components(shoulder, pointing(across, elbow - shoulder))
    poses["RFArm"] = RigidTransform.from_components(elbow, pointing(across, wrist - elbow))
    in_t = Rotation.from_euler("z", 90, degrees=True)
    poses["RHand"] = RigidTransform.from_components(wrist, hand.rotation * in_t)
    return {name: poses[name] for name in PARENTS}


def elbow_places(
    shoulder: Float[np.ndarray, "frames 3"],
    wrist: Float[np.ndarray, "frames 3"],
    *,
    upper: float,
    fore: float,
) -> Float[np.ndarray, "frames 3"]:
    """Where the elbow hangs down and out between shoulder and wrist; lengths in metres."""
    line = wrist - shoulder
    distance = np.linalg.norm(line, axis=1, keepdims=True)
    ahead = line / distance
    along = (distance**2 + upper**2 - fore**2) / (2 * distance)
    down = np.array((0.5, 0.0, -1.0)) - ahead * (ahead @ (0.5, 0.0, -1.0))[:, None]
    down /= np.linalg.norm(down, axis=1, keepdims=True)
    return shoulder + along * ahead + np.sqrt(upper**2 - along**2) * down


def pointing(axis: Vector, toward: Float[np.ndarray, "frames 3"]) -> Rotation:
    """The rotation that takes the axis to each direction, with z as far up as it may be."""
    toward = toward / np.linalg.norm(toward, axis=1, keepdims=True)
    up = (0.0, 0.0, 1.0)
    turns = [
        Rotation.align_vectors([to, up], [axis, up], weights=[np.inf, 1.0])[0] for to in toward
    ]
    return Rotation.concatenate(turns)


# Nexus


def write_nexus(
    path: Path,
    trial: Trial,
    section: str,
    heads: tuple[tuple[str, str], ...],
    found: dict[str, Float[np.ndarray, "frames columns"]],
    *,
    first: int,
) -> None:
    """Writes a section of a Nexus export; heads are axes and units, first the first frame."""
    names = "".join(f",,{name}" + "," * (len(heads) - 2) for name in found)
    rows = [
        section,
        f"{trial.rate:g}",
        f"{names},,",
        ",".join(["Frame", "Sub Frame", *(axis for axis, _ in heads * len(found))]),
        ",".join(["", "", *(unit for _, unit in heads * len(found))]),
    ]
    for frame, values in enumerate(np.hstack(list(found.values())), start=first):
        rows.append(",".join([str(frame), "0", *(f"{value:.6g}" for value in values)]))
    write_lines(path, [*rows, ""], end="\r\n")


def write_trajectories(path: Path) -> None:
    trial, draw = TRAJECTORIES, np.random.default_rng(TRAJECTORIES.seed)
    x, y, z = (side / 2 for side in trial.size)
    box = {
        "BOX1": (-x, y - 0.01, z + 0.007),
        "BOX2": (-x + 0.01, -y, z + 0.007),
        "BOX3": (x - 0.01, 0.035, z + 0.007),
        "BOX4": (-x - 0.007, 0.0, 0.010),
    }
    hand = {f"RHND{n}": place for n, place in enumerate(HAND_MARKERS.values(), start=1)}
    bodies = [
        ("subj1", head_pose(trial), HEAD_MARKERS),
        ("subj1", hand_pose(trial), hand),
        ("Box", object_pose(trial), box),
    ]
    found = {}
    for subject, pose, places in bodies:
        for name, at in markers(trial, pose, places, draw).items():
            found[f"{subject}:{name}"] = 1000 * at
    heads = (("X", "mm"), ("Y", "mm"), ("Z", "mm"))
    write_nexus(path, trial, "Trajectories", heads, found, first=1)


def write_segments(path: Path) -> None:
    trial, draw = SEGMENTS, np.random.default_rng(SEGMENTS.seed)
    wrist = hand_pose(trial) * moved(0.0, -0.09, 0.0)
    shoulder = np.tile((0.18, -0.46, trial.table + 0.31), (len(trial.times), 1))
    elbow = elbow_places(shoulder, wrist.translation, upper=0.31, fore=0.29)
    forearm = pointing((0.0, 1.0, 0.0), wrist.translation - elbow)
    poses = {
        "S02:head": head_pose(trial),
        "S02:r_forearm": RigidTransform.from_components(elbow, forearm),
        "S02:r_hand": wrist,
        "Bottle:Bottle": object_pose(trial) * moved(0.0, 0.0, -trial.size[2] / 2),
    }
    found = {}
    for name, pose in poses.items():
        seen = shaken(trial.in_file(pose), draw)
        found[name] = np.hstack([seen.rotation.as_rotvec(degrees=True), 1000 * seen.translation])
    heads = tuple((axis, "deg") for axis in ("RX", "RY", "RZ"))
    heads += tuple((axis, "mm") for axis in ("TX", "TY", "TZ"))
    write_nexus(path, trial, "Segments", heads, found, first=241)


# TRC

TRC_KEYS = (
    "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame OrigNumFrames"
)


def write_spaces(path: Path) -> None:
    trial, draw = SPACES, np.random.default_rng(SPACES.seed)
    x, y, z = (side / 2 for side in trial.size)
    box = {
        "Box.Front": (-0.010, -y - 0.006, 0.030),
        "Box.Left": (-x - 0.006, 0.015, -0.015),
        "Box.Rear": (0.020, y + 0.006, 0.045),
        "Box.Top": (-0.025, 0.020, z + 0.006),
    }
    hand = {f"R.Hand.{name.capitalize()}": place for name, place in HAND_MARKERS.items()}
    found = markers(trial, hand_pose(trial), hand, draw)
    found |= markers(trial, object_pose(trial), box, draw)
    frames = len(trial.times)
    rate = f"{trial.rate:.1f}"
    head = [rate, rate, str(frames), str(len(found)), "mm", rate, "1", str(frames)]
    widths = [len(key) for key in TRC_KEYS.split()]
    rows = [
        f"PathFileType  4  (X/Y/Z)  {path.name}",
        "  ".join(TRC_KEYS.split()),
        "  ".join(text.rjust(width) for text, width in zip(head, widths, strict=True)),
        "Frame#      Time" + "".join(f"    {name:<32}" for name in found).rstrip(),
        " " * 16
        + "".join(f"{axis}{n}".rjust(12) for n in range(1, len(found) + 1) for axis in "XYZ"),
        "",
    ]
    table = 1000 * np.hstack(list(found.values()))
    for frame, (time, values) in enumerate(zip(trial.times, table, strict=True), start=1):
        cells = "".join(f"{value:12.3f}" for value in values)
        rows.append(f"{frame:6d}{time:10.5f}{cells}")
    write_lines(path, rows, end="\r\n")


def write_tabs(path: Path) -> None:
    trial, draw = TABS, np.random.default_rng(TABS.seed)
    radius, half = trial.size[0] / 2, trial.size[2] / 2
    bottle = {
        "Bottle1": (-radius - 0.007, 0.0, 0.020),
        "Bottle2": (0.0, radius + 0.007, -0.035),
        "Bottle3": (0.005, 0.0, half + 0.007),
        "Bottle4": (-0.020, -0.042, 0.060),
    }
    hand = {f"Hand_R{n}": place for n, place in enumerate(HAND_MARKERS.values(), start=1)}
    found = markers(trial, hand_pose(trial), hand, draw)
    found |= markers(trial, object_pose(trial), bottle, draw)
    found["Hand_R4"] = hide(found["Hand_R4"], (95, 103), (205, 241), (330, 352), (540, 551))
    first, frames = 121, str(len(trial.times))
    rate = f"{trial.rate:.2f}"
    head = [rate, rate, frames, str(len(found)), "m", rate, str(first), frames]
    rows = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "\t".join(TRC_KEYS.split()),
        "\t".join(head),
        "Frame#\tTime\t" + "".join(f"{name}\t\t\t" for name in found),
        "\t\t" + "".join(f"{axis}{n}\t" for n in range(1, len(found) + 1) for axis in "XYZ"),
        "",
    ]
    table = np.hstack(list(found.values()))
    for frame, values in enumerate(table, start=first):
        cells = ("" if np.isnan(value) else f"{value:.6f}" for value in values)
        rows.append("\t".join([str(frame), f"{(frame - 1) / trial.rate:.3f}", *cells, ""]))
    write_lines(path, rows, end="\n")


def write_lines(path: Path, rows: list[str], *, end: str) -> None:
    path.write_bytes("".join(f"{row}{end}" for row in rows).encode())


if __name__ == "__main__":
    main()
