"""ROS 1 and ROS 2 bags: stamped poses, transforms and the rigid bodies of optical trackers."""

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from capar.model.capture import notice
from capar.model.errors import FileError
from extractors.readers.file_access import source_of
from extractors.readers.recording import Recording, iso_of_stamp, track

Sample = tuple[str, int, tuple[float, ...]]
"""A body's name, its time stamp [ns], and x y z then w x y z; NaN where it was lost."""

_LOST = (float("nan"),) * 7


def recognises(path: Path, head: bytes) -> bool:
    """Whether it is a ROS 1 bag, a folder with a ROS 2 bag, or a file of one, with it or alone."""
    if path.is_dir():
        return (path / "metadata.yaml").is_file()
    storage = head.startswith((b"\x89MCAP0\r\n", b"SQLite format 3\0"))
    alone = path.suffix in {".mcap", ".db3"}  # the library goes by it
    return head.startswith(b"#ROSBAG V2") or (storage and (alone or _folder(path).is_dir()))


def _folder(path: Path) -> Path:
    return path.parent if (path.parent / "metadata.yaml").is_file() else path


def read(path: Path, options: Any) -> Recording:
    """The bodies of a bag, in metres; time starts at the earliest stamp.

    Raises:
        FileError: The bag is damaged or holds no message of a kind that is read.
    """
    samples: dict[str, dict[int, tuple[float, ...]]] = defaultdict(dict)
    doubled = 0
    for name, stamp, pose in _samples(path):
        doubled += stamp in samples[name]
        if stamp not in samples[name] or pose is not _LOST:
            samples[name][stamp] = pose
    if not samples:
        raise FileError(path, f"no message of a kind that is read here: {', '.join(_KINDS)}.")
    start = min(min(each) for each in samples.values())
    bodies = {}
    for name, poses in sorted(samples.items()):
        values = np.array(list(poses.values()))
        seconds = np.array([(stamp - start) * 1e-9 for stamp in poses])
        bodies[name] = track(name, seconds, values[:, :3], values[:, 3:])
    file = path
    if path.is_dir():
        storage = sorted(each for each in path.iterdir() if each.suffix in {".db3", ".mcap"})
        file = storage[0] if storage else path / "metadata.yaml"
    return Recording(
        source=source_of(file, "rosbag", recorded_at=iso_of_stamp(start)),
        bodies=bodies,
        unit_m=1.0,
        notices=(notice("doubled-stamps", samples=doubled),) if doubled else (),
    )


def _samples(path: Path) -> Iterator[Sample]:
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    place = path if path.is_dir() or path.suffix == ".bag" else _folder(path)
    store = get_typestore(Stores.ROS2_HUMBLE)
    with AnyReader([place], default_typestore=store) as bag:
        wanted = [each for each in bag.connections if each.msgtype in _KINDS]
        for connection, _, data in bag.messages(connections=wanted):
            message = bag.deserialize(data, connection.msgtype)
            for name, header, at, turn in _poses(connection.msgtype, connection.topic, message):
                stamp = int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)
                pose = at and (at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z)
                yield name, stamp, pose or _LOST


def _poses(kind: str, topic: str, message: Any) -> Iterator[tuple[str, Any, Any, Any]]:
    """Name, header, position and orientation of every body in a message; no pose where lost."""
    if kind.endswith("PoseStamped"):
        yield topic, message.header, message.pose.position, message.pose.orientation
    elif kind.endswith("NatNetFrame"):
        for body in message.rigid_bodies:
            pose = body.pose if body.track_valid else None
            yield body.name, message.header, pose and pose.position, pose and pose.orientation
    else:
        for each in getattr(message, "transforms", [message]):
            part = each.transform
            yield each.child_frame_id, each.header, part.translation, part.rotation


_KINDS = (
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/TransformStamped",
    "natnet_bridge/msg/NatNetFrame",
    "tf/msg/tfMessage",
    "tf2_msgs/msg/TFMessage",
)
