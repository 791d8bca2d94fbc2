"""Tiny valid files of every format, all of one and the same motion."""

import json
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

FRAMES = 12
RATE = 50.0
TIMES = np.arange(FRAMES) / RATE
PLACES = np.stack([0.1 * TIMES / TIMES[-1] + 0.4, 0.2 + 0 * TIMES, 0.9 + 0.05 * TIMES], axis=1)
TURNS = Rotation.from_euler("z", (40.0 * TIMES / TIMES[-1])[:, None], degrees=True)
CORNERS = np.array([[0.0, 0.0, 0.0], [0.06, 0.0, 0.0], [0.0, 0.08, 0.0], [0.0, 0.0, 0.1]])
NAMES = ("a", "b", "c", "d")


def corner_tracks() -> np.ndarray:
    """Markers over time [m]: frames, markers, 3."""
    return TURNS.as_matrix() @ CORNERS.T[None] + PLACES[:, :, None]


def markers() -> np.ndarray:
    """Markers over time [m] as (frames, markers, 3)."""
    return corner_tracks().transpose(0, 2, 1)


def write_csv(path: Path) -> Path:
    quaternions = TURNS.as_quat()
    head = "t_s," + ",".join(
        f"hand_{each}" for each in ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")
    )
    rows = [
        ",".join(f"{v:.9g}" for v in (t, *p, *q, 1))
        for t, p, q in zip(TIMES, PLACES, quaternions, strict=True)
    ]
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


def write_bvh(path: Path) -> Path:
    rows = [
        f"{p[0] * 100:.7f} {p[1] * 100:.7f} {p[2] * 100:.7f} {a:.7f} 0 0"
        for p, a in zip(PLACES, TURNS.as_euler("zyx", degrees=True)[:, 0], strict=True)
    ]
    path.write_text(
        "HIERARCHY\nROOT hand\n{\n OFFSET 0 0 0\n"
        " CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
        " JOINT tip\n {\n  OFFSET 10 0 0\n  CHANNELS 0\n  End Site\n  {\n   OFFSET 1 0 0\n  }\n }\n"
        f"}}\nMOTION\nFrames: {FRAMES}\nFrame Time: {1 / RATE}\n" + "\n".join(rows) + "\n"
    )
    return path


def write_tsv(path: Path) -> Path:
    head = {
        "NO_OF_FRAMES": FRAMES, "NO_OF_CAMERAS": 7, "NO_OF_MARKERS": 4, "FREQUENCY": int(RATE),
        "DESCRIPTION": "--", "DATA_INCLUDED": "3D", "MARKER_NAMES": "\t".join(NAMES),
    }  # fmt: skip
    rows = ["\t".join(f"{v * 1000:.6f}" for v in each.ravel()) for each in markers()]
    path.write_text("\n".join([*(f"{k}\t{v}" for k, v in head.items()), *rows]) + "\n")
    return path


def write_tsv_6d(path: Path) -> Path:
    head = {
        "NO_OF_FRAMES": FRAMES, "NO_OF_CAMERAS": 7, "NO_OF_BODIES": 1, "FREQUENCY": int(RATE),
        "DATA_INCLUDED": "6D", "BODY_NAMES": "hand",
    }  # fmt: skip
    rows = [
        "\t".join(f"{v:.8f}" for v in (*p * 1000, 0, 0, 0, 0.5, *m.T.ravel()))
        for p, m in zip(PLACES, TURNS.as_matrix(), strict=True)
    ]
    path.write_text("\n".join([*(f"{k}\t{v}" for k, v in head.items()), *rows]) + "\n")
    return path


def write_trc(path: Path) -> Path:
    cells = [f"{v * 1000:.6f}" for v in markers()[0].ravel()]
    assert len(cells) == 12
    rows = [
        "\t".join([str(n + 1), f"{t:.6f}", *(f"{v * 1000:.6f}" for v in each.ravel())])
        for n, (t, each) in enumerate(zip(TIMES, markers(), strict=True))
    ]
    head = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
        f"{RATE}\t{RATE}\t{FRAMES}\t4\tmm",
        "Frame#\tTime\t" + "\t\t\t".join(NAMES),
        "\t\t" + "\t".join(f"{axis}{n}" for n in range(1, 5) for axis in "XYZ"),
    ]
    path.write_text("\n".join([*head, *rows]) + "\n")
    return path


def write_trc_spaces(path: Path) -> Path:
    """The same with runs of spaces, as some tools write it."""
    lines = write_trc(path).read_text().splitlines()
    rows = ["  ".join(each.split()) for each in lines]
    path.write_text("\n".join([*rows[:5], "", *rows[5:]]) + "\n")
    return path


