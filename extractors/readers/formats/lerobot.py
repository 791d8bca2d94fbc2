"""LeRobot data sets of version 3: features whose meaning capture.toml states, by episodes."""

import hashlib
import json
import math
import re
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from capar.model.capture import Source
from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import arrow, check_file, read_text
from extractors.readers.formats.npz import NAMING, Arrays
from extractors.readers.recording import Recording, unrounded

OPTIONS = frozenset({"arrays", "episode"})
"""``arrays``: as of NPZ, of features or parts of them; ``episode``: its number."""

INFO = Path("meta") / "info.json"
EPISODES = Path("meta") / "episodes"
OWN = {"timestamp", "frame_index", "episode_index", "index", "task_index"}
"""Features of every data set, which are no one's poses."""

EXAMPLE = """

unit = "m"
up = "z"

[files.robot]
path = "."
arrays = [{{ body = "gripper", {mapping} }}]

[[sensor]]
name = "gripper"
end_effector = "hand"
{tracked}
"""


def recognises(path: Path, head: bytes) -> bool:
    """Whether it is the folder of a data set, of whatever version."""
    return path.is_dir() and (path / INFO).is_file()


def read(path: Path, options: Mapping[str, Any]) -> Recording:
    """The bodies and points of one episode that the options name.

    Raises:
        FileError: No feature is mapped, one holds no numbers, or a file is missing or damaged.
        UnknownNameError: There is no such feature, component or episode.
    """
    info = _info(path)
    features = {name: each for name, each in info["features"].items() if name not in OWN}
    groups = options.get("arrays")
    if not groups:
        raise _unmapped(path, features)
    stated = (group[key] for group in groups for key in NAMING if key in group)
    wanted = list(dict.fromkeys(str(part).partition("[")[0] for part in stated))
    for name in wanted:
        if name not in features:
            raise UnknownNameError("feature", name, features, where=str(path))
        if not _numeric(features[name]):
            problem = f"{_described(name, features[name])} holds no numbers."
            raise FileError(path, problem, "Poses are features of numbers.")
    file, episode, frames = _place(path, info, options.get("episode"))
    parquet = import_module("pyarrow.parquet")
    for name in wanted:
        if name not in parquet.read_schema(file).names:
            raise FileError(file, f"has no column {name!r}, which {INFO} declares.", "Copy again.")
    columns = ["timestamp", *wanted]
    chosen = [("episode_index", "=", episode)]
    table = parquet.read_table(file, columns=columns, filters=chosen, partitioning=None)
    if table.num_rows != frames:
        problem = f"has {table.num_rows} frames of episode {episode}; {EPISODES} states {frames}."
        raise FileError(file, problem, "Copy the data set again.")
    values = {name: _array(file, table[name], name, features[name]) for name in wanted}
    times = np.asarray(table["timestamp"].to_numpy(), dtype=float)
    digest = hashlib.sha256(times.tobytes())
    for name, array in values.items():
        digest.update(name.encode() + array.tobytes())
    return Arrays(
        path, "feature", values, {name: _components(features[name]) for name in wanted}
    ).recording(
        Source(str(path), "lerobot", digest.hexdigest()), groups, unrounded(times, info.get("fps"))
    )


def episodes(path: Path) -> list[str]:
    """The numbers of a data set's episodes, in order.

    Raises:
        FileError: It is of another version, lists none, or pyarrow is not installed.
    """
    _info(path)
    return [str(row["episode_index"]) for row in _listed(path)]


def _info(path: Path) -> dict[str, Any]:
    """What the data set says of itself.

    Raises:
        FileError: It is of another version.
    """
    info: dict[str, Any] = json.loads(read_text(path / INFO))
    version = str(info.get("codebase_version", "no version"))
    if version.removeprefix("v").partition(".")[0] != "3":
        convert = f"convert_dataset_v21_to_v30 --repo-id=ID --root={path} --push-to-hub=false"
        remedy = "It is converted by: python -m lerobot.scripts." + convert
        raise FileError(
            path,
            f"is a LeRobot data set of {version}; v3.0 is read.",
            remedy * (version[:2] == "v2"),
        )
    return info


def _listed(path: Path) -> list[dict[str, int]]:
    """Each episode's number, length and file."""
    arrow()
    parquet = import_module("pyarrow.parquet")
    columns = ["episode_index", "length", "data/chunk_index", "data/file_index"]
    rows: list[dict[str, int]] = []
    for file in sorted((path / EPISODES).rglob("*.parquet")):
        rows += parquet.ParquetFile(file).read(columns).to_pylist()
    if not rows:
        raise FileError(path / EPISODES, "lists no episode.", "Copy the data set again.")
    return sorted(rows, key=lambda row: row["episode_index"])


