"""Reads the folder of a Limber run: parameters, statistics, points."""

import base64
import re
import xml.etree.ElementTree as xml
import zlib
from pathlib import Path

import numpy as np

import charts

VTK_TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4",
             "UInt32": "<u4", "Int64": "<i8", "UInt64": "<u8",
             "Int8": "i1", "UInt8": "u1"}


def parameters(folder):
    """Returns {'Section/Name': value} of parameters.prm, without comments."""
    values, section = {}, []
    for line in (Path(folder) / "parameters.prm").read_text().splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("subsection "):
            section.append(line[len("subsection "):].strip())
        elif line == "end":
            section.pop()
        elif line.startswith("set "):
            name, value = line[len("set "):].split("=", 1)
            values["/".join(section + [name.strip()])] = value.strip()
    return values


def numbers(text):
    """'0, -9.81' as an array."""
    return np.array([float(word) for word in re.split("[,;]", text)])


def words(text):
    """'front, height' as a list."""
    return [word.strip() for word in text.split(",") if word.strip()]


def statistics(folder):
    """Returns ({name: column}, {name: unit})."""
    path = Path(folder) / "statistics"
    columns = re.findall(r"^# *(\d+): *(.+?) *(?:\[([^\]]*)\])? *$",
                         path.read_text(), re.MULTILINE)
    rows = path.read_text().splitlines()
    if all(not row or row.startswith("#") for row in rows):
        charts.fail(f"The table '{path}' has no rows: the run has not made a step.")
    table = np.loadtxt(path, ndmin=2)
    values = {name: table[:, int(n) - 1] for n, name, _ in columns}
    return values, {name: unit for _, name, unit in columns}


def tree(path):
    """The root of an XML file of the run; ends with a message if it cannot be
    read."""
    try:
        return xml.parse(path).getroot()
    except (OSError, xml.ParseError) as error:
        charts.fail(f"The picture '{path}' is missing or damaged ({error}). "
                    "Usually the machine failed while it was written. Go on from "
                    "the checkpoint with '--resume', which writes it anew.")


def data_array(element, compressed):
    """One array of a VTU file, as written by deal.II: text or base64."""
    kind = VTK_TYPES[element.get("type")]
    text = "".join((element.text or "").split())
    if element.get("format") != "binary" or not text:
        values = np.array((element.text or "").split(), dtype=kind)
    elif not compressed:
        values = np.frombuffer(base64.b64decode(text)[4:], kind)
    else:
        # A header of 32-bit numbers: blocks, their size, size of the last
        # one, compressed size of each. It is encoded on its own.
        blocks = int(np.frombuffer(base64.b64decode(text[:8])[:4], "<u4")[0])
        length = -(-4 * (3 + blocks) // 3) * 4
        sizes = np.frombuffer(base64.b64decode(text[:length]), "<u4")[3:]
        data, begin, parts = base64.b64decode(text[length:]), 0, []
        for size in sizes[:blocks]:
            parts.append(zlib.decompress(data[begin:begin + size]))
            begin += size
        values = np.frombuffer(b"".join(parts), kind)
    components = int(element.get("NumberOfComponents") or 1)
    return values.reshape(-1, components) if components > 1 else values


def points(path):
    """Reads a .vtu or .pvtu: {'position': ..., and each field by its name}."""
    path = Path(path)
    root = tree(path)
    if path.suffix == ".pvtu":
        pieces = [points(path.parent / piece.get("Source"))
                  for piece in root.iter("Piece")]
    else:
        compressed = root.get("compressor") is not None
        pieces = []
        for piece in root.iter("Piece"):
            place = piece.find("Points/DataArray")
            if int(piece.get("NumberOfPoints")) == 0 or place is None:
                continue
            fields = {array.get("Name"): data_array(array, compressed)
                      for array in piece.findall("PointData/DataArray")}
            pieces.append({"position": data_array(place, compressed), **fields})
    pieces = [piece for piece in pieces if piece]
    if not pieces:
        return {}
    return {name: np.concatenate([piece[name] for piece in pieces])
            for name in pieces[0]}


def series(folder, name="points"):
    """Returns the times and the files of NAME.pvd, in order."""
    path = Path(folder) / f"{name}.pvd"
    if not path.exists():
        return np.array([]), []
    files = {}
    for entry in tree(path).iter("DataSet"):
        files[float(entry.get("timestep"))] = path.parent / entry.get("file")
    times = sorted(files)
    return np.array(times), [files[time] for time in times]


def is_reference(folder):
    """Whether 'limber reference' has written the folder."""
    return (Path(folder) / "nodes").is_dir()


def node_series(folder):
    """Returns the times and the files of nodes/, in order; only references
    have them."""
    import h5py  # only references need it

    files = {}
    for path in (Path(folder) / "nodes").glob("*.h5"):
        with h5py.File(path) as file:
            files[float(file["time"][0])] = path
    times = sorted(files)
    return np.array(times), [files[time] for time in times]


def node_arrays(path):
    """The nodes of a reference: {'position': (n, 3), and each scalar array by
    its name}."""
    import h5py

    with h5py.File(path) as file:
        fields = {name: values[()] for name, values in file.items()}
    fields.pop("time")
    fields["position"] = np.stack(
        [fields[f"initial place {d}"] + fields[f"displacement {d}"]
         if f"displacement {d}" in fields
         else np.zeros(len(fields["displacement x"])) for d in "xyz"], axis=1)
    return fields


def nodes(folder, wanted):
    """The nodes of a reference at the time nearest to the wanted one:
    (time, arrays)."""
    times, files = node_series(folder)
    nearest = np.argmin(abs(times - wanted))
    return times[nearest], node_arrays(files[nearest])


def magnitude(vectors):
    return np.sqrt((vectors**2).sum(axis=1))
