"""Images written by tests of the program and of the Python module."""

import struct
import zlib


def write_grey_png(path, grey):
    """Writes a matrix of grey values (uint8, top row first), or of pairs of grey and alpha, as a PNG image."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    colour_type = 0 if grey.ndim == 2 else 4
    header = struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, colour_type, 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    )
