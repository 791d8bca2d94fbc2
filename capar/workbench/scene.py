"""A capture in the scene: bodies, contacts that light up, line of sight, and coloured trails."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from jaxtyping import Float

from capar.model.facts import LookingAt, Touching
from capar.model.observation import Observation
from capar.views.lanes import colour_of
from capar.views.lettering import Span
from capar.views.picture import kind_of
from capar.views.viewer.snapshot import MOST_NAMES
from capar.views.viewer.stage import (
    Stage,
    StagedBody,
    intervals,
    is_ground,
    known_steps,
    way,
    world_bounds,
)

Rgb = tuple[int, int, int]

LIT: Rgb = (232, 89, 12)
SIGHT: Rgb = (134, 100, 250)
PLAIN_TRAIL: Rgb = (140, 140, 140)
POINT_M = 0.015
"""Radius of a body without a surface [m]."""

FAINT = 0.35
TRAIL_M, CHOSEN_M = 0.004, 0.011
"""Thickness of trails, and of the part of the segment that is chosen [m]."""

STILL_M = 1e-4
"""A body that never goes farther is put in its place once [m]."""


def rgb(colour: str) -> Rgb:
    """A colour that is written as ``#rrggbb``."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


@dataclass
class _Node:
    """A body's node, and what of it is on the screens already."""

    body: StagedBody
    frame: viser.FrameHandle
    surface: Any
    label: viser.LabelHandle | None
    still: bool
    shown: bool = True
    lit: bool = False
    placed: bool = False


