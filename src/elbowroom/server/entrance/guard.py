"""Who may talk to the server: hosts, origins, and the headers that keep a page to itself."""

import ipaddress
import socket
from collections.abc import Sequence
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})

# The page loads nothing from elsewhere; three.js reads textures of a GLB through blob: addresses.
POLICY = "; ".join(
    [
        "default-src 'self'",
        "script-src 'self' 'wasm-unsafe-eval'",  # decoders of compressed meshes are WebAssembly
        "img-src 'self' blob: data:",
        "style-src 'self' 'unsafe-inline'",
        "connect-src 'self' blob: data:",
        "worker-src 'self' blob:",
        "object-src 'none'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    ]
)
_API = "/api/"
_OWN_SITES = ("same-origin", "none")  # Sec-Fetch-Site of our page, and of an address that was typed
_FOREIGN = "That page may not talk to this server."
HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}


def is_loopback(host: str) -> bool:
    """Whether a host name or address is this machine's own."""
    if host in LOOPBACK_NAMES:
        return True
    address = _address(host)
    return address is not None and address.is_loopback


def host_of(authority: str) -> str:
    """The host in a Host header or an authority (`[::1]:8765` gives `::1`), in small letters; "" if it is none."""
    try:
        return (urlsplit(f"//{authority}").hostname or "").lower()
    except ValueError:
        return ""


class Guard:
    """ASGI middleware: refuses foreign hosts and origins, adds the security headers.

    A page elsewhere can make a browser send requests here; it cannot forge `Host` and `Origin`. A name that resolves
    here by DNS rebinding is refused by `Host`, any other site by `Origin`, or by `Sec-Fetch-Site` where it asks as for
    a picture and sends none. A program that sends no `Origin` is let in from this machine only. The page and its
    avatars are handed out to who knows a `Host`.
    """

    def __init__(self, app: ASGIApp, bound_host: str, name: str = "") -> None:
        self._app = app
        self._names = LOOPBACK_NAMES | ({name.lower(), bound_host.lower()} - {""})
        self._open = not is_loopback(bound_host)  # reachable from other machines
        if self._open:
            self._names |= {socket.gethostname().lower()}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer 403 (400 for a foreign host)."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is None:
            await self._app(scope, receive, _with_headers(send))
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": refusal})
        else:
            await PlainTextResponse(refusal + "\n", 403, headers=HEADERS)(scope, receive, send)

    def _refusal(self, scope: Scope) -> str | None:
        headers = Headers(scope=scope)
        hosts = headers.getlist("host")
        if len(hosts) != 1 or not self._knows(host_of(hosts[0])):
            return "This server does not answer to that Host; open the address that it printed."
        if scope["type"] == "http" and scope["method"] in ("GET", "HEAD"):
            if not scope["path"].startswith(_API):
                return None
            if headers.get("sec-fetch-site", "none") not in _OWN_SITES:
                return _FOREIGN
        return self._origin_refusal(headers.getlist("origin"), hosts[0], scope.get("client"))

    def _knows(self, host: str) -> bool:
        return host in self._names or is_loopback(host) or (self._open and _address(host) is not None)

    @staticmethod
    def _origin_refusal(origins: list[str], host: str, client: Sequence[object] | None) -> str | None:
        if not origins:
            local = client is not None and is_loopback(str(client[0]))
            return None if local else "A client without an Origin is let in from this machine only."
        allowed = {f"{scheme}://{host}".lower() for scheme in ("http", "https")}
        return None if len(origins) == 1 and origins[0].lower() in allowed else _FOREIGN


def _address(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        return ipaddress.ip_address(host)
    except ValueError:
        return None


def _with_headers(send: Send) -> Send:
    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return send_with_headers
