"""File: a motion file becomes a capture; its capture.toml as a form, each change seen at once."""

import shutil
import tempfile
import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import viser

from capar.model.capture import UP, Capture
from capar.model.errors import CaparError, FileError
from capar.views import html
from capar.views.viewer.stage import stage
from capar.workbench.window import OpenCapture, Panel
from extractors.readers.bundle.capture_toml import FILE, read_capture
from extractors.readers.drafting import toml_edit
from extractors.readers.drafting.draft import EDIT, draft
from extractors.readers.names import constant_name, side_of
from extractors.readers.registry import read_recording

NONE = "(none)"
SUFFIXES = (".c3d", ".bvh", ".csv", ".trc", ".tsv", ".npz", ".json", ".bag", ".mcap", ".gz", ".xz")
GENERAL = "general"
LARGEST_BYTES = 400_000_000
"""A larger file is not taken from the browser; put it into the folder."""

WORDS = ("name", "body", "kind", "top_at_bottom_of")
"""Keys whose value is a text."""

CHOICES = {
    "unit": ("m", "dm", "cm", "mm", "in", "ft"), "up": tuple(UP), "handedness": ("right", "left"),
    "side": ("none", "right", "left"), "role": ("acts", "attends"),
    "tag": ("mobile", "fixed", "self"),
    "end_effector": ("hand", "foot", "head", "eyes", "forearm", "elbow", "knee"),
}  # fmt: skip
"""Keys that have few values; those of any other are written as in TOML."""

FIELDS = {
    GENERAL: "name unit up handedness from_s to_s",
    "sensor": "name end_effector side role body shape eye gaze",
    "object": "name tag kind body position shape mass_kg top_at_bottom_of",
}
"""The keys of each table that have a field; any other key is edited in the text."""


