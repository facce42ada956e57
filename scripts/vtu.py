"""Reads the .vtu files that a run writes, with the standard library alone."""
import base64
import math
import pathlib
import struct
import xml.etree.ElementTree
import zlib


def vtu_arrays(path):
    """Arrays of a .vtu by name, decoded as VTK's file formats describe."""
    formats = {"Float64": "d", "Int64": "q", "UInt8": "B"}
    arrays = {}
    for element in xml.etree.ElementTree.parse(path).iter("DataArray"):
        code = element.text.strip()
        n_blocks, = struct.unpack("<Q", base64.b64decode(code[:12])[:8])
        length = math.ceil(8 * (3 + n_blocks) / 3) * 4
        sizes = struct.unpack(f"<{3 + n_blocks}Q", base64.b64decode(code[:length]))[3:]
        packed = base64.b64decode(code[length:])
        data = b""
        for size in sizes:
            data += zlib.decompress(packed[:size])
            packed = packed[size:]
        kind = formats[element.get("type")]
        arrays[element.get("Name")] = struct.unpack(f"<{len(data) // struct.calcsize(kind)}{kind}", data)
    return arrays


def grid_arrays(path):
    """The same for each piece of a .pvtu, in a list; a .vtu is its own piece."""
    path = pathlib.Path(path)
    if path.suffix == ".vtu":
        return [vtu_arrays(path)]
    pieces = xml.etree.ElementTree.parse(path).iter("Piece")
    return [vtu_arrays(path.parent / piece.get("Source")) for piece in pieces]
