"""A client of the window as its page is one: viser's messages over a websocket, no browser."""

import time
from collections.abc import Callable
from typing import Any

import msgspec
import viser
import zstandard
from websockets.sync.client import connect

WAIT_S = 60.0


class Client:
    """Reads what a window shows and uses its controls, by their labels.

    Args:
        address: As `capar open` prints it.
    """

    def __init__(self, address: str, **headers: str) -> None:
        place = address.partition("?")[0].rstrip("/")
        host = place.split("/")[2]
        self._socket = connect(
            place.replace("http://", "ws://"),
            origin=headers.pop("origin", f"http://{host}"),  # type: ignore[arg-type]
            additional_headers=headers,
            subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
            max_size=None,
            proxy=None,
        )
        self.controls: dict[str, dict[str, Any]] = {}
        """Kind, properties and value of each control, by its number."""

        self.updates: list[tuple[float, str]] = []
        """When which scene node was put where."""

        self.tell("ViewerCameraMessage", wxyz=(1.0, 0.0, 0.0, 0.0), position=(2.0, 2.0, 2.0),
                  fov=0.8, near=0.1, far=100.0, image_height=900, image_width=1000,
                  look_at=(0.0, 0.0, 0.0), up_direction=(0.0, 0.0, 1.0))  # fmt: skip

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def tell(self, kind: str, **values: Any) -> None:
        """Send one message."""
        self._socket.send(msgspec.msgpack.encode({"type": kind, **values}))

    def read(self, seconds: float = 0.3) -> None:
        """Take what comes until nothing came for a while."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            try:
                self._take(self._socket.recv(timeout=left))
            except TimeoutError:
                return

    def _take(self, data: Any) -> None:
        size = int.from_bytes(data[8:16], "little")
        inner = zstandard.ZstdDecompressor().decompress(data[16 : 16 + size])
        for each in msgspec.msgpack.decode(inner)["messages"]:
            kind = each["type"]
            if kind.startswith("Gui") and "props" in each:
                self.controls[each["uuid"]] = each
            elif kind == "GuiUpdateMessage" and each["uuid"] in self.controls:
                for name, value in each["updates"].items():
                    own = self.controls[each["uuid"]]
                    (own if name == "value" else own["props"])[name] = value
            elif kind == "GuiRemoveMessage":
                self.controls.pop(each["uuid"], None)
            elif kind == "SetPositionMessage":
                self.updates.append((time.monotonic(), each["name"]))

    def text(self) -> str:
        """Everything that is written in the window, as HTML."""
        self.read()
        pieces = (e["props"].get("content", "") for e in self.controls.values())
        return "\n".join(pieces)

    def find(self, label: str, kind: str = "") -> dict[str, Any]:
        """The control of a label."""
        found = [
            each
            for each in self.controls.values()
            if each["props"].get("label") == label and kind in each["type"]
        ]
        assert found, (
            f"no control {label!r}; {[e['props'].get('label') for e in self.controls.values()]}"
        )
        return found[0]

    def set(self, label: str, value: Any, kind: str = "") -> None:
        """Set a field, choose of a list, or press a button (True)."""
        self.read(0.1)
        own = self.find(label, kind)
        own["value"] = value
        self.tell("GuiUpdateMessage", uuid=own["uuid"], updates={"value": value})

    def press(self, label: str) -> None:
        """Press a button."""
        self.set(label, True, "Button")

    def wait_for(self, words: str | Callable[[], bool], seconds: float = WAIT_S) -> None:
        """Wait until some words are in the window, or a condition holds."""
        end = time.monotonic() + seconds
        while not (words in self.text() if isinstance(words, str) else words()):
            assert time.monotonic() < end, f"{words!r} is not shown: {self.text()[-3000:]}"
            self.read(0.2)
