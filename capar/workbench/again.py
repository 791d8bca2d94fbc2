"""Do again: the action of a capture by another body, in another manner or scene, beside it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import viser

from capar.export.bvh import bvh_text
from capar.export.c3d import c3d_bytes
from capar.export.glb import glb_bytes
from capar.model.capture import Capture
from capar.model.errors import CaparError
from capar.pipelines.performance import Manner, perform_recorded
from capar.pipelines.recordings import Performed
from capar.pipelines.round_trips import SAME, body, observed_source
from capar.regeneration.captures import capture_of, capture_of_steps, write_motion, write_steps
from capar.regeneration.efforts import POLES, Effort
from capar.regeneration.quality import Gate
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source
from capar.regeneration.stepping import Approach
from capar.regeneration.styles import Kind
from capar.views import html
from capar.views.viewer.stage import StagedBody, body_parts, stage
from capar.workbench.window import OpenCapture, Panel

AGENTS = (SAME, "man", "woman", "child")
AS_RECORDED = "as recorded"
EXPORTS = {"BVH": ".bvh", "GLB": ".glb", "C3D": ".c3d"}


@dataclass(frozen=True, eq=False)
class Made:
    """What was performed, and as what a tracker would have recorded it."""

    of: OpenCapture
    source: Source
    agent: str
    done: Performed
    stepped: Approach | None
    capture: Capture


class Again(Panel):
    """Another performance of what was recorded."""

    title = "Do again"

    def build(self) -> None:
        """Add the controls."""
        gui = self.gui
        self._made: Made | None = None
        self._sources: dict[OpenCapture, Source] = {}
        self._handles: dict[str, viser.TransformControlsHandle] = {}
        self._beside = np.zeros(3)
        gui.add_html(html.note("Another body performs what the chosen capture shows."))
        self._agent = gui.add_dropdown("agent", AGENTS, initial_value="child")
        self._kind = gui.add_dropdown(
            "style", [str(each) for each in Kind],
            hint="What is kept: path (shape and timing), frame (scaled too), vel (timing), even.",
        )  # fmt: skip
        self._hand = gui.add_dropdown("hand", (AS_RECORDED, "right", "left"))
        self._duration = gui.add_number(
            "duration [s]", 0.0, min=0.0, step=0.1, hint="0: as recorded."
        )
        with gui.add_folder("Effort", expand_by_default=False):
            self._effort = {
                name: gui.add_slider(f"{low} - {high}", -1.0, 1.0, 0.1, 0.0)
                for name, (low, high) in POLES.items()
            }
        self._step = gui.add_checkbox("may step to what is out of reach", initial_value=False)
        with gui.add_folder("Scene", expand_by_default=False):
            gui.add_html(html.note("Drag things and tables; the performer stays where it stood."))
            self._scene_said = self.button("Show handles", self.show_handles)
            self.button("As recorded", self.hide_handles, self._scene_said, color="gray")
        self._said = self.button("Perform it", self.perform, icon=viser.Icon.PLAYER_PLAY)
        self._gates = gui.add_html("")
        with gui.add_folder("Save"):
            self._folder = gui.add_text("new folder", "performed")
            self._saved = self.button("Save it", lambda: self.save(self._folder.value))
            self._form = gui.add_dropdown("motion as", list(EXPORTS))
            self.button("Export the motion", self.export, self._saved)

    def captured(self) -> None:
        """Forget handles of another capture."""
        if self._handles:
            self.hide_handles()

    def manner(self) -> Manner:
        """How it is to be performed, as the controls say.

        Raises:
            CaparError: A value is none.
        """
        values = {name: slider.value for name, slider in self._effort.items()}
        seconds = float(self._duration.value)
        if not np.isfinite(seconds) or 0.0 < seconds < 0.1:
            raise CaparError(f"a duration of {seconds:g} s; it is at least 0.1 s, or 0")
        return Manner(
            Kind(self._kind.value),
            duration_s=seconds or None,
            hand="" if self._hand.value == AS_RECORDED else self._hand.value,
            effort=Effort(**values) if any(values.values()) else None,
            step=self._step.value,
        )

    def perform(self) -> str:
        """Perform it in the background, and show it next to the original."""
        window = self.window
        opened, _ = window.need()
        if opened.trial.others:
            raise CaparError(
                "several performers were recorded here; `capar regenerate` performs it with several"
            )
        manner, agent = self.manner(), self._agent.value
        moved = {name: each.position - self._beside for name, each in self._handles.items()}

        def work(report: Callable[[str, float], None]) -> Made:
            source = self._sources.get(opened)
            if source is None:
                report("finding what of it matters", 0.1)
                source = self._sources[opened] = observed_source(opened.trial)
            report("planning and verifying every frame", 0.3)
            where = _moved_scene(source, moved)
            stepped, done = perform_recorded(source, body(agent, source), where, manner)
            who = agent if agent != SAME else source.capture.agent.name
            name = f"{source.capture.name}_{who}"
            made = capture_of(done.motion, name=name, agent=who)
            return Made(opened, source, who, done, stepped, made)

        window.work(f"{agent} performs {opened.trial.name}", self._said, work, self.show)
        return ""

    def show(self, made: Made) -> None:
        """Show a performance beside the original, with its gates."""
        window = self.window
        self._made = made
        names = [each.trial.name for each in window.captures]
        number = next(n for n in range(1, 999) if f"{made.capture.name}_{n}" not in names)
        trial = replace(made.capture, name=f"{made.capture.name}_{number}")
        staged = stage(trial)
        bodies = (*staged.bodies, *_with_body(made, staged.times))
        shown = window.show(trial, staged=replace(staged, bodies=bodies))
        quality = made.done.quality
        gates = (*quality.gates, *(made.stepped.quality.gates if made.stepped else ()))
        passed = all(gate.passed for gate in gates)
        said = "every gate holds" if passed else "a gate does not hold; it is marked below"
        self._said.content = html.message(f"performed by {made.agent}: {said}", good=passed)
        self._gates.content = html.table(
            [_gate_row(each, made.source) for each in gates], ("gate", "value", "limit", "where")
        ) + "".join(html.note(each) for each in made.done.motion.plan.notes)
        if made.stepped is not None:
            self._gates.content += html.note(f"it steps first: {made.stepped.why}")
        window.seek(0.0)
        window.activate(shown)
        window.observe()

    def save(self, name: str) -> str:
        """Write the performance as a capture bundle in a new folder."""
        made = self._need()
        folder = self.window.folders.new(name)
        if made.stepped is not None:
            folder.mkdir()
            walked = capture_of_steps(made.stepped.steps, name="steps", agent=made.agent)
            write_steps(made.stepped.steps, walked, folder / "1_steps")
        write_motion(
            made.done.motion, made.capture, folder / "2_action" if made.stepped else folder
        )
        return f"saved {made.capture.name} as {self.window.folders.named(folder)}"

    def export(self) -> str:
        """Write the motion of the body to a file of another format."""
        made, name, form = self._need(), self._folder.value, self._form.value
        path = self.window.folders.new(f"{name}{EXPORTS[form]}")
        motion = made.done.motion
        plan = motion.plan
        values = plan.human, np.array(plan.source.times), motion.postures
        made_bytes = {
            "BVH": lambda: bvh_text(*values).encode(),
            "GLB": lambda: glb_bytes(*values),
            "C3D": lambda: c3d_bytes(*values),
        }[form]()
        path.write_bytes(made_bytes)
        return f"wrote {self.window.folders.named(path)}"

    def _need(self) -> Made:
        if self._made is None:
            raise CaparError("nothing was performed yet")
        return self._made

    def show_handles(self) -> str:
        """Put a handle on every thing and table of the scene."""
        opened, _ = self.window.need()
        source = self._sources.get(opened)
        if source is None:
            source = self._sources[opened] = observed_source(opened.trial)
        self.hide_handles()
        beside = np.array(opened.shown._root.position)
        for number, (name, thing) in enumerate(source.scene.things.items()):
            self._handles[name] = self.window.server.scene.add_transform_controls(
                f"/handle{number}", scale=0.25, disable_rotations=True,
                position=np.array(thing.place) + beside,
            )  # fmt: skip
        self._beside = beside
        return f"{len(self._handles)} things can be dragged"

    def hide_handles(self) -> None:
        """Take the handles away; then the recorded scene counts."""
        for handle in self._handles.values():
            handle.remove()
        self._handles.clear()


def _moved_scene(source: Source, moved: Mapping[str, np.ndarray]) -> Scene:
    """The recorded scene with the things where they were dragged to."""
    things = dict(source.scene.things)
    for name, place in moved.items():
        x, y, z = (float(value) for value in place)
        things[name] = replace(things[name], place=(x, y, z))
    return replace(source.scene, things=things) if moved else source.scene


def _with_body(made: Made, times: np.ndarray) -> tuple[StagedBody, ...]:
    """The performing body at some times."""
    motion = made.done.motion
    nearest = np.abs(times[:, None] - np.array(motion.plan.source.times)[None]).argmin(axis=1)
    human, postures = motion.fingered
    return body_parts(human, postures[nearest])


def _gate_row(gate: Gate, source: Source) -> tuple[str, ...]:
    sign = "at least" if gate.at_least else "at most"
    where = gate.bodies
    if gate.frame >= 0:
        where = f"{where} at {float(source.times[gate.frame]):.2f} s".strip()
    name = gate.name if gate.passed else f"✗ {gate.name}"
    return name, f"{gate.value:.2f} {gate.unit}", f"{sign} {gate.limit:g}", where