def write_motive(path: Path, *, order: str = "", bone: bool = False) -> Path:
    """A rigid body of Motive, its axes those of the file; Euler angles if an order is given."""
    angles = TURNS.as_euler(order, degrees=True) if order else TURNS.as_quat()
    axes = order or "XYZW"
    columns = [("Rotation", each) for each in axes] + [("Position", each) for each in "XYZ"]
    kind, name = ("Bone", "Ann:RHand") if bone else ("Rigid Body", "hand")
    head = {
        "Format Version": "1.23", "Take Name": "m", "Export Frame Rate": f"{RATE:f}",
        "Capture Start Time": "2025-03-01 09.30.00.250 PM", "Total Exported Frames": FRAMES,
        "Rotation Type": order or "Quaternion", "Length Units": "Millimeters",
        "Coordinate Space": "Global",
    }  # fmt: skip
    lines = [",".join(f"{k},{v}" for k, v in head.items()), ""]
    for cells in ([kind] * len(columns), [name] * len(columns), ['"7F:A"'] * len(columns)):
        lines.append(",".join(["", "", *cells]))
    lines.append(",".join(["", "", *(what for what, _ in columns)]))
    lines.append(",".join(["Frame", "Time (Seconds)", *(axis for _, axis in columns)]))
    for n, (t, p, a) in enumerate(zip(TIMES, PLACES, angles, strict=True)):
        lines.append(",".join([str(n), *(f"{v:.9f}" for v in (t, *a, *p * 1000.0))]))
    path.write_text("\n".join(lines) + "\n")
    return path


def write_nexus(path: Path) -> Path:
    """Trajectories of Nexus; the frames begin at 31."""
    rows = [
        ",".join([str(n + 31), "0", *(f"{v * 1000:.6f}" for v in each.ravel())])
        for n, each in enumerate(markers())
    ]
    head = [
        "Trajectories", f"{RATE:g}", ",," + ",,,".join(NAMES) + ",,",
        "Frame,Sub Frame" + ",X,Y,Z" * 4, "," + ",mm" * 12,
    ]  # fmt: skip
    path.write_text("\r\n".join([*head, *rows]) + "\r\n")
    return path


def write_segments(path: Path, *, rotations: str = "helical", unit: str = "deg") -> Path:
    """A segment of Nexus, with a section that is not read before it."""
    turn = {
        "helical": TURNS.as_rotvec(),
        "euler_xyz": TURNS.as_euler("XYZ"),
        "quaternion": TURNS.as_quat(),
    }[rotations]
    turn = np.degrees(turn) if unit == "deg" else turn
    axes = [*("RX", "RY", "RZ", "RW")[: turn.shape[1]], "TX", "TY", "TZ"]
    head = [
        "Devices", "1000", ",,Plate", "Frame,Sub Frame,Fx", ",,N", "1,0,3.5", "1,1,3.5", "",
        "Segments", f"{RATE:g}", ",,hand:hand" + "," * (len(axes) - 1),
        ",".join(["Frame", "Sub Frame", *axes]), "," + f",{unit}" * (len(axes) - 3) + ",mm" * 3,
    ]  # fmt: skip
    rows = [
        ",".join([str(n + 1), "0", *(f"{v:.9f}" for v in (*a, *p * 1000.0))])
        for n, (a, p) in enumerate(zip(turn, PLACES, strict=True))
    ]
    path.write_text("\n".join([*head, *rows]) + "\n")
    return path


def write_npz(path: Path) -> Path:
    np.savez_compressed(
        path, names=np.array(["hand"]), p=PLACES[:, None], q=TURNS.as_quat()[:, None], fps=RATE
    )
    return path


NPZ = {
    "fps": "fps",
    "arrays": [{"names": "names", "positions": "p", "quaternions": "q", "order": "xyzw"}],
}


def write_json(path: Path) -> Path:
    samples = [
        {"timeStamp": round(t * 1000), "rotation": m.tolist(), "translation": p.tolist()}
        for t, m, p in zip(TIMES, TURNS.as_matrix(), PLACES, strict=True)
    ]
    path.write_text(json.dumps(samples))
    return path


def write_c3d(path: Path) -> Path:
    import ezc3d

    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [RATE]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(NAMES)
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    points = np.ones((4, 4, FRAMES))
    points[:3] = markers().transpose(2, 1, 0) * 1000
    file["data"]["points"] = points
    file.write(str(path))
    return path


