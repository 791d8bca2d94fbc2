"""Nobody but the page that was opened reaches the window, and nothing else than its files."""

from collections.abc import Iterator
from http.client import HTTPConnection
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import InvalidStatus
from window_client import Client

from capar.workbench.gate import Gate, address, guarded_server, stop


@pytest.fixture(scope="module")
def place() -> Iterator[str]:
    gate = Gate()
    server = guarded_server(gate)
    yield address(server, gate)
    stop(server)


def asked(place: str, path: str | None = None, **headers: str) -> int:
    parts = urlsplit(place)
    connection = HTTPConnection(parts.hostname or "", parts.port, timeout=10)
    given = {"Host": parts.netloc, **{name.replace("_", "-"): v for name, v in headers.items()}}
    connection.putrequest("GET", parts.path if path is None else path, skip_host=True)
    for name, value in given.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    answer.read()
    return answer.status


def test_the_address_with_its_token_is_answered(place: str) -> None:
    assert asked(place) == 200


@pytest.mark.parametrize("path", ["/", "/index.html", "/wrong/", "//", "/%20/", "/?token=x"])
def test_an_address_without_the_token_is_refused(place: str, path: str) -> None:
    assert asked(place, path) == 403


def test_half_of_the_token_is_not_enough(place: str) -> None:
    token = urlsplit(place).path.strip("/")
    assert asked(place, f"/{token[:-1]}/") == asked(place, f"/{token}x/") == 403


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "localhost.evil:80"])
def test_a_name_that_is_made_to_point_here_is_refused(place: str, host: str) -> None:
    assert asked(place, Host=host) == 403


def test_localhost_is_this_computer_too(place: str) -> None:
    assert asked(place, Host=f"localhost:{urlsplit(place).port}") == 200


@pytest.mark.parametrize(
    "origin", ["https://evil.example", "null", "http://127.0.0.1:1", "file://"]
)
def test_another_page_is_refused(place: str, origin: str) -> None:
    assert asked(place, Origin=origin) == 403
    with pytest.raises(InvalidStatus):
        Client(place, origin=origin)


def test_a_websocket_without_the_token_or_of_no_page_is_refused(place: str) -> None:
    parts = urlsplit(place)
    with pytest.raises(InvalidStatus):
        Client(f"http://{parts.netloc}/")
    upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec_WebSocket_Version": "13"}
    assert asked(place, Sec_WebSocket_Key="AAAAAAAAAAAAAAAAAAAAAA==", **upgrade) == 403


def test_a_websocket_of_the_page_is_let_in(place: str) -> None:
    with Client(place) as client:
        client.read()
        assert client.controls is not None


@pytest.mark.parametrize("way", ["../../pyproject.toml", "%2e%2e/%2e%2e/setup.py", "..%5c..%5cx"])
def test_a_path_out_of_the_page_is_not_found(place: str, way: str) -> None:
    assert asked(place, urlsplit(place).path + way) == 404


def test_two_windows_have_two_tokens() -> None:
    assert Gate().token != Gate().token
    assert len(Gate().token) >= 32


def test_no_tunnel_can_be_asked_for(place: str) -> None:
    from viser import _messages

    gate = Gate()
    server = guarded_server(gate)
    try:
        assert _messages.ShareUrlRequest not in server._websock_server._incoming_handlers
        assert server.get_host() == "127.0.0.1"
    finally:
        stop(server)
