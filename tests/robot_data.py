"""A data set in the layout of LeRobot, written by pyarrow."""

import json
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq


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
