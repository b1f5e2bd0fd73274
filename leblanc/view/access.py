"""Who may open the page of a server: whoever has its address with the token, from no other page."""

from __future__ import annotations

import hashlib
import hmac
from collections.abc import Awaitable, Callable
from typing import Any
from urllib.parse import urlsplit

Handler = Callable[[Any], Awaitable[Any]]

HERE = frozenset({"localhost", "127.0.0.1", "::1"})
ANYWHERE = frozenset({"", "0.0.0.0", "::"})  # every address of the machine
NO_STORE = {"Cache-Control": "no-store", "Referrer-Policy": "no-referrer", "X-Frame-Options": "DENY"}


def address_of(host: str, port: int, token: str) -> str:
    """Address that opens the page; without its token the server does not answer."""
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/?token={token}"


def gate(host: str, token: str) -> Any:
    """Middleware of aiohttp that lets only the owner of the token in.

    The address carries the token once; from then on the browser has it in a cookie that no script can read. A
    request that names another host, as after a change of what a name means, and one that comes from another
    page are refused even with it.
    """
    from aiohttp import web

    names = HERE | {host.lower()}
    cookie = f"leblanc-{hashlib.sha256(token.encode()).hexdigest()[:8]}"  # two servers, two cookies

    def ours(given: str | None) -> bool:
        return given is not None and hmac.compare_digest(given.encode(errors="replace"), token.encode())

    async def check(request: Any, handler: Handler) -> Any:
        named = request.headers.get("Host", "")
        if host not in ANYWHERE and _name(named) not in names:
            raise web.HTTPForbidden(text="another host was asked for than this page has\n")
        origin = request.headers.get("Origin")
        if origin is not None and origin != f"http://{named}":
            raise web.HTTPForbidden(text="asked for by another page\n")
        if ours(request.query.get("token")):
            answer = web.HTTPFound("/index.html", headers=NO_STORE)
            answer.set_cookie(cookie, token, httponly=True, samesite="Lax")
            raise answer
        if not ours(request.cookies.get(cookie)):
            raise web.HTTPForbidden(text="the address has no token, or that of another run\n")
        return await handler(request)

    return web.middleware(check)


async def launched(request: Any) -> Any:
    """Answer to the page's question where its server is: here."""
    from aiohttp import web

    return web.json_response({"sessionURL": f"ws://{request.headers.get('Host', '')}/ws"})


def _name(host: str) -> str | None:
    """Name in a Host header, without the port; None if it is no host."""
    try:
        return urlsplit(f"//{host}").hostname
    except ValueError:
        return None