class StagedCapture:
    """Shows one capture below a node of the scene, moved along x by ``beside_m``."""

    def __init__(
        self, server: viser.ViserServer, path: str, stage: Stage, *, beside_m: float = 0.0
    ) -> None:
        self.stage = stage
        self._server, self._path = server, path
        self._root = server.scene.add_frame(path, show_axes=False, position=(beside_m, 0.0, 0.0))
        self._nodes: dict[str, _Node] = {}
        self._contacts, self._looks = intervals(None, Touching), intervals(None, LookingAt)
        self._sights: dict[str, viser.LineSegmentsHandle] = {}
        self._trails: list[viser.LineSegmentsHandle] = []
        self._chosen: viser.LineSegmentsHandle | None = None
        self._observation: Observation | None = None
        self.labels, self.trails, self.bodies = True, True, True
        self.live = False
        """Whether a tracker says where its bodies are, and not its own recording."""

        sensors = [each for each in stage.bodies if each.kind in ("sensor", "looks")]
        crowded = len(sensors) > MOST_NAMES
        for number, body in enumerate(stage.bodies):
            # An object that is also a sensor is shown once, as the object.
            named = body.kind in ("mobile", "fixed") or (body.kind != "body" and not crowded)
            self._nodes[body.name] = self._node(f"{path}/b{number}", body, named=named)

    def _node(self, path: str, body: StagedBody, *, named: bool) -> _Node:
        scene = self._server.scene
        frame = scene.add_frame(path, show_axes=False)
        colour, opacity = rgb(body.colour), FAINT if body.faint else None
        surface: Any
        if body.shape is None:
            surface = scene.add_icosphere(f"{path}/surface", radius=POINT_M, color=colour)
        else:
            surface = scene.add_mesh_simple(
                f"{path}/surface", np.array(body.shape.vertices), np.array(body.shape.faces),
                color=colour, opacity=opacity, flat_shading=True, side="double",
                cast_shadow=False, receive_shadow=False,
            )  # fmt: skip
        label = None
        if named and not is_ground(body):
            label = scene.add_label(f"{path}/label", body.label, font_screen_scale=0.8)
        spread = np.ptp(body.positions, axis=0).max(initial=0.0) + np.ptp(
            body.orientations, axis=0
        ).max(initial=0.0)
        return _Node(body, frame, surface, label, still=bool(spread < STILL_M))

    def remove(self) -> None:
        """Take everything out of the scene."""
        self._root.remove()

    def find(self, observation: Observation) -> None:
        """Show what was found: contacts, looks, and trails coloured by segments."""
        self._observation = observation
        self._contacts = intervals(observation, Touching)
        self._looks = intervals(observation, LookingAt)
        scene = self._server.scene
        points = np.zeros((1, 2, 3))
        for number, who in enumerate(sorted({pair[0] for pair in self._looks.pairs})):
            self._sights[who] = scene.add_line_segments(
                f"{self._path}/sight{number}", points, SIGHT, thickness=0.006, visible=False
            )
        for number, link in enumerate(observation.links):
            body = self._nodes.get(link.ee)
            if body is None:
                continue
            colours = np.full((len(self.stage.times), 3), PLAIN_TRAIL, dtype=np.uint8)
            for each in link.segments:
                now = (self.stage.times >= each.start_s) & (self.stage.times < each.end_s)
                colours[now] = rgb(colour_of(Span(0.0, 0.0, each.name, kind_of(each))))
            lines, kept = way(body.body), known_steps(body.body)
            made = lines, np.repeat(colours[:-1][kept][:, None], 2, axis=1)
            if len(lines):
                self._trails.append(
                    scene.add_line_segments(
                        f"{self._path}/trail{number}", *made, thickness=TRAIL_M,
                        visible=self.trails,
                    )
                )  # fmt: skip

    def choose(self, ee: str, start_s: float, end_s: float, colour: str) -> None:
        """Draw the way of a segment thicker; one before is drawn as others again."""
        if self._chosen is not None:
            self._chosen.remove()
            self._chosen = None
        node = self._nodes.get(ee)
        if node is None:
            return
        now = (self.stage.times >= start_s) & (self.stage.times <= end_s)
        lines = way(node.body, now)
        if len(lines):
            self._chosen = self._server.scene.add_line_segments(
                f"{self._path}/chosen", lines, rgb(colour), thickness=CHOSEN_M
            )

    def set_visible(self, *, labels: bool, trails: bool, bodies: bool) -> None:
        """Which kinds of things are shown."""
        self.labels, self.trails, self.bodies = labels, trails, bodies
        for node in self._nodes.values():
            if node.label is not None:
                node.label.visible = labels
            if node.body.kind == "body":
                node.frame.visible = bodies and node.shown
        for trail in self._trails:
            trail.visible = trails

    def position(self, name: str, time_s: float) -> Float[np.ndarray, "3"] | None:
        """Where a body is shown at a time [m]; None where it is lost or unknown."""
        node = self._nodes.get(name)
        if node is None:
            return None
        place = node.body.positions[self._frame(time_s)] + np.array(self._root.position)
        return None if np.isnan(place[0]) else np.asarray(place)

    def touching(self, time_s: float) -> list[tuple[str, str]]:
        """The pairs of bodies that touch at a time."""
        return self._contacts.at(time_s)

    def show(self, time_s: float) -> None:
        """Put every body where it was at a time [s], and light up what touches."""
        if self.live:
            return
        frame = self._frame(time_s)
        lit = {name for pair in self.touching(time_s) for name in pair}
        for name, node in self._nodes.items():
            body = node.body
            known = not np.isnan(body.positions[frame, 0])
            shown = known and (self.bodies or body.kind != "body")
            if shown != node.shown:
                node.frame.visible = node.shown = shown
            if known and not (node.still and node.placed):
                node.frame.position = body.positions[frame]
                node.frame.wxyz = body.orientations[frame]
                node.placed = True
            bright = name in lit and body.kind != "fixed"
            if bright != node.lit:
                node.surface.color = LIT if bright else rgb(body.colour)
                node.lit = bright
        self._show_sights(time_s)

    def put(self, poses: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> None:
        """Put bodies where a tracker sees them: position [m] and quaternion w x y z, by name."""
        for name, (position, orientation) in poses.items():
            node = self._nodes.get(name)
            if node is None:
                continue
            node.shown = node.frame.visible = bool(np.isfinite(position[0]))
            if node.shown:
                node.frame.position, node.frame.wxyz = position, orientation
            node.placed = False

    def _show_sights(self, time_s: float) -> None:
        base = np.array(self._root.position)
        lines: dict[str, list[Any]] = {}
        for who, what in self._looks.at(time_s):
            ends = self.position(who, time_s), self.position(what, time_s)
            if ends[0] is not None and ends[1] is not None:
                lines.setdefault(who, []).append((ends[0] - base, ends[1] - base))
        for who, line in self._sights.items():
            found = lines.get(who)
            if line.visible != bool(found):
                line.visible = bool(found)
            if found:
                line.points = np.array(found, dtype=np.float32)

    def _frame(self, time_s: float) -> int:
        """The frame that is shown at a time: the nearest one."""
        times = self.stage.times
        at = int(np.searchsorted(times, time_s))
        if at <= 0 or at >= len(times):
            return min(max(at, 0), len(times) - 1)
        return at if times[at] - time_s < time_s - times[at - 1] else at - 1

    def bounds(self) -> Float[np.ndarray, "2 3"]:
        """Lowest and highest place where anything small is in the scene [m]."""
        return world_bounds(self.stage) + np.array(self._root.position)
