"""A small reader for the VTU frames of a run: appended arrays, raw or packed by zlib."""

import re
import struct
import xml.etree.ElementTree as ElementTree
import zlib

import numpy

from .data import DataError

TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}
MARK = re.compile(rb'<AppendedData encoding="raw">\s*_')


def read_frames(pvd):
    """[(time, file)] of a collection."""
    try:
        sets = ElementTree.parse(pvd).getroot().iter("DataSet")
        return [(float(entry.get("timestep")), pvd.parent / entry.get("file")) for entry in sets]
    except (ElementTree.ParseError, TypeError, ValueError) as error:
        raise DataError(f"{pvd} cannot be read: {error}") from None


def _unpack(data, offset, packed):
    """Bytes of the array at `offset`."""
    if not packed:
        (size,) = struct.unpack_from("<Q", data, offset)
        return data[offset + 8:offset + 8 + size]
    blocks, _, _ = struct.unpack_from("<3Q", data, offset)
    sizes = struct.unpack_from(f"<{blocks}Q", data, offset + 24)
    at, parts = offset + 8 * (3 + blocks), []
    for size in sizes:
        parts.append(zlib.decompress(data[at:at + size]))
        at += size
    return b"".join(parts)


def read_vtu(path):
    """Arrays of an unstructured grid by name; vectors as rows."""
    data = path.read_bytes()
    mark = MARK.search(data)
    if not mark:
        raise DataError(f"{path} has no appended raw data")
    root = ElementTree.fromstring(data[:mark.start()] + b"</VTKFile>")
    if root.get("header_type") != "UInt64" or root.get("byte_order") != "LittleEndian":
        raise DataError(f"{path} has another byte order or header than UInt64")
    payload, packed = data[mark.end():], root.get("compressor") is not None
    arrays = {}
    for entry in root.find("UnstructuredGrid/Piece").iter("DataArray"):
        values = numpy.frombuffer(_unpack(payload, int(entry.get("offset")), packed), TYPES[entry.get("type")])
        components = int(entry.get("NumberOfComponents") or 1)
        arrays[entry.get("Name")] = values.reshape(-1, components) if components > 1 else values
    return arrays