def _place(path: Path, info: Mapping[str, Any], stated: str | None) -> tuple[Path, int, int]:
    """The file, the number and the frames of an episode; of the only one, if none is stated."""
    listed = {str(each["episode_index"]): each for each in _listed(path)}
    if stated is None and len(listed) > 1:
        problem = f"holds {len(listed)} episodes, and none is named."
        remedy = 'Say episode = "{take}", or leave out takes: then each is one.'
        raise FileError(path, problem, remedy)
    episode = next(iter(listed)) if stated is None else stated
    if episode not in listed:
        raise UnknownNameError("episode", episode, listed, where=str(path))
    row = listed[episode]
    file = path / info["data_path"].format(
        chunk_index=row["data/chunk_index"], file_index=row["data/file_index"]
    )
    check_file(file)
    return file, row["episode_index"], row["length"]


def _array(file: Path, column: Any, name: str, feature: Mapping[str, Any]) -> np.ndarray:
    """A column as an array of frames by the feature's shape."""
    found = column.combine_chunks()
    found = getattr(found, "storage", found)
    while hasattr(found, "flatten") and hasattr(found.type, "value_type"):
        found = found.flatten()
    values = found.to_numpy(zero_copy_only=False)
    frames, shape = len(column), tuple(feature["shape"])
    if values.size != frames * math.prod(shape):
        problem = f"has {values.size} numbers in {frames} frames of {_described(name, feature)}."
        raise FileError(file, problem, "Copy the data set again.")
    return np.asarray(values.reshape(frames, *shape))


def _numeric(feature: Mapping[str, Any]) -> bool:
    return str(feature["dtype"]).startswith(("float", "int", "uint"))


def _components(feature: Mapping[str, Any]) -> list[str]:
    """Names of the numbers of a feature, a list or lists by what they belong to; maybe none."""
    names = feature.get("names") or []
    lists = names.values() if isinstance(names, dict) else [names]
    flat = [str(each) for some in lists for each in (some if isinstance(some, list) else [some])]
    return flat if len(flat) == feature["shape"][-1] else []


def _described(name: str, feature: Mapping[str, Any]) -> str:
    """A feature with its type, shape and components."""
    shape, names = ", ".join(map(str, feature["shape"])), _components(feature)
    shown = f" [{','.join(names)}]" if names and _numeric(feature) else ""
    return f"{name} {feature['dtype']} ({shape}){shown}"


def _start(feature: Mapping[str, Any]) -> int | None:
    """Where x, y and z may begin in a feature: by its components' names, or if it has none at 0."""
    names = [re.split(r"[^a-z]", each.lower())[-1] for each in _components(feature)]
    if not _numeric(feature) or feature["shape"][-1] < 3 or (names and "x" not in names):
        return None
    return names.index("x") if names else 0


def _unmapped(path: Path, features: Mapping[str, Mapping[str, Any]]) -> FileError:
    """What there is, and the capture.toml that would say what of it is a pose."""
    listed = "".join(f"\n  {_described(name, each)}" for name, each in features.items())
    starts = {name: at for name, each in features.items() if (at := _start(each)) is not None}
    if not starts:
        problem = "seems to hold no poses, which have x, y and z; angles of joints are none."
        return FileError(path, problem, f"Its features:{listed}")
    name = max(starts, key=lambda n: ("state" in n or "pose" in n, features[n]["shape"][-1]))
    turn = starts[name] + 3
    rest = features[name]["shape"][-1] - turn
    mapping = f'positions = "{name}[{turn - 3}:{turn}]"'
    if rest > 2 and "yaw" in ",".join(_components(features[name])).lower():
        mapping += f', rotations = "{name}[{turn}:{turn + 3}]", order = "rpy"'
    elif rest == 3:
        mapping += f', rotations = "{name}[{turn}:{turn + 3}]", order = "helical"'
    elif rest > 3:
        mapping += f', quaternions = "{name}[{turn}:{turn + 4}]", order = "xyzw"'
    where = f"Say it in {path / 'capture.toml'}, like this:"
    return FileError(
        path,
        f"does not say which of its features are poses:{listed}\n{where}",
        EXAMPLE.format(
            mapping=mapping, tracked='body = "gripper"' if rest > 2 else 'markers = ["gripper"]'
        ),
    )
