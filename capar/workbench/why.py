"""Ask why: the conditions of a segment's name with what was measured, and why it has no other."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import viser

from capar.model.errors import CaparError
from capar.model.observation import Segment, SegmentAddress
from capar.pipelines.explanation import Explained, explanation_plot
from capar.views import html
from capar.views.explanation_plot import draw_explanation
from capar.views.explanation_text import explanation_lines, notices_about, reason_tree
from capar.views.notices import reservation_lines
from capar.workbench.window import Panel
from capar_rules.authoring.user_primitives import rules_of
from capar_rules.explain.explanation import Explanation

ASK = "Choose a segment: in the list of See, or with the keys N and P."
CHOOSE = "(a name)"


class Why(Panel):
    """Reasons."""

    title = "Why"

    def build(self) -> None:
        """Add the controls."""
        gui, guard = self.gui, self.window.guard
        self._told: tuple[Explained, Explanation] | None = None
        self._said = gui.add_html("")
        self.button(
            "Explain the chosen segment", self._ask, self._said, icon=viser.Icon.HELP_CIRCLE
        )
        self._follows = gui.add_checkbox(
            "at once", True, hint="Explain each segment that is chosen."
        )
        self._summary = gui.add_html(html.note(ASK))
        self._moment = gui.add_dropdown("jump to frame", [CHOOSE])
        self._moment.on_update(guard(self._said, self._jump))
        with gui.add_folder("Conditions"):
            self._conditions = gui.add_html("")
        with gui.add_folder("Nearest other name"):
            self._nearest = gui.add_html("")
        self._plot = gui.add_folder("Measured over time", expand_by_default=False)
        with self._plot:
            self._plot_place = gui.add_html("")
            self.button("Draw it", self.draw, self._plot_place)
            self._image: Any = None
        with gui.add_folder("Derivation", expand_by_default=False):
            self._tree = gui.add_html("")
        with gui.add_folder("Why not ..."):
            self._other = gui.add_dropdown("another name", [CHOOSE])
            self._not_said = gui.add_html("")
            self.button("Why not?", self._ask_not, self._not_said)
            self._not = gui.add_html("")

    def captured(self) -> None:
        """Forget what was explained of another capture."""
        for each in (self._conditions, self._nearest, self._tree, self._not, self._not_said):
            each.content = ""
        self._summary.content = html.note(ASK)
        opened = self.window.active
        if opened is not None and opened.seen is not None:
            names = sorted(rule.name for rule in rules_of(opened.seen.explainer.profile))
            self._other.options = [CHOOSE, *names]

    def chosen(self) -> None:
        """Explain it at once, if that is wished."""
        if self._follows.value and not self.window.jobs.running:
            self._ask()

    def _ask(self) -> str:
        _, seen = self.window.need()
        segment = self._segment()

        def work(report: Callable[[str, float], None]) -> Explanation:
            report("deriving it again", 0.3)
            return seen.explain([segment])[0]

        name = str(SegmentAddress(segment.ee, segment.index))

        def done(told: Explanation) -> None:
            self.show(seen, told, segment)
            if self.window.segment not in (None, segment):  # another was chosen in the meantime
                self.chosen()

        self.window.work(f"explaining {name}", self._said, work, done)
        return ""

    def _segment(self) -> Segment:
        if self.window.segment is None:
            raise CaparError(f"no segment is chosen. {ASK}")
        return self.window.segment

    def show(self, seen: Explained, told: Explanation, segment: Segment) -> None:
        """Show an explanation."""
        self._told = seen, told
        head, summary, *more = explanation_lines(told, seen.observation)
        self._said.content = ""
        self._summary.content = html.text(f"{head}  {told.name}", "font-weight:bold") + html.text(
            "\n".join([summary, *more])
        )
        self._conditions.content = html.conditions(told.conditions)
        near = told.nearest
        self._nearest.content = (
            html.note("No other name is near.")
            if near is None
            else html.text(f"{near.name} would need:") + html.conditions(near.failing)
        )
        definitions = seen.definitions(told).items()
        notes = (*told.notes, *(f"{name}: {text}" for name, text in definitions))
        reservations = reservation_lines(
            notices_about([segment], seen.observation, [told]),
            called=seen.explainer.names, unshaped=seen.unshaped,
        )  # fmt: skip
        self._tree.content = html.tree(reason_tree(told, seen.observation)) + html.note(
            "\n".join((*notes, *reservations))
        )
        frames = sorted({at for one in told.conditions for at in one.frames})
        rate = seen.observation.rate_hz
        self._moment.options = [CHOOSE, *(f"{at}  ({at / rate:.2f} s)" for at in frames)]
        self._moment.value = CHOOSE
        if self._image is not None:
            self._image.remove()
            self._image = None

    def _jump(self) -> None:
        if self._moment.value != CHOOSE:
            _, seen = self.window.need()
            self.window.playing = False
            self.window.seek(int(self._moment.value.split()[0]) / seen.observation.rate_hz)

    def draw(self) -> None:
        """Draw what the conditions measure, over time."""
        if self._told is None:
            raise CaparError("explain a segment first")
        from matplotlib.image import imread

        with TemporaryDirectory() as folder:
            drawn = Path(folder) / "why.png"
            draw_explanation(explanation_plot(*self._told), drawn)
            image = np.asarray(imread(drawn) * 255, dtype=np.uint8)
        if self._image is not None:
            self._image.image = image
        else:
            with self._plot:
                self._image = self.gui.add_image(image, format="png")

    def _ask_not(self) -> None:
        if self._other.value == CHOOSE:
            raise CaparError("choose another name first")
        name, seen = self._other.value, self.window.need()[1]
        near = seen.why_not(self._segment(), name)
        nothing = html.text(f"No rule for {name} comes near: each lacks several conditions.")
        self._not.content = nothing * (not near) + "".join(
            html.text(f"Nearest rule: {rule.rule} lacks") + html.conditions(rule.failing)
            if rule.failing
            else html.text(rule.sentence)
            for rule in near
        )
