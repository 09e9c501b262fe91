"""Prints what a series of surfaces for ParaView holds, read with nothing of irdm: the standard library alone.

For each file of the series a line "part timestep points triangles", then a line for each point: its place, and the vectors of
the arrays that are named on the command line.
"""
import base64
import pathlib
import struct
import sys
import xml.etree.ElementTree as ElementTree

CODES = {"Float64": "d", "Int32": "i"}


def numbers(array):
    assert array.get("format") == "binary"
    data = base64.b64decode("".join(array.text.split()), validate=True)
    (size,) = struct.unpack_from("<Q", data)
    assert size == len(data) - 8, "the header does not say how long the data are"
    code = CODES[array.get("type")]
    return struct.unpack_from(f"<{size // struct.calcsize(code)}{code}", data, 8)


def named(parent, name):
    (array,) = [each for each in parent.findall("DataArray") if each.get("Name") == name]
    return numbers(array)


def read(path):
    root = ElementTree.parse(path).getroot()
    assert root.tag == "VTKFile" and root.get("byte_order") == "LittleEndian" and root.get("header_type") == "UInt64"
    return root


folder = pathlib.Path(sys.argv[1])
for entry in read(folder / "run.pvd").findall("Collection/DataSet"):
    data = read(folder / entry.get("file")).find("PolyData")
    (time,) = named(data.find("FieldData"), "TimeValue")
    assert time == float(entry.get("timestep"))
    piece = data.find("Piece")
    count = int(piece.get("NumberOfPoints"))
    triangles = int(piece.get("NumberOfPolys"))
    arrays = [named(piece.find("Points"), "Points")]
    if triangles > 0:
        corners = named(piece.find("Polys"), "connectivity")
        assert named(piece.find("Polys"), "offsets") == tuple(range(3, 3 * triangles + 1, 3))
        assert len(corners) == 3 * triangles and min(corners) >= 0 and max(corners) < count
    names = sys.argv[2:] if triangles > 0 else ["force"]
    arrays += [named(piece.find("PointData"), name) for name in names]
    assert all(len(array) == 3 * count for array in arrays)
    print(entry.get("part"), repr(time), count, triangles)
    for i in range(count):
        print(*(repr(x) for array in arrays for x in array[3 * i : 3 * i + 3]))
