"""See: what is shown of a capture, how fast, and what was done in it, in words."""

from collections.abc import Callable
from typing import Any

from capar.body.body_fitting import fit_body
from capar.body.recording import Truth, write_bundle
from capar.body.sensor_fitting import Fit
from capar.model.errors import CaparError
from capar.model.observation import SegmentAddress
from capar.pipelines.language import describe
from capar.views import html
from capar.views.notices import note_lines
from capar.views.picture import spoken
from capar.views.viewer.stage import stage, with_mannequin
from capar.workbench.window import Panel

SPEEDS = ("0.1", "0.25", "0.5", "1", "2", "4")
NOBODY, NONE = "nothing", "(none)"
KEYS = "Keys, in the scene: space plays, J L a frame, P N a segment, O loop, F follow, H all."


class See(Panel):
    """What is shown."""

    title = "See"

    def build(self) -> None:
        """Add the controls."""
        window, gui = self.window, self.gui
        self._names: list[str] = []
        self._capture = gui.add_dropdown("capture", [NONE], hint="The one that is looked at.")
        self._capture.on_update(window.guard(None, self._activate))
        self._segment = gui.add_dropdown("segment", [NONE])
        self._segment.on_update(window.guard(None, self._choose))
        self._speed = gui.add_dropdown("speed", SPEEDS, initial_value="1")
        self._speed.on_update(window.guard(None, self._set_speed))
        self._follow = gui.add_dropdown("camera follows", [NOBODY])
        self._follow.on_update(window.guard(None, self._set_follow))
        self._shown = {
            name: gui.add_checkbox(name, initial_value=True)
            for name in ("names", "trails", "fitted body")
        }
        for box in self._shown.values():
            box.on_update(window.guard(None, self._set_shown))
        dark = gui.add_checkbox("dark", initial_value=window.settings.dark)
        dark.on_update(window.guard(None, lambda: window.dark(dark.value)))
        self._said = gui.add_html("")
        self.button(
            "Fit a body", self.fit, self._said, hint="Of the performer's measures, to the sensors."
        )
        self.button("Save this capture", self.save, self._said, hint="In a folder of its name.")
        self.button("Close this capture", self._drop, self._said, color="gray")
        with gui.add_folder("What was done"):
            self._story = gui.add_html(html.note("Nothing is observed yet."))
        with gui.add_folder("Notices", expand_by_default=False):
            self._notices = gui.add_html("")
        gui.add_html(html.note(KEYS))

    def captured(self) -> None:
        """List captures and segments anew."""
        window = self.window
        # Names of files may be equal; the number tells them apart.
        self._names = [f"{n}. {each.trial.name}" for n, each in enumerate(window.captures, 1)]
        self._capture.options = self._names or [NONE]
        opened = window.active
        if opened is None:
            self._segment.options = [NONE]
            self._story.content = html.note("No capture is open.")
            self._notices.content = ""
            return
        self._capture.value = self._names[window.captures.index(opened)]
        seen = opened.observation
        self._segment.options = [NONE] + [
            f"{SegmentAddress(each.ee, each.index)}  {each.name}  {each.start_s:.2f} s"
            for each in (seen.segments if seen else ())
        ]
        self._segment.value = NONE
        self._follow.options = [NOBODY, *opened.trial.bodies]
        self._follow.value = NOBODY
        self._set_shown()
        lines = note_lines(dict.fromkeys((*opened.trial.notices, *(seen.notices if seen else ()))))
        self._notices.content = html.text("\n".join(lines) or "none")
        self._story.content = html.text(describe(seen) if seen else "Not observed yet.")

    def chosen(self) -> None:
        """Show which segment is chosen."""
        segment = self.window.segment
        if segment is not None:
            start = f"{SegmentAddress(segment.ee, segment.index)}  "
            self._segment.value = next(o for o in self._segment.options if o.startswith(start))

    def _activate(self) -> None:
        self.window.activate(self.window.captures[self._names.index(self._capture.value)])

    def _choose(self) -> None:
        if self._segment.value != NONE:
            self.window.choose(self._segment.value.split()[0])

    def _set_speed(self) -> None:
        self.window.speed = float(self._speed.value)

    def _set_follow(self) -> None:
        self.window.following = "" if self._follow.value == NOBODY else self._follow.value

    def _set_shown(self) -> None:
        names, trails, bodies = (box.value for box in self._shown.values())
        for each in self.window.captures:
            each.shown.set_visible(labels=names, trails=trails, bodies=bodies)

    def _drop(self) -> None:
        if self.window.active is None:
            raise CaparError("no capture is open")
        self.window.drop(self.window.active)

    def save(self) -> str:
        """Save a capture that is only in this window, such as a live recording."""
        opened, folders = self.window.active, self.window.folders
        if opened is None or opened.place:
            raise CaparError("the chosen capture is in a folder already")
        folder = folders.new(opened.trial.name)
        write_bundle(opened.trial, Truth((), (), (), ()), folder)
        opened.place = str(folder)
        return f"saved {opened.trial.name} in {folders.named(folder)}"

    def fit(self) -> str:
        """Fit a human body to the sensors, in the background."""
        window, opened = self.window, self.window.active
        if opened is None or not opened.place:
            raise CaparError("a body is fitted to a capture in a folder; open one")
        trial, place = opened.trial, opened.place

        def work(report: Callable[[str, float], None]) -> Fit:
            report("moving its joints frame by frame", 0.2)
            return fit_body(place, trial)

        def done(fit: Any) -> None:
            window.replace_shown(opened, trial, with_mannequin(stage(trial), fit))
            self._said.content = html.message(
                f"a body of {fit.human.measures.values['stature']:.2f} m", good=True
            )

        window.work(f"fitting a body to {spoken(trial.name)}", self._said, work, done)
        return ""
