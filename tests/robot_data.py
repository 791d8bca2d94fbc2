"""Data sets in the layout of LeRobot, written by pyarrow."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from bundles import DRINKING
from scipy.spatial.transform import Rotation

from extractors.readers.registry import read_recording


def robot_data(folder: Path, *, existing: bool = False) -> Path:
    """A LeRobot data set of two episodes in one file, 30 frames a second."""
    rows: dict[str, list[Any]] = {name: [] for name in ("observation.state", "timestamp",
        "frame_index", "episode_index", "index", "task_index")}  # fmt: skip
    for episode, frames in ((0, 20), (3, 130)):
        for frame in range(frames):
            values = ([float(frame), 0.5], frame / 30.0, frame, episode, len(rows["index"]), 0)
            for own, value in zip(rows.values(), values, strict=True):
                own.append(value)
    table = pa.table(rows).set_column(1, "timestamp", pa.array(rows["timestamp"], pa.float32()))
    if existing:
        kept = [{"role": "assistant", "content": text, "style": style, "timestamp": 0.0,
                 "camera": None, "tool_calls": None}
                for text, style in (("drink", "plan"), ("old", "subtask"))]  # fmt: skip
        table = table.append_column("language_persistent", pa.array([kept] * table.num_rows))
    (folder / "data" / "chunk-000").mkdir(parents=True)
    (folder / "meta").mkdir()
    (folder / "videos").mkdir()
    (folder / "videos" / "a.mp4").write_bytes(b"film")
    pq.write_table(table, folder / "data" / "chunk-000" / "file-000.parquet")
    info = {"codebase_version": "v3.0", "fps": 30, "features": {"timestamp": {"dtype": "float32"}}}
    (folder / "meta" / "info.json").write_text(json.dumps(info))
    return folder


def motion_data(
    folder: Path,
    episodes: Sequence[Mapping[str, np.ndarray]],
    *,
    names: Mapping[str, Any] | None = None,
    per_file: int = 2,
    version: str = "v3.0",
    fps: float = 50.0,
) -> Path:
    """A data set of single-precision features, so many episodes a file, two files a chunk.

    ``timestamp`` of an episode is its clock [s]; without it frames are ``fps`` a second. ``names``
    are those of components, by feature.
    """
    listed, files = [], {}
    for number, values in enumerate(episodes):
        length = len(next(iter(values.values())))
        place = divmod(number // per_file, 2)
        index = sum(each["length"] for each in listed)
        table = pa.table(
            {
                "timestamp": pa.array(
                    values.get("timestamp", np.arange(length) / fps), pa.float32()
                ),
                "frame_index": np.arange(length),
                "episode_index": np.full(length, number),
                "index": np.arange(index, index + length),
                "task_index": np.zeros(length, int),
                **{n: _column(v) for n, v in values.items() if n != "timestamp"},
            }
        )
        files.setdefault(place, []).append(table)
        listed.append({
            "episode_index": number, "tasks": ["drink"], "length": length,
            "data/chunk_index": place[0], "data/file_index": place[1],
            "dataset_from_index": index, "dataset_to_index": index + length,
        })  # fmt: skip
    for (chunk, file), tables in files.items():
        path = folder / "data" / f"chunk-{chunk:03d}" / f"file-{file:03d}.parquet"
        path.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.concat_tables(tables), path)
    (folder / "meta" / "episodes" / "chunk-000").mkdir(parents=True)
    path = folder / "meta" / "episodes" / "chunk-000" / "file-000.parquet"
    pq.write_table(pa.Table.from_pylist(listed), path)
    features: dict[str, Any] = {
        name: {
            "dtype": "float32", "shape": [1] if array.ndim == 1 else list(array.shape[1:]),
            "names": (names or {}).get(name),
        }
        for name, array in episodes[0].items()
    }  # fmt: skip
    features["observation.image"] = {"dtype": "video", "shape": [480, 640, 3], "names": None}
    info = {
        "codebase_version": version, "fps": fps, "features": features,
        "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
    }  # fmt: skip
    (folder / "meta" / "info.json").write_text(json.dumps(info))
    return folder


def demo_data(folder: Path, *, count: int) -> list[str]:
    """The shipped motion as a data set, its first episode half of it; the names of the others.

    ``observation.state`` is the right hand, with a rotation vector; ``observation.cup`` the mug,
    with a quaternion; ``observation.others`` all others.
    """
    own = read_recording(DRINKING / "motion.csv")
    poses = {
        name: np.column_stack([each.positions, np.roll(each.orientations, -1, axis=1)])
        for name, each in own.bodies.items()
    }
    hand, cup = poses.pop("right_hand"), poses.pop("mug")
    turns = Rotation.from_quat(hand[:, 3:]).as_rotvec()
    values = {
        "timestamp": own.times,
        "observation.state": np.column_stack([hand[:, :3], turns]),
        "observation.cup": cup,
        "observation.others": np.stack(list(poses.values()), axis=1),
    }
    half = {name: each[: len(each) // 2] for name, each in values.items()}
    names = {"observation.state": {"axes": ["x", "y", "z", "rx", "ry", "rz"]}}
    motion_data(folder, [half, *[values] * (count - 1)], names=names, fps=103)
    return list(poses)


def _column(array: np.ndarray) -> pa.Array:
    """Numbers, lists of one length, or lists of lists, as LeRobot writes them."""
    numbers = array.astype(np.float32)
    if numbers.ndim == 1:
        return pa.array(numbers)
    if numbers.ndim == 2:
        return pa.FixedSizeListArray.from_arrays(numbers.ravel(), numbers.shape[1])
    return pa.array(numbers.tolist(), pa.list_(pa.list_(pa.float32())))
