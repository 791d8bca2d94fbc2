"""The window: its captures, its clock, and the parts that every panel uses."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import viser

from capar.model.capture import Capture
from capar.model.errors import CaparError, UnknownNameError
from capar.model.observation import Observation, Segment, SegmentAddress, find_segment
from capar.pipelines.explanation import Explained, explained
from capar.pipelines.language import segment_sentence
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.views import html
from capar.views.lanes import Lanes, colour_of
from capar.views.lettering import Span
from capar.views.picture import Row, kind_of, rows, spoken
from capar.views.viewer.stage import Stage, stage, world_bounds
from capar.workbench.folders import Folders
from capar.workbench.gate import Gate, address, guarded_server, stop
from capar.workbench.jobs import Jobs, problem
from capar.workbench.scene import StagedCapture
from capar_rules.authoring.user_rules import new_rules_folder, user_rules
from capar_rules.engine.profiles import Profile
from capar_rules.engine.profiles import profile as shipped
from capar_rules.lint.checking import admitted_profile
from extractors.readers.bundle.capture_toml import find_place, read_capture
from kb.lexicon.links import PrimitiveWords

TICK_S = 1.0 / 40.0
SLIDER_S = 0.1
"""While it plays, the slider follows so often [s]: it is slower to draw than the scene."""

MOMENT_S = 0.4
"""What takes less than this shows no progress bar [s]."""

PANEL_PX = 400
LEAST_PX, LANES_PX = 420, 325
"""The time line is at least so wide; in a low window it is so high, or half of it [px]."""

LONGEST_S = 24.0
"""A longer capture is shown in the lanes by pages of this length [s]."""

TOWARDS = np.array([0.9, -1.1, 0.6])
"""Where the camera looks from: in front of the performer, to the right and above."""

APART_M = 0.9
"""Captures stand so far from each other in the scene [m]."""


@dataclass(eq=False)
class OpenCapture:
    """A capture in the window."""

    place: str
    trial: Capture
    shown: StagedCapture
    seen: Explained | None = None
    """What was understood of it; None until it is observed."""

    rows: tuple[Row, ...] = ()
    words: tuple[PrimitiveWords, ...] = ()
    sentences: dict[tuple[str, int], str] = field(default_factory=dict)

    @property
    def observation(self) -> Observation | None:
        """What was observed, if it has been."""
        return self.seen.observation if self.seen else None


@dataclass(frozen=True)
class Settings:
    """What the window was opened with."""

    profile: str = "extended"
    rules: Path | None = None
    actionary: str | None = None
    dark: bool = False

    def rule_base(self) -> Profile:
        """The profile with the rules that people wrote, each checked by its text first."""
        added = user_rules(self.rules, actionary=self.actionary)
        return admitted_profile(self.profile, added=added) if added else shipped(self.profile)

    @property
    def rules_folder(self) -> Path:
        """Where a rule goes that is kept here."""
        return new_rules_folder(self.rules, actionary=self.actionary)


class Panel:
    """One tab of the window; each panel is made of controls that call what commands call."""

    title = ""

    def __init__(self, window: "Window") -> None:
        self.window = window
        self.gui: Any = window.server.gui  # viser's types take no new values

    def build(self) -> None:
        """Add the controls, inside of the panel's tab."""

    def button(
        self, label: str, act: Callable[[], str | None], where: Any = None, *, work: str = "",
        **look: Any,
    ) -> Any:  # fmt: skip
        """Add a button, and below it, if no place is given, one for what comes of it.

        What takes long is named by ``work``, and done in the background.
        """
        made = self.gui.add_button(label, **look)
        place = where or self.gui.add_html("")

        def done(said: str) -> None:
            place.content = html.message(said, good=True)

        def begin() -> None:
            self.window.work(work, place, lambda report: act(), done)

        made.on_click(self.window.guard(place, begin if work else act))
        return place

    def captured(self) -> None:
        """Another capture is looked at, or what is known of it has changed."""

    def chosen(self) -> None:
        """Another segment is chosen."""


