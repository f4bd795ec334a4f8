"""Damage to a run folder: what disks, hands and other programs do to it."""

import shutil

SCENE = "tests/restart/two_dimensions.prm"
CHANGES = ["End step=12", "Checkpoint/Steps=5", "Output/Time interval=0.005",
           "Output/Statistics interval=1"]


def flip(data, at, bit):
    changed = bytearray(data)
    if changed:
        changed[int(at * len(changed))] ^= 1 << bit
    return bytes(changed)


def change(kind, data, at, bit):
    return {"flip": lambda: flip(data, at, bit),
            "truncate": lambda: data[:int(at * len(data))],
            "empty": lambda: b"",
            "zeros": lambda: bytes(len(data)),
            "append": lambda: data + data[:100],
            "garbage": lambda: bytes(range(256)) * 4}[kind]()


KINDS = {"flip": 8, "truncate": 2, "empty": 1, "zeros": 1, "append": 1,
         "garbage": 1, "remove": 2, "folder": 1, "swap": 1}


def draw(draws):
    """A function that damages one file of the folder it is called with."""
    kind = draws.weighted(KINDS)
    in_checkpoint = draws.chance(0.8)
    which, at, bit = draws.random(), draws.random(), draws.below(8)

    def damage(folder):
        files = sorted(path for path in folder.glob("**/*") if path.is_file()
                       and in_checkpoint == ("checkpoint" in path.parts))
        if not files:
            return "nothing to damage"
        path = files[int(which * len(files))]
        if kind in ("remove", "folder", "swap"):
            content = path.read_bytes()
            path.unlink()
            if kind == "folder":
                path.mkdir()
            elif kind == "swap":
                other = files[int(at * len(files))]
                if other != path:
                    shutil.copyfile(other, path)
                    other.write_bytes(content)
        else:
            path.write_bytes(change(kind, path.read_bytes(), at, bit))
        return f"{kind} {path.relative_to(folder)}"
    return damage
