"""The gate before the window's server: who may ask, and for what, is decided before it answers.

viser listens on every interface and asks nobody who they are. Here it listens on loopback, and
every request, also that for a websocket, passes the gate: its path begins with a secret token, its
Host is this server's, and so is its Origin, which browsers send and pages cannot change. Another
page in the same browser, another program's page on loopback, and a name that was made to point to
loopback are so refused.
"""

import secrets
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import replace
from hmac import compare_digest
from http import HTTPStatus
from io import StringIO
from typing import Any

import viser
import websockets.asyncio.server
from viser import _messages
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from capar.model.errors import CaparError

LOOPBACK = "127.0.0.1"
NAMES = (LOOPBACK, "localhost")
"""How a browser may call this computer; no other Host is answered."""

HEADERS = {
    "X-Frame-Options": "DENY",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}
"""What every answer states: no other page may hold this one in a frame or learn its address."""

Answer = Callable[[ServerConnection, Request], Response | None]


class Gate:
    """Decides which requests reach a server on loopback.

    Args:
        token: What the path of every request begins with; drawn if empty.
    """

    def __init__(self, token: str = "") -> None:
        self.token = token or secrets.token_urlsafe(24)

    def refusal(self, path: str, headers: Headers, port: int) -> str:
        """Why a request is refused; empty where it is not."""
        own = {f"{name}:{port}" for name in NAMES}
        hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
        if len(hosts) != 1 or hosts[0] not in own:
            return "this server is asked by another name"
        if len(origins) > 1 or any(
            each not in {f"http://{name}" for name in own} for each in origins
        ):
            return "another page asks"
        if headers.get("Upgrade") is not None and not origins:
            return "a websocket is opened by no page"
        first = path.partition("?")[0].split("/")[1:2]
        if not first or not compare_digest(first[0].encode(), self.token.encode()):
            return "the address lacks the token; open the one that `capar open` printed"
        return ""

    def before(self, answer: Answer) -> Answer:
        """The same answers, to those alone who may ask, and without the token in their paths."""

        def guarded(connection: ServerConnection, request: Request) -> Response | None:
            port = connection.local_address[1]
            why = self.refusal(request.path, request.headers, port)
            if why:
                text = f"refused: {why}\n".encode()
                headers = Headers(**{"Content-Type": "text/plain", **HEADERS})
                headers["Content-Length"] = str(len(text))
                return Response(HTTPStatus.FORBIDDEN, "Forbidden", headers, text)
            path, mark, asked = request.path.partition("?")
            inner = "/" + "/".join(path.split("/")[2:]) + mark + asked
            found = answer(connection, replace(request, path=inner))
            if found is not None:
                found.headers.update(HEADERS)
            return found

        return guarded


@contextmanager
def _guarding(gate: Gate) -> Iterator[list[str]]:
    """While it lasts, websocket servers are made with a gate before them."""
    plain = websockets.asyncio.server.serve
    made: list[str] = []

    def serve(handler: Any, host: str, port: int, **options: Any) -> Any:
        if host != LOOPBACK:
            raise CaparError(f"the window is shown on {LOOPBACK} only, not on {host}")
        made.append(host)
        return plain(
            handler,
            host,
            port,
            **{**options, "process_request": gate.before(options["process_request"])},
        )

    websockets.asyncio.server.serve = serve  # type: ignore[misc, assignment]
    try:
        yield made
    finally:
        websockets.asyncio.server.serve = plain  # type: ignore[misc]


def guarded_server(gate: Gate, *, port: int = 0) -> viser.ViserServer:
    """A viser server on loopback behind a gate.

    Args:
        gate: Who may ask.
        port: Where it listens, or, if that is taken, at one of the next; 0 takes any free one.

    Raises:
        CaparError: viser made its server in a way that leaves no room for the gate.
    """
    with _guarding(gate) as made, redirect_stdout(StringIO()):  # it prints an address of its own
        server = viser.ViserServer(host=LOOPBACK, port=port, label="CaPAR", verbose=False)
    if not made:
        stop(server)
        raise CaparError("this version of viser cannot be guarded; install viser 1.1")
    # A client may ask for a tunnel from the internet to here.
    for kind in (_messages.ShareUrlRequest, _messages.ShareUrlDisconnect):
        server._websock_server.unregister_handler(kind)
    return server


def stop(server: viser.ViserServer) -> None:
    """End a server and its threads."""
    with redirect_stdout(StringIO()):
        server.stop()


def address(server: viser.ViserServer, gate: Gate) -> str:
    """Where the window is; sizes that a page reports are in its own pixels, not in the screen's."""
    return f"http://{LOOPBACK}:{server.get_port()}/{gate.token}/?fixedDpr=1"