class Window:
    """Everything that is open, and the one clock by which it is shown.

    Args:
        folders: What may be read and written.
        settings: Rules and Actionary.
        port: Where the window is served; 0 takes any free one.
    """

    def __init__(
        self, folders: Folders, settings: Settings | None = None, *, port: int = 0, token: str = ""
    ) -> None:
        self.folders, self.settings = folders, settings or Settings()
        self.gate = Gate(token)
        self.server = guarded_server(self.gate, port=port)
        self.captures: list[OpenCapture] = []
        self.active: OpenCapture | None = None
        self.segment: Segment | None = None
        self.time_s, self.speed = 0.0, 1.0
        self.playing, self.looping, self.following = False, False, ""
        self._waits, self._idle_s = False, 0.0
        self._job = self._job_shown = ("", 0.0)
        self.lock = threading.RLock()
        self.jobs = Jobs(self._show_job)
        self.updates = 0
        """How many moments were put on the screens."""

        self.panels: list[Panel] = []
        self._shown_s, self._slider_s = -1.0, 0.0
        self._size = (1000, 700)
        self._lanes: Lanes | None = None
        self._ended = threading.Event()
        self._layout()
        self._keys()
        self.server.on_client_connect(self._connected)
        self._clock = threading.Thread(target=self._run, name="clock", daemon=True)

    @property
    def address(self) -> str:
        """What a browser opens."""
        return address(self.server, self.gate)

    def add(self, kind: type[Panel]) -> None:
        """Add a panel; the first one starts the clock."""
        if not self.panels:
            with self._tabs_place:
                self._tabs = self.server.gui.add_tab_group()
            self._clock.start()
        panel = kind(self)
        with self._tabs.add_tab(kind.title):
            panel.build()
        self.panels.append(panel)
        self._tell("captured", panel)

    def wait(self) -> None:
        """Wait until it is closed."""
        while not self._ended.wait(1.0):
            pass

    def close(self) -> None:
        """End everything; what was saved stays."""
        self._ended.set()
        self.jobs.stop()
        self.jobs.wait(2.0)
        stop(self.server)

    # What is open -----------------------------------------------------------------------------

    def open(self, place: str, *, observe: bool = True) -> OpenCapture:
        """Read a capture and show it; then observe it, if nothing else is being done.

        Raises:
            CaparError: It cannot be read, or names files outside of the folders.
        """
        path, _ = find_place(place)
        self.folders.inside(path, beside=Path.cwd())
        self.folders.check_bundle(path.read_text("utf-8", errors="replace"), path.parent)
        opened = self.show(read_capture(place), place)
        if observe:
            self.observe()
        return opened

    def show(self, trial: Capture, place: str = "", *, staged: Stage | None = None) -> OpenCapture:
        """Put a capture into the scene, beside those that are there, and look at it."""
        with self.lock, self.server.atomic():
            number = max((int(c.shown._path[2:]) for c in self.captures), default=-1) + 1
            staged, beside = staged or stage(trial), 0.0
            if self.captures:
                right = max(float(each.shown.bounds()[1][0]) for each in self.captures)
                beside = right + APART_M - float(world_bounds(staged)[0][0])
            shown = StagedCapture(self.server, f"/c{number}", staged, beside_m=beside)
            opened = OpenCapture(place, trial, shown)
            self.captures.append(opened)
            self.activate(opened)
            self.look_at_all()
        return opened

    def replace_shown(self, opened: OpenCapture, trial: Capture, staged: Stage) -> None:
        """Show an open capture anew: it was edited, or has a body now."""
        with self.lock, self.server.atomic():
            old = opened.shown
            beside = float(old._root.position[0])
            old.remove()
            opened.trial = trial
            opened.shown = StagedCapture(self.server, old._path, staged, beside_m=beside)
            if opened.seen is not None:
                opened.shown.find(opened.seen.observation)
            self._shown_s = -1.0

    def drop(self, opened: OpenCapture) -> None:
        """Take a capture out of the window; its files stay."""
        with self.lock:
            opened.shown.remove()
            self.captures.remove(opened)
            self.activate(self.captures[-1] if self.captures else None)

    def activate(self, opened: OpenCapture | None) -> None:
        """Look at another one of the open captures, or at none."""
        with self.lock:
            self.active, self.segment = opened, None
            self.looping, self.following = False, ""
            self._slider.max = round(max(self.duration_s, 0.02) + 5e-4, 3)
            self._shown_s = -1.0
            self._draw_lanes()
            self._tell("captured")

    @property
    def duration_s(self) -> float:
        """Of the longest open capture [s]."""
        return max((float(each.trial.times[-1]) for each in self.captures), default=0.0)

    def observe(self) -> None:
        """Observe every open capture that is not yet, in the background."""
        waiting = [each for each in self.captures if each.seen is None]
        self._waits = bool(waiting and self.jobs.running)  # until that is done
        if not waiting or self._waits:
            return
        names = ", ".join(each.trial.name for each in waiting)

        def work(report: Callable[[str, float], None]) -> list[tuple[OpenCapture, Explained]]:
            base, found = self.settings.rule_base(), []
            for number, each in enumerate(waiting):
                report(each.trial.name, (number + 0.3) / len(waiting))
                found.append((each, explained(each.trial, rules=base)))
            return found

        def done(found: list[tuple[OpenCapture, Explained]]) -> None:
            for opened, seen in found:
                if opened in self.captures:
                    self.understood(opened, seen)
            self.observe()  # what was opened in the meantime

        self.jobs.start(f"observing {names}", work, done, self.complain)

    def understood(self, opened: OpenCapture, seen: Explained) -> None:
        """Show what was observed of a capture."""
        tracks = seen.measures.measurements.tracks
        speeds = {
            link.ee: (opened.trial.times, tracks[link.ee].speed_mps)
            for link in seen.observation.links
        }
        lost = {name: b.lost for name, b in seen.measures.measurements.bodies.poses.items()}
        with self.lock, self.server.atomic():
            opened.seen = seen
            opened.words = primitive_words(primitive_files(self.settings.rule_base().added))
            opened.sentences.clear()
            opened.rows = rows(seen.observation, speeds, lost)
            opened.shown.find(seen.observation)
            if opened is self.active:
                self.activate(opened)

    def rules_changed(self) -> None:
        """Observe everything again, as other rules count now."""
        with self.lock:
            for each in self.captures:
                each.seen = None
                self.replace_shown(each, each.trial, each.shown.stage)
        self.observe()

    def need(self) -> tuple[OpenCapture, Explained]:
        """The capture that is looked at, and what was understood of it.

        Raises:
            CaparError: There is none, or it is not observed yet.
        """
        if self.active is None:
            raise CaparError("no capture is open; open one in the tab File")
        if self.active.seen is None:
            raise CaparError(f"{self.active.trial.name} is not observed yet; wait, or look at See")
        return self.active, self.active.seen

    # Time -------------------------------------------------------------------------------------

    def seek(self, time_s: float) -> None:
        """Show a moment [s]."""
        self.time_s = min(max(float(time_s), 0.0), self.duration_s)

    def step(self, frames: int) -> None:
        """Go some frames of the capture on or back, and stop there."""
        self.playing = False
        if self.active is not None:
            self.seek(self.time_s + frames / self.active.trial.rate_hz)

    def play(self) -> None:
        """Play, or stop where it is; from the beginning where it had come to the end."""
        if not self.playing and self.time_s >= self._range()[1] - 1e-6:
            self.seek(self._range()[0])
        self.playing, self._shown_s = not self.playing, -1.0  # the slider catches up

    def _range(self) -> tuple[float, float]:
        if self.looping and self.segment is not None:
            return self.segment.start_s, self.segment.end_s
        return 0.0, self.duration_s

    def choose(self, address: str, *, seek: bool = True) -> Segment:
        """Choose a segment of the capture that is looked at, and go to where it begins.

        Raises:
            CaparError: There is none of that address.
        """
        opened, seen = self.need()
        found = find_segment(
            seen.observation.links, SegmentAddress.parse(address), capture=seen.observation.capture
        )
        with self.lock:
            self.segment = found
            colour = colour_of(Span(0.0, 0.0, found.name, kind_of(found)))
            opened.shown.choose(found.ee, found.start_s, found.end_s, colour)
            self._draw_lanes()
            if seek:
                self.seek(found.start_s)
        self._tell("chosen")
        return found

    def choose_next(self, by: int) -> None:
        """Choose the next segment, or the one before, of the same end-effector."""
        _, seen = self.need()
        current = self.segment
        own = [e for e in seen.observation.segments if current is None or e.ee == current.ee]
        if not own:
            raise CaparError("nothing was done in this capture: it has no segments")
        if current is None:
            at = next((n for n, e in enumerate(own) if e.end_s > self.time_s), 0)
        else:
            at = min(max(current.index + by, 0), len(own) - 1)
        self.choose(str(SegmentAddress(own[at].ee, own[at].index)))

    def go_to(self, capture: str, time_s: float, segment: str = "") -> None:
        """Lead to a moment of an open capture, and to a segment of it.

        Raises:
            UnknownNameError: No open capture has that name.
        """
        names = {each.trial.name: each for each in self.captures}
        if capture and capture not in names:
            raise UnknownNameError("open capture", capture, names)
        if capture and names[capture] is not self.active:
            self.activate(names[capture])
        if segment:
            self.choose(segment)
        if np.isfinite(time_s):
            self.seek(time_s)

    def _run(self) -> None:
        before = time.monotonic()
        while not self._ended.wait(max(before + TICK_S - time.monotonic(), 0.002)):
            now = time.monotonic()
            try:
                self._tick(now - before)
            except Exception as error:  # one moment that cannot be shown does not stop the clock
                self.playing = False
                self.complain(problem(error))
            before = now

    def _tick(self, passed_s: float) -> None:
        with self.lock:
            if self.playing:
                first, last = self._range()
                moved = self.time_s + passed_s * self.speed
                if moved >= last:
                    moved = first if self.looping else last
                    self.playing = self.looping
                self.time_s = max(moved, first)
            if self.time_s != self._shown_s:
                self._show_now()
        self._draw_job()
        if self._waits and not self.jobs.running:
            self.observe()

    def _show_now(self) -> None:
        before, self._shown_s = self._shown_s, self.time_s
        with self.server.atomic():
            for each in self.captures:
                each.shown.show(self.time_s)
            self._draw_cursor()
        self.updates += 1
        if not self.playing or time.monotonic() - self._slider_s > SLIDER_S:
            self._slider_s = time.monotonic()
            self._slider.value = round(self.time_s, 3)
            self._sentences.content = self._told_now()
        if self.following and self.active is not None and before >= 0.0:
            ends = [self.active.shown.position(self.following, at) for at in (before, self.time_s)]
            if ends[0] is not None and ends[1] is not None:
                for client in self.server.get_clients().values():
                    with client.atomic():
                        client.camera.position = client.camera.position + ends[1] - ends[0]

    # What is always there ---------------------------------------------------------------------

    def complain(self, words: str) -> None:
        """Tell of what went wrong at the top of the window."""
        self._message.content = html.message(words)

    def guard(
        self, where: "viser.GuiHtmlHandle | None", action: Callable[[], str | None]
    ) -> Callable[[Any], None]:
        """A callback that does something and shows what it says, or what went wrong, at a place.

        What the program itself sets is no wish of a person, and does nothing.
        """
        place = where or self._message

        def call(event: Any) -> None:
            if event.client_id is None:
                return
            place.content = ""  # first: work that the action begins may end before it returns
            try:
                if said := action():
                    place.content = html.message(said, good=True)
            except Exception as error:
                place.content = html.message(problem(error))

        return call

    def work(
        self,
        title: str,
        where: Any,
        work: Callable[[Callable[[str, float], None]], Any],
        done: Callable[[Any], None],
    ) -> None:
        """Do something long in the background; what goes wrong is shown at a place.

        Raises:
            CaparError: Something else is still being done.
        """

        def failed(words: str) -> None:
            where.content = html.message(words)

        def finished(result: Any) -> None:
            where.content = ""
            done(result)

        if not self.jobs.running:
            where.content = html.note(f"{title} … (see the top of this panel)")
        self.jobs.start(title, work, finished, failed)

    def _layout(self) -> None:
        gui: Any = self.server.gui
        self.dark(self.settings.dark)
        gui.set_panel_label("CaPAR")
        gui.main_panel.dock_right()
        gui.main_panel.set_width(PANEL_PX)
        self.server.scene.set_up_direction("+z")
        self.server.scene.world_axes.visible = False
        self._message = gui.add_html("")
        self._job_text = gui.add_html("", visible=False)
        self._job_bar = gui.add_progress_bar(0.0, visible=False, animated=True)
        self._job_stop = gui.add_button("Stop", visible=False, color="red")
        self._job_stop.on_click(lambda _: self.jobs.stop())
        self._tabs_place = gui.add_folder(None)
        self._panel = gui.add_panel()
        with self._panel.add_tab("Timeline"):
            names = ("◀ segment", "◀ frame", "play / pause", "frame ▶", "segment ▶", "loop")
            buttons = gui.add_button_group("", names)
            actions: dict[str, Callable[[], Any]] = {
                names[0]: lambda: self.choose_next(-1),
                names[1]: lambda: self.step(-1),
                names[2]: self.play,
                names[3]: lambda: self.step(1),
                names[4]: lambda: self.choose_next(1),
                names[5]: self.loop,
            }

            def pressed() -> None:
                actions[buttons.value]()

            buttons.on_click(self.guard(None, pressed))
            self._slider = gui.add_slider("time [s]", 0.0, 0.02, 0.001, 0.0)
            self._slider.on_update(self.guard(None, lambda: self.seek(self._slider.value)))
            self._cursor = gui.add_html("")
            self._drawing = gui.add_html("")
            self._sentences = gui.add_html("")
        self._panel.float(x=12, y=-12, width=900, height=280)

    def dark(self, on: bool) -> None:
        """Dark letters on light, or light ones on dark."""
        self.server.gui.configure_theme(
            dark_mode=on, show_logo=False, show_share_button=False, control_width="large"
        )
        self.server.scene.set_background_image(
            np.full((1, 1, 3), 38 if on else 244, dtype=np.uint8), format="png"
        )

    def loop(self) -> str:
        """Loop over the segment that is chosen, or stop looping."""
        if not self.looping and self.segment is None:
            raise CaparError("choose a segment first: it is what is looped over")
        self.playing = self.looping = not self.looping
        return "looping over the segment" if self.looping else ""

    def follow(self, name: str = "") -> str:
        """Have the camera follow a body; the hand of the segment chosen, or nothing, if empty."""
        own = [link.ee for link in self.need()[1].observation.links]
        own = [self.segment.ee] if self.segment else own
        self.following = name or ("" if self.following else next(iter(own), ""))
        return f"the camera follows {spoken(self.following)}" if self.following else ""

    def _keys(self) -> None:
        keys: tuple[tuple[Any, str, Callable[[], Any]], ...] = (
            ("space", "Play or pause", self.play),
            ("J", "One frame back", lambda: self.step(-1)),
            ("L", "One frame on", lambda: self.step(1)),
            ("P", "Previous segment", lambda: self.choose_next(-1)),
            ("N", "Next segment", lambda: self.choose_next(1)),
            ("O", "Loop over the segment", self.loop),
            ("F", "Follow the hand", self.follow),
            ("H", "Look at everything", self.look_at_all),
        )
        for key, label, action in keys:
            command = self.server.gui.add_command(label, hotkey=key)
            command.on_trigger(self.guard(None, action))

    def look_at_all(self, *clients: viser.ClientHandle) -> None:
        """Put the camera, of some windows or all, where everything that is open is seen."""
        if self.active is None:
            return
        lows, highs = zip(*(each.shown.bounds() for each in self.captures), strict=True)
        low, high = np.min(lows, axis=0), np.max(highs, axis=0)
        covered = self._lanes_px() / self._size[1]  # by the timeline, at the bottom
        far = max(float(np.linalg.norm(high - low)), 0.6) * 0.8 / (1.0 - covered)
        place = (low + high) / 2.0 - np.array([0.0, 0.0, 0.45 * covered * far])
        eye = place + far * TOWARDS / np.linalg.norm(TOWARDS)
        self.server.initial_camera.position = eye
        self.server.initial_camera.look_at = place
        for client in clients or self.server.get_clients().values():
            with client.atomic():
                client.camera.position = eye
                client.camera.look_at = place

    def _connected(self, client: viser.ClientHandle) -> None:
        """Fit the timeline to the size of a window that was opened or changed."""

        def fit(camera: viser.CameraHandle) -> None:
            size = camera.image_width, camera.image_height
            with self.lock:
                if size != self._size and min(size) > 0:
                    self._size = size
                    wide = max(size[0] - 24, LEAST_PX)
                    self._panel.float(x=12, y=-12, width=wide, height=self._lanes_px())
                    self._draw_lanes()

        client.camera.on_update(fit)
        fit(client.camera)
        self.look_at_all(client)
        self._shown_s = -1.0

    def _lanes_px(self) -> float:
        """Height of the timeline."""
        return min(max(self._size[1] * 0.36, LANES_PX), self._size[1] * 0.5)

    def _draw_lanes(self) -> None:
        opened, chosen = self.active, None
        if self.segment is not None:
            name = spoken(self.segment.ee)
            chosen = name, self.segment.start_s, self.segment.end_s
        if opened is None or not opened.rows:
            self._lanes, self._cursor.content = None, ""
            waits = "" if opened is None else f"{opened.trial.name} is not observed yet."
            self._drawing.content = html.note(waits or "Open a capture in the tab File.")
            return
        begin, end = self._page()
        self._lanes = Lanes(opened.rows, begin, end, max(self._size[0] - 60, LEAST_PX))
        self._drawing.content = f'<div style="padding:0 8px">{self._lanes.svg(chosen)}</div>'
        self._draw_cursor()

    def _page(self) -> tuple[float, float]:
        """The interval that the lanes show now [s]."""
        if self.duration_s <= 1.25 * LONGEST_S:
            return 0.0, self.duration_s
        first = int(self.time_s / LONGEST_S) * LONGEST_S
        return first, min(first + LONGEST_S, self.duration_s)

    def _draw_cursor(self) -> None:
        if self._lanes is None:
            return
        if not self._lanes.begin_s <= self.time_s <= self._lanes.end_s:
            self._draw_lanes()
        line = self._lanes.cursor(self.time_s)
        self._cursor.content = f'<div style="padding:0 8px">{line}</div>'

    def _told_now(self) -> str:
        """What is done at this moment, in words, by each end-effector."""
        opened = self.active
        if opened is None or opened.seen is None:
            return ""
        parts = []
        for segment in opened.seen.observation.segments:
            if segment.start_s <= self.time_s < segment.end_s or (
                self.time_s == segment.end_s == opened.seen.observation.duration_s
            ):
                key = segment.ee, segment.index
                if key not in opened.sentences:
                    said = segment_sentence(opened.seen.observation, segment, words=opened.words)
                    opened.sentences[key] = said
                said = opened.sentences[key]
                head = f"{spoken(segment.ee)}: {segment.name}"
                parts.append(html.text(f"{head}. {said}" if said else head))
        return "".join(parts)

    def _show_job(self, what: str, share: float) -> None:
        self._job = what, share  # the clock draws it

    def _draw_job(self) -> None:
        """Show what is being done, if it takes more than a moment: else the tabs would jump."""
        (what, share), now = self._job, time.monotonic()
        self._idle_s = now if not what else self._idle_s
        if self._job == self._job_shown or (what and now - self._idle_s < MOMENT_S):
            return
        self._job_shown, on = (what, share), bool(what)
        self._job_text.content = html.note(f"{what} …") if on else ""
        self._job_bar.value = 100.0 * min(max(share, 0.03), 1.0)
        for each in (self._job_text, self._job_bar, self._job_stop):
            each.visible = on

    def _tell(self, what: str, *panels: Panel) -> None:
        for panel in panels or self.panels:
            try:
                getattr(panel, what)()
            except Exception as error:
                self.complain(problem(error))
