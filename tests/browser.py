"""A page in headless Chromium, driven with its mouse and keys over the DevTools protocol.

https://chromedevtools.github.io/devtools-protocol/
"""

import json
import shutil
import subprocess
import time
from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
FLAGS = (
    "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--remote-debugging-port=0", "--window-size=1200,900",
)  # fmt: skip
WAIT_S = 60.0


def browser_missing() -> str:
    """Why no browser can be driven here; empty if one can."""
    if CHROMIUM is None:
        return "no Chromium here"
    try:
        import websockets.sync.client
    except ImportError:
        return "websockets is not installed"
    return "" if websockets.sync.client else "websockets has no client"


class Page:
    """One page of a browser."""

    def __init__(self, socket: Any, session: str) -> None:
        self._socket, self._session, self._number = socket, session, 0
        self.requests: list[str] = []
        """Addresses that were asked for."""

    def tell(self, method: str, **values: Any) -> dict[str, Any]:
        """Send a command and wait for its result."""
        self._number += 1
        asked = {"id": self._number, "method": method, "params": values}
        of_page = {"sessionId": self._session} if self._session else {}
        self._socket.send(json.dumps(asked | of_page))
        while True:
            answer = json.loads(self._socket.recv(timeout=WAIT_S))
            if answer.get("method") == "Network.requestWillBeSent":
                self.requests.append(answer["params"]["request"]["url"])
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                result: dict[str, Any] = answer["result"]
                return result

    def open(self, path: Path) -> None:
        """Load a file and wait until it says that it is ready."""
        for domain in ("Page", "Runtime", "Network"):
            self.tell(f"{domain}.enable")
        self.tell("Page.navigate", url=path.as_uri())
        self.wait_for('document.body && document.body.dataset.ready === "yes"')

    def evaluate(self, expression: str) -> Any:
        """The value of an expression in the page."""
        answer = self.tell("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wait_for(self, condition: str) -> None:
        """Wait until an expression holds."""
        end = time.monotonic() + WAIT_S
        while not self.evaluate(f"Boolean({condition})"):
            assert time.monotonic() < end, condition
            time.sleep(0.05)

    def click(self, selector: str, *, across: float = 0.5, index: int = 0) -> None:
        """Press the mouse on an element, as far across as this share of its width."""
        box = self.evaluate(
            f"(() => {{ const found = document.querySelectorAll({json.dumps(selector)})[{index}];"
            " found.scrollIntoView({block: 'nearest'}); const box = found.getBoundingClientRect();"
            " return [box.x, box.y, box.width, box.height]; })()"
        )
        place = {"x": box[0] + across * box[2], "y": box[1] + box[3] / 2}
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.tell("Input.dispatchMouseEvent", type=kind, button="left", clickCount=1, **place)

    def press(self, key: str) -> None:
        """Press a key and let it go."""
        for kind in ("keyDown", "keyUp"):
            self.tell("Input.dispatchKeyEvent", type=kind, key=key, code=key)

    def screenshot(self) -> bytes:
        """What is to be seen now, as a PNG file."""
        return b64decode(self.tell("Page.captureScreenshot", format="png")["data"])


@contextmanager
def opened(path: Path, profile: Path) -> Iterator[Page]:
    """A file in a new browser, which is closed afterwards.

    Args:
        path: An HTML file.
        profile: An empty folder for the browser's own files.
    """
    from websockets.sync.client import connect

    assert CHROMIUM is not None
    command = [CHROMIUM, *FLAGS, f"--user-data-dir={profile}", "about:blank"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        with connect(_address(profile), max_size=None) as socket:
            whole = Page(socket, "")
            target = whole.tell("Target.createTarget", url="about:blank")["targetId"]
            joined = whole.tell("Target.attachToTarget", targetId=target, flatten=True)
            page = Page(socket, joined["sessionId"])
            page.open(path)
            yield page
    finally:
        process.terminate()
        process.wait(timeout=WAIT_S)


def _address(profile: Path) -> str:
    """Where the browser listens, which it writes to a file once it does."""
    told, end = profile / "DevToolsActivePort", time.monotonic() + WAIT_S
    while not (told.exists() and len(told.read_text().splitlines()) == 2):
        assert time.monotonic() < end, "the browser does not listen"
        time.sleep(0.05)
    port, place = told.read_text().splitlines()
    return f"ws://127.0.0.1:{port}{place}"