class Bring(Panel):
    """Files become captures."""

    title = "File"

    def build(self) -> None:
        """Add the controls."""
        gui, guard = self.gui, self.window.guard
        self.text = ""
        self._shown: OpenCapture | None = None
        with gui.add_folder("Open a capture"):
            self._bundle = gui.add_dropdown("capture", [NONE])
            self._opened = self.button(
                "Open it beside what is open", lambda: self.open(self._bundle.value)
            )
        with gui.add_folder("Bring a motion file"):
            self._file = gui.add_dropdown("file", [NONE])
            upload = gui.add_upload_button("Upload a file", hint="It is kept in the first folder.")
            self._file_said = self.button(
                "Draft its capture.toml", lambda: self.draft(self._file.value)
            )
            self.button("Look for files again", self.captured, self._file_said, color="gray")
            upload.on_upload(
                guard(self._file_said, lambda: self.upload(upload.value.name, upload.value.content))
            )
        with gui.add_folder("Draft"):
            self._hints = gui.add_html(html.note("Draft a file first."))
            self._entry = gui.add_dropdown("of", [GENERAL])
            self._entry.on_update(guard(None, self._show_fields))
            self._form = gui.add_folder(None)
            self._fields: dict[str, Any] = {}
            self._errors: dict[str, viser.GuiHtmlHandle] = {}
            self._body = gui.add_dropdown("body of the file", [NONE])
            for kind in ("object", "sensor"):
                self.button(
                    f"Add it as {'an' if kind == 'object' else 'a'} {kind}",
                    partial(self.add, kind),
                    self._hints,
                )
            self.button(
                "Leave this sensor or object out",
                lambda: self.remove(self._entry.value),
                self._hints,
                color="gray",
            )
        with gui.add_folder("Text", expand_by_default=False):
            self._text = gui.add_text("capture.toml", "", multiline=True)
            self._text_said = self.button("Take this text", lambda: self.take(self._text.value))
        with gui.add_folder("Save"):
            self._folder = gui.add_text("new folder", "")
            self._saved = self.button(
                "Save the draft", lambda: self.save(self._folder.value), color="green"
            )

    def captured(self) -> None:
        """List the files that are there."""
        folders = self.window.folders
        self._bundle.options = folders.files([".toml"]) or [NONE]
        self._file.options = folders.files(SUFFIXES) or [NONE]

    def open(self, name: str) -> str:
        """Open a capture of the folders beside what is open."""
        if name == NONE:
            raise CaparError("there is no capture in the folders; bring a motion file first")
        path = self.window.folders.inside(name)
        opened = self.window.open(str(path.parent if path.name == FILE else path))
        return f"{opened.trial.name} is open"

    def upload(self, name: str, content: bytes) -> str:
        """Keep a file that came from the browser in the first folder."""
        plain = Path(name.replace("\\", "/")).name
        if not plain or plain.startswith(".") or Path(plain).suffix.lower() not in SUFFIXES:
            raise FileError(
                name or "the file", "is no motion file.", f"Its name ends in {', '.join(SUFFIXES)}."
            )
        if len(content) > LARGEST_BYTES:
            raise FileError(plain, "is too large for the browser.", "Put it into the folder.")
        path = self.window.folders.new(plain)
        with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as part:
            part.write(content)
        Path(part.name).replace(path)
        self.captured()
        self._file.value = self.window.folders.named(path)
        return f"{plain} is there: {len(content)} bytes"

    def draft(self, name: str) -> str:
        """Draft the capture.toml of a motion file, in the background, and show it."""
        if name == NONE:
            raise CaparError("there is no motion file in the folders; upload one")
        path = self.window.folders.inside(name)
        called = path.name.split(".")[0] or "capture"

        def work(report: Callable[[str, float], None]) -> tuple[Any, str]:
            report("reading it", 0.2)
            recording = read_recording(path)
            report("guessing what is what", 0.6)
            return recording, draft([recording], self.window.folders.first / called, called)

        def done(made: Any) -> None:
            recording, text = made
            self._shown = None
            self._folder.value = called
            self._body.options = [NONE, *recording.names]
            self._take(text)
            self._file_said.content = html.message("drafted; look at it below", good=True)

        self.window.work(f"reading {path.name}", self._file_said, work, done)
        return ""

    # The text is the truth; fields show and change it

    def take(self, text: str) -> str:
        """Have another text; it is shown at once, or what is wrong with it."""
        self._need()
        return self._take(text)

    def _take(self, text: str) -> str:
        """Keep a text, list its tables, and show the capture that it describes."""
        self.text = self._text.value = text
        try:
            tables = [
                f"{kind} {number + 1}: {toml_edit.table(text, kind, number).get('name', '?')}"
                for kind in ("sensor", "object")
                for number in range(toml_edit.count(text, kind))
            ]
        except tomllib.TOMLDecodeError as error:
            raise FileError(FILE, f"is no TOML: {error}.") from None
        chosen = self._entry.value
        self._entry.options = [GENERAL, *tables]
        if chosen not in self._entry.options:
            self._entry.value = GENERAL
        self._show_fields()
        hints = [
            f"line {n}: {line.strip()}"
            for n, line in enumerate(text.splitlines(), 1)
            if EDIT in line
        ]
        self._hints.content = html.note("\n".join(hints) or "No line asks to be looked at.")
        trial = self.read()
        self._show(trial)
        return f"{len(trial.sensors)} sensors and {len(trial.objects)} objects"

    def read(self) -> Capture:
        """The capture that the text describes, read as if it were saved."""
        folder = Path(tempfile.mkdtemp(dir=self.window.folders.first, prefix=".draft"))
        try:
            self.window.folders.check_bundle(self.text, folder)
            (folder / FILE).write_text(self.text, "utf-8")
            return read_capture(folder)
        except CaparError as error:
            words = str(error).replace(f"{folder}/", "")
            raise CaparError(words) from None
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def _show(self, trial: Capture) -> None:
        window = self.window
        if self._shown is None or self._shown not in window.captures:
            self._shown = window.show(trial)
        else:
            self._shown.seen, self._shown.rows = None, ()
            window.replace_shown(self._shown, trial, stage(trial))
            window.activate(self._shown)
            window.look_at_all()

    def _show_fields(self) -> None:
        """A field for each key of the chosen table."""
        for each in (*self._fields.values(), *self._errors.values()):
            each.remove()
        self._fields, self._errors = {}, {}
        kind, number = self._chosen()
        values = toml_edit.table(self.text, "" if kind == GENERAL else kind, number)
        with self._form:
            for key in FIELDS[kind].split():
                value, known = values.get(key), CHOICES.get(key)
                shown = "" if value is None else toml_edit.written(value)
                shown = value if isinstance(value, str) else shown
                if known:
                    options = [NONE, *known] + ([shown] if shown and shown not in known else [])
                    field: Any = self.gui.add_dropdown(key, options, initial_value=shown or NONE)
                else:
                    field = self.gui.add_text(key, shown)
                error = self.gui.add_html("")
                self._fields[key], self._errors[key] = field, error
                field.on_update(self.window.guard(error, partial(self.set, key)))

    def _chosen(self) -> tuple[str, int]:
        kind, _, rest = self._entry.value.partition(" ")
        return (kind, int(rest.partition(":")[0]) - 1) if rest else (GENERAL, 0)

    def set(self, key: str) -> str:
        """Set a key of the chosen table to what its field says; the scene shows the result."""
        self._need()
        value = self._fields[key].value
        kind, number = self._chosen()
        given: Any = None
        if value.strip() and value != NONE:
            plain = key in CHOICES or (key in WORDS and value.strip()[0] not in '[{"')
            given = value.strip() if plain else _value(value)
        name = "" if kind == GENERAL else kind
        # What is written stays in its field and in the text, to be mended there if it is wrong.
        self.text = self._text.value = toml_edit.with_key(self.text, name, number, key, given)
        self._show(self.read())
        return ""

    def add(self, kind: str) -> str:
        """Make a body of the file a sensor or an object."""
        self._need()
        body = self._body.value
        if body == NONE:
            raise CaparError("choose a body of the file first")
        name = constant_name(body)
        keys: dict[str, Any] = {"name": name}
        if kind == "sensor":
            keys |= {"end_effector": "hand", "side": side_of(body) or "none"}
        else:
            keys |= {"tag": "mobile"}
        self._take(toml_edit.with_table(self.text, kind, {**keys, "body": body}))
        self._entry.value = self._entry.options[
            -1 if kind == "object" else toml_edit.count(self.text, "sensor")
        ]
        self._show_fields()
        return f"{name} was added"

    def remove(self, entry: str) -> str:
        """Leave a sensor or an object out."""
        self._need()
        if entry == GENERAL:
            raise CaparError("choose a sensor or an object first")
        kind, number = self._chosen()
        text = toml_edit.without_table(self.text, kind, number)
        self._entry.value = GENERAL
        self._take(text)
        return f"{entry} is left out"

    def save(self, name: str) -> str:
        """Save the capture as a bundle in a new folder, and observe it."""
        self._need()
        if Path(name).name != name or name.startswith("."):
            raise FileError(name or "nothing", "is no name of a folder.", "Write one without /.")
        folder = self.window.folders.new(name)
        self.read()
        part = folder.with_name(f".{folder.name}.part")
        part.mkdir(exist_ok=True)
        (part / FILE).write_text(self.text, "utf-8")
        part.rename(folder)
        shown, self._shown = self._shown, None
        if shown is not None and shown in self.window.captures:
            self.window.drop(shown)
        self.window.open(str(folder))
        self.captured()
        self.text = ""  # what is saved is not edited here any more
        return f"saved the draft as {self.window.folders.named(folder)}"

    def _need(self) -> None:
        if not self.text:
            raise CaparError("draft a motion file first")


def _value(text: str) -> Any:
    """A value that is written as in TOML; a bare word is a text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        raise CaparError(
            f"{text!r} is no value; write numbers like 0.1, lists like [0, 0, 1], shapes like "
            "{ sphere = 0.05 }"
        ) from None
