"""A client of a run's page (docs/reference/wire.md)."""

import json
import socket
import urllib.request


def numbers(address):
    """Returns the document numbers.json of a page's address, which ends in a slash."""
    with urllib.request.urlopen(address + "numbers.json", timeout=60) as answer:
        return json.load(answer)


def page_says(address, message):
    """Connects as a page and sends a message of fewer than 126 bytes; closing the returned socket closes the page. The
    program drops the connection after a few seconds, because nothing reads it."""
    port = int(address.rstrip("/").rsplit(":", 1)[1])
    page = socket.create_connection(("127.0.0.1", port), timeout=60)
    page.sendall(f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                 "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode())
    assert page.recv(64).startswith(b"HTTP/1.1 101")
    text = json.dumps(message).encode()
    page.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)
    return page
