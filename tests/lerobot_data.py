"""A data set written, and subtasks read back, by the package lerobot in its own environment.

``PYTHON lerobot_data.py write FOLDER FRAMES...`` writes a data set with an episode of so many
frames each; ``read FOLDER`` prints as JSON the subtask of each frame as lerobot resolves it.
"""

import json
import sys
from pathlib import Path


def write(folder: Path, episodes: list[int]) -> None:
    from lerobot.datasets import LeRobotDataset

    features = {"observation.state": {"dtype": "float32", "shape": (3,), "names": ["a", "b", "c"]}}
    made = LeRobotDataset.create("own/data", fps=30, features=features, root=folder)
    import numpy as np

    for frames in episodes:
        for frame in range(frames):
            state = np.array([frame, 0.5, 0.0], np.float32)
            made.add_frame({"observation.state": state, "task": "drink"})
        made.save_episode()
    made.finalize()


def read(folder: Path) -> list[dict[str, object]]:
    from lerobot.datasets import LeRobotDataset
    from lerobot.datasets.language import LANGUAGE_EVENTS, LANGUAGE_PERSISTENT
    from lerobot.datasets.language_render import active_at

    data = LeRobotDataset("own/data", root=folder)
    rows = []
    for item in (data[n] for n in range(len(data))):
        time_s, own = float(item["timestamp"]), item[LANGUAGE_PERSISTENT]
        active = active_at(time_s, persistent=own, style="subtask")
        rows.append({
            "episode": int(item["episode_index"]), "time_s": time_s,
            "subtask": active and active["content"],
            "since_s": active and active["timestamp"], "rows": len(own),
            "events": len(item[LANGUAGE_EVENTS]), "state": item["observation.state"].tolist(),
        })  # fmt: skip
    return rows


if __name__ == "__main__":
    mode, folder, *numbers = sys.argv[1:]
    if mode == "write":
        write(Path(folder), list(map(int, numbers)))
    else:
        sys.stdout.write(json.dumps(read(Path(folder))))
