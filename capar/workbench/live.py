"""Live: a tracker, or a simulated one, whose segments come while it moves."""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace

import viser

from capar.model.calibration import Calibration
from capar.model.capture import Capture
from capar.model.errors import CaparError
from capar.model.observation import SegmentAddress
from capar.pipelines.live.frames import Poses, body_names
from capar.pipelines.live.ledgers import SegmentEvent
from capar.pipelines.live.observer import LiveObserver
from capar.pipelines.live.tracking import track
from capar.views import html
from capar.views.viewer.stage import stage
from capar.workbench.window import OpenCapture, Panel
from extractors.calibration import calibrate
from extractors.devices.drivers import EXAMPLES, find_tracker, make_simulator
from extractors.devices.simulator import CapturedMotion, Faults

SIMULATED = "simulate the open capture"
ADDRESS = "tracker at an address"
MOST_SHOWN = 40


class Live(Panel):
    """Observation while it happens."""

    title = "Live"

    def build(self) -> None:
        """Add the controls."""
        gui = self.gui
        self._ends = False
        self.segments: dict[tuple[str, int], tuple[str, ...]] = {}
        gui.add_html(
            html.note(
                "The open capture says which bodies there are and what is on which sensor. A "
                "simulated tracker plays it on loopback, as a real one would send it."
            )
        )
        self._source = gui.add_dropdown("source", (SIMULATED, ADDRESS))
        self._address = gui.add_text("tracker", "", hint=f"Such as {next(iter(EXAMPLES.values()))}")
        self._lead_in = gui.add_number(
            "lead-in [s]", 0.0, min=0.0, step=0.5, hint="Calibrate by these; 0: as the capture was."
        )
        self._said = gui.add_html("")
        self.button("Start", self.start, self._said, icon=viser.Icon.PLAYER_PLAY)
        self.button("End and keep it in the window", self.end, self._said)
        self._table = gui.add_html("")

    def start(self) -> str:
        """Begin to observe what a tracker sends, with the open capture as the rig."""
        window, rig = self.window, self.window.active
        if rig is None:
            raise CaparError("open a capture of the same bodies first: it is the rig")
        address, seconds = self._address.value.strip(), float(self._lead_in.value)
        if self._source.value == ADDRESS and not address:
            raise CaparError(
                f"say the address of the tracker, such as {next(iter(EXAMPLES.values()))}"
            )
        simulated = self._source.value == SIMULATED
        names = {each.trial.name for each in window.captures}
        name = next(f"live_{n}" for n in range(1, 999) if f"live_{n}" not in names)
        trial = replace(rig.trial, name=name, sources=(), notices=())
        known = None
        if seconds <= 0.0 and rig.seen is not None:
            known = rig.seen.measures.measurements.calibration
        self._ends, self.segments = False, {}

        def work(report: Callable[[str, float], None]) -> LiveObserver:
            with ExitStack() as opened:
                place = address
                if simulated:
                    motion = CapturedMotion(rig.trial)
                    tracker, options = make_simulator("vrpn", motion, Faults(0.0, 0.0))
                    opened.enter_context(tracker)
                    place = f"vrpn:{tracker.place}?{options}&names={','.join(motion.sensors)}"
                report(f"waiting for {place.partition('?')[0]}", 0.2)
                return self._observe(place, trial, rig, known, seconds, report)

        window.jobs.start("live", work, self._finish, self._failed)
        return "started"

    def _observe(
        self,
        place: str,
        trial: Capture,
        rig: OpenCapture,
        known: Calibration | None,
        lead_in_s: float,
        report: Callable[[str, float], None],
    ) -> LiveObserver:
        with find_tracker(place) as tracker:
            if known is None and lead_in_s <= 0.0:
                known = calibrate(rig.trial)
            observer, _, batches = track(
                tracker, trial, known, lead_in_s, rules=self.window.settings.rule_base(),
                say=lambda text: report(text, 0.5),
            )  # fmt: skip
            report("observing", 1.0)
            try:
                for batch in batches:
                    self._take(observer.push(batch))
                    if batch:
                        self._show(rig, trial, batch[-1])
                    if self._ends:
                        return observer
            finally:
                observer.rules_process.close()
                rig.shown.live = False
        raise AssertionError("a tracker's frames have no end")

    def _show(self, rig: OpenCapture, trial: Capture, poses: Poses) -> None:
        """Put the bodies where the tracker sees them."""
        now = {
            name.split(" ", 1)[1]: (poses.positions[row], poses.orientations[row])
            for row, name in enumerate(body_names(trial))
        }
        rig.shown.live = True
        with self.window.server.atomic():
            rig.shown.put(now)

    def _take(self, events: list[SegmentEvent]) -> None:
        """List what came, the last first."""
        for event in events:
            segment = event.segment
            self.segments[segment.ee, segment.first] = (
                str(SegmentAddress(segment.ee, segment.index)),
                f"{segment.start_s:.2f} to {segment.end_s:.2f}",
                segment.name,
                event.sentence,
            )
        if events:
            rows = list(self.segments.values())[: -MOST_SHOWN - 1 : -1]
            self._table.content = html.table(rows, ("segment", "time [s]", "name", "in words"))

    def end(self) -> str:
        """End it; what was recorded stays in the window, and is observed as a whole."""
        if not self.window.jobs.running.startswith("live"):
            raise CaparError("nothing is observed live")
        self._ends = True
        return "ending"

    def _finish(self, observer: LiveObserver) -> None:
        if observer.frames < 2:
            self._failed("no frames came: nothing was observed")
            return
        recording = observer.recording()
        self.window.show(recording, staged=stage(recording))
        self._said.content = html.message(
            f"{observer.frames} frames are in the window as {recording.name}", good=True
        )
        self.window.observe()

    def _failed(self, words: str) -> None:
        self._said.content = html.message(words)
        for each in self.window.captures:
            each.shown.live = False