def write_bag(path: Path, *, since_s: int = 1000) -> Path:
    """A ROS 1 bag of stamped poses on the topic /hand, from that many seconds after 1970 on."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    kinds = store.types
    with Writer(path) as writer:
        line = writer.add_connection("/hand", "geometry_msgs/msg/PoseStamped", typestore=store)
        for n, (t, p, q) in enumerate(zip(TIMES, PLACES, TURNS.as_quat(), strict=True)):
            stamp = kinds["builtin_interfaces/msg/Time"](sec=since_s, nanosec=round(t * 1e9))
            header = kinds["std_msgs/msg/Header"](seq=n, stamp=stamp, frame_id="world")
            pose = kinds["geometry_msgs/msg/Pose"](
                kinds["geometry_msgs/msg/Point"](*map(float, p)),
                kinds["geometry_msgs/msg/Quaternion"](*map(float, q)),
            )
            message = kinds["geometry_msgs/msg/PoseStamped"](header, pose)
            data = store.serialize_ros1(message, "geometry_msgs/msg/PoseStamped")
            writer.write(line, 10**12 + n, data)
    return path


def write_bag2(path: Path, *, storage: str = "SQLITE3") -> Path:
    """A ROS 2 bag of transforms, child frame ``hand``."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    kinds = store.types
    with Writer(path, version=8, storage_plugin=StoragePlugin[storage]) as writer:
        line = writer.add_connection("/tf", "tf2_msgs/msg/TFMessage", typestore=store)
        for n, (t, p, q) in enumerate(zip(TIMES, PLACES, TURNS.as_quat(), strict=True)):
            stamp = kinds["builtin_interfaces/msg/Time"](sec=1000, nanosec=round(t * 1e9))
            header = kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="world")
            part = kinds["geometry_msgs/msg/Transform"](
                kinds["geometry_msgs/msg/Vector3"](*map(float, p)),
                kinds["geometry_msgs/msg/Quaternion"](*map(float, q)),
            )
            one = kinds["geometry_msgs/msg/TransformStamped"](header, "hand", part)
            data = store.serialize_cdr(
                kinds["tf2_msgs/msg/TFMessage"]([one]), "tf2_msgs/msg/TFMessage"
            )
            writer.write(line, 10**12 + n, data)
    return path


WRITERS: dict[str, tuple[str, Callable[[Path], Path]]] = {
    "c3d": ("m.c3d", write_c3d),
    "bvh": ("m.bvh", write_bvh),
    "bag": ("m.bag", write_bag),
    "tsv": ("m.tsv", write_tsv),
    "tsv6d": ("m6.tsv", write_tsv_6d),
    "trc": ("m.trc", write_trc),
    "trc spaces": ("m2.trc", write_trc_spaces),
    "motive": ("motive.csv", write_motive),
    "nexus": ("nexus.csv", write_nexus),
    "segments": ("segments.csv", write_segments),
    "csv": ("m.csv", write_csv),
    "npz": ("m.npz", write_npz),
    "json": ("m.json", write_json),
}
"""Every format that is one file, by a name of its own."""


def options(kind: str) -> dict[str, object]:
    """What must be said about a sample of this kind."""
    return dict(NPZ) if kind == "npz" else {}


def zip_bomb(path: Path, member: str, megabytes: int) -> Path:
    """A zip archive whose one member expands to so many megabytes of zeros."""
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open(member, "w") as file,
    ):
        for _ in range(megabytes):
            file.write(bytes(1 << 20))
    return path


def write_c3d_rotations(path: Path) -> Path:
    """A C3D whose bodies are 4x4 matrices: no markers, one rotation."""
    import struct

    def entry(number: int, name: str, kind: int, sizes: list[int], data: bytes) -> bytes:
        body = struct.pack("bB", kind, len(sizes)) + bytes(sizes) + data + b"\0"
        head = struct.pack("bb", len(name), number) + name.encode()
        return head + struct.pack("<h", len(body) + 2) + body

    def group(number: int, name: str) -> bytes:
        return struct.pack("bb", len(name), -number) + name.encode() + struct.pack("<hB", 3, 0)

    section = b"\x01\x50\x01\x54"
    section += group(1, "POINT") + entry(1, "USED", 2, [], struct.pack("<H", 0))
    section += group(2, "ROTATION") + entry(2, "USED", 2, [], struct.pack("<H", 1))
    section += entry(2, "DATA_START", 2, [], struct.pack("<H", 3))
    section += entry(2, "LABELS", -1, [4, 1], b"hand")
    header = struct.pack("<BB4HH", 2, 0x50, 0, 0, 1, FRAMES, 0)
    header += struct.pack("<fHHf", -1.0, 3, 0, RATE)
    matrices = np.tile(np.eye(4), (FRAMES, 1, 1))
    matrices[:, :3, :3], matrices[:, :3, 3] = TURNS.as_matrix(), PLACES
    rows = np.concatenate(
        [matrices.transpose(0, 2, 1).reshape(FRAMES, 16), np.ones((FRAMES, 1))], axis=1
    )
    path.write_bytes(
        header.ljust(512, b"\0") + section.ljust(512, b"\0") + rows.astype("<f4").tobytes()
    )
    return path


def recordings_folder() -> Path:
    """The folder of real recordings, or the test is skipped."""
    import os

    import pytest

    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("CAPAR_DATA") or beside)
    if not folder.is_dir():
        pytest.skip("no folder of recordings: set CAPAR_DATA")
    return folder
