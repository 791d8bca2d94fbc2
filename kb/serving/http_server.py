"""Sockets and HTTP around a service, on the loopback interface unless told otherwise."""

from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from ipaddress import ip_address
from socket import AF_INET6
from urllib.parse import parse_qs, unquote, urlsplit

from kb.errors import StoreError
from kb.serving.messages import Request, Response
from kb.serving.service import Service

LARGEST_BODY = 256 << 20
"""How many bytes a request may hold."""

PATIENCE_S = 60.0
"""How long a connection may be silent [s]."""


class ActionaryServer(ThreadingHTTPServer):
    """Listens until it is shut down; a thread for each connection."""

    daemon_threads = True

    def __init__(self, service: Service, *, host: str = "127.0.0.1", port: int = 7879) -> None:
        """Take the port; 0 for any that is free.

        Raises:
            StoreError: It cannot listen there.
        """
        self.service = service
        self.loopback = is_loopback(host)
        if ":" in host:
            self.address_family = AF_INET6
        try:
            super().__init__((host, port), _Handler)
        except (OSError, OverflowError) as error:
            raise StoreError(
                f"{host}:{port}: cannot listen there ({error}); try another --port"
            ) from None

    @property
    def url(self) -> str:
        """Where it is."""
        host, port = self.server_address[:2]
        name = str(host)
        return f"http://{f'[{name}]' if ':' in name else name}:{port}/"


def is_loopback(host: str) -> bool:
    """Whether a host's name or address is of this computer alone."""
    name = host.strip("[]")
    if name.lower() == "localhost":
        return True
    try:
        return ip_address(name).is_loopback
    except ValueError:
        return False


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    timeout = PATIENCE_S
    server: ActionaryServer

    def do_GET(self) -> None:
        """Answer."""
        self._answer(body="")

    def do_HEAD(self) -> None:
        """Answer like GET, without the body."""
        self._answer(body="left out")

    def do_POST(self) -> None:
        """Answer."""
        self._answer(body="")

    def _answer(self, *, body: str) -> None:
        response = self._refused() or self.server.service.answer(self._request())
        self.send_response(response.status)
        self.send_header("Content-Type", response.media_type)
        self.send_header("Content-Length", str(len(response.body)))
        self.send_header("X-Content-Type-Options", "nosniff")
        if response.allow:
            self.send_header("Allow", response.allow)
        if response.status == 401:
            self.send_header("WWW-Authenticate", "Bearer")
        if response.status in {411, 413}:
            self.close_connection = True
            self.send_header("Connection", "close")
        self.end_headers()
        if not body:
            self.wfile.write(response.body)

    def _refused(self) -> Response | None:
        """Why a request is not even read: a foreign host's name, or a body without end."""
        host = urlsplit(f"//{self.headers.get('Host', '')}").hostname or ""
        if self.server.loopback and not is_loopback(host):
            return _told(403, "ask for it by the name localhost or a loopback address")
        length = self.headers.get("Content-Length")
        if self.command == "POST" and (length is None or not length.isdecimal()):
            return _told(411, "say how long the body is: Content-Length")
        if length is not None and int(length) > LARGEST_BODY:
            return _told(413, f"a body may hold {LARGEST_BODY} bytes at most")
        return None

    def _request(self) -> Request:
        parts = urlsplit(self.path)
        asked = parse_qs(parts.query, keep_blank_values=True)
        length = int(self.headers.get("Content-Length") or 0)
        return Request(
            "GET" if self.command == "HEAD" else self.command,
            unquote(parts.path),
            {name: tuple(values) for name, values in asked.items()},
            {name.lower(): value for name, value in self.headers.items()},
            self.rfile.read(length) if length else b"",
        )

    def log_message(self, format: str, *args: object) -> None:
        """Write nothing; errors are answered."""


def _told(status: int, message: str) -> Response:
    return Response(status, "text/plain; charset=utf-8", f"{message}\n".encode())
