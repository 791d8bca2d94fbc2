"""What is kept of a live recording until it ends, on disk: memory does not grow with it."""

import pickle
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from tempfile import TemporaryFile
from typing import IO, Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import Stream
from capar.pipelines.live.frames import Window
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.bodies.poses import Poses

PLACE, TURN = 3, 4
"""Numbers of a position and of an orientation [1]."""

POSE = PLACE + TURN


class PosesFile:
    """Settled poses of every body that moves, frame by frame, in a file without a name.

    A frame holds its time, and of each body its pose as recorded, gaps filled, and low-passed. Of a
    body that rests throughout one place is kept, in memory.
    """

    def __init__(self) -> None:
        self._file = _file()
        self._moving: tuple[str, ...] | None = None
        self._resting: dict[str, Float[np.ndarray, "3"]] = {}
        self._frames = 0

    def add(self, window: Window, bodies: Bodies, first: int, last: int) -> None:
        """Keep some frames of a measured window.

        Args:
            window: The window.
            bodies: Its bodies.
            first: The first of the frames, in the recording.
            last: The last one.
        """
        part = slice(first - window.first, last - window.first + 1)
        poses = bodies.poses
        if self._moving is None:
            self._moving = tuple(name for name, pose in sorted(poses.items()) if not pose.rests)
        rows = [window.capture.times[part][:, None]]
        for name in self._moving:
            for stream in (poses[name].filled, poses[name].smooth):
                rows += [stream.positions[part], stream.orientations[part]]
        for name, pose in poses.items():
            known = pose.settled.positions[part]
            known = known[~np.isnan(known[:, 0])]
            if pose.rests and len(known):
                self._resting.setdefault(name, known[0].copy())
        table = np.concatenate(rows, axis=1)
        self._file.write(table.tobytes())
        self._frames += len(table)

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        """The time of every frame [s]."""
        return np.array(self._table()[:, 0])

    def bodies(self, last: Bodies) -> Bodies:
        """The bodies through all kept frames; their poses are read from disk as they are asked for.

        Args:
            last: The bodies of the last window, for all else; of fixed ones also their poses.
        """
        table = self._table()
        times = np.array(table[:, 0])
        columns = {name: 1 + 2 * POSE * at for at, name in enumerate(self._moving or ())}

        def whole(pose: Poses) -> Poses:
            if pose.still:
                held = _held(pose.filled, times)
                return replace(pose, filled=held, smooth=held, settled=held, longer=None)
            at = columns[pose.name]
            filled, smooth = _stream(table, times, at), _stream(table, times, at + POSE)
            settled = smooth if pose.settled is pose.smooth else filled
            return replace(pose, filled=filled, smooth=smooth, settled=settled, longer=None)

        def longer(known: Mapping[str, BodyGeometry]) -> dict[str, BodyGeometry]:
            return {
                name: replace(body, poses=whole(body.poses)) if body.poses.fixed is None else body
                for name, body in known.items()
            }

        return Bodies(longer(last.sensors), longer(last.objects), last.parts)

    def place(self, name: str) -> Float[np.ndarray, "3"]:
        """Where a body that rests is [m]; NaN if it was never seen."""
        return self._resting.get(name, np.full(PLACE, np.nan))

    def _table(self) -> Float[np.ndarray, "frames numbers"]:
        self._file.flush()
        width = 1 + 2 * POSE * len(self._moving or ())
        return np.memmap(self._file, dtype=np.float64, mode="r", shape=(self._frames, width))


def _stream(
    table: Float[np.ndarray, "frames numbers"], times: Float[np.ndarray, "frames"], at: int
) -> Stream:
    turn = at + PLACE
    return Stream.of_checked(times, table[:, at:turn], table[:, turn : turn + TURN])


def _file() -> IO[bytes]:
    """A file that is gone as soon as nothing reads it."""
    return TemporaryFile()


def _held(stream: Stream, times: Float[np.ndarray, "frames"]) -> Stream:
    """The one pose of a stream through a whole recording."""
    seen = int(np.argmin(stream.lost))
    positions = np.broadcast_to(stream.positions[seen], (len(times), PLACE))
    orientations = np.broadcast_to(stream.orientations[seen], (len(times), TURN))
    return Stream.of_checked(times, positions, orientations)


class ValuesFile:
    """Values in a file without a name, in the order in which they were added."""

    def __init__(self) -> None:
        self._file = _file()

    def add(self, values: Sequence[Any]) -> int:
        """Keep some values.

        Returns:
            Where they are, for ``at``.
        """
        place = self._file.seek(0, 2)
        pickle.dump(values, self._file, protocol=pickle.HIGHEST_PROTOCOL)
        return place

    def at(self, place: int) -> Sequence[Any]:
        """The values that were kept at a place."""
        self._file.seek(place)
        return list(pickle.load(self._file))

    def __iter__(self) -> Iterator[Any]:
        """All values."""
        end = self._file.seek(0, 2)
        self._file.seek(0)
        while self._file.tell() < end:
            here = pickle.load(self._file)
            place = self._file.tell()
            yield from here
            self._file.seek(place)
