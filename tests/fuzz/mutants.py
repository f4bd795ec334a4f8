"""Mutant number n of a seed: its files, and the command that meets them."""

import json
from typing import NamedTuple

import admissible_values
import folder_damage
import json_mutations
import mesh_mutations
import sources
import text_mutations
from draws import Draws

KINDS = {"text": 38, "json": 17, "admissible": 25, "folder": 12, "mesh": 8}

# Few steps, and an end by itself where steps take long.
# Small as well: a large grid may take longer than a mutant is given.
SHORT = ["End step=5", "Checkpoint/Wall time limit=5", "Memory limit=1"]
SMALL_REFERENCE = ["Reference/Elements over depth=1", "End time=0.01",
                   "Reference/Time step=0.002"]


class Mutant(NamedTuple):
    kind: str
    source: str
    done: list  # what was done to the source, in words
    files: dict  # path in the folder of the mutant: bytes
    words: list  # of the command line, without the program
    damage: object = None  # called with the run folder before the command


def settings(changes):
    return [word for change in changes for word in ("--set", change)]


def scene_command(draws, name, changes=()):
    """One of the ways to use a scene."""
    way = draws.weighted({"run": 9, "validate": 3, "reference": 2, "advise": 1})
    last = ["--output-directory", "run"]
    if way == "validate":
        return ["--validate", name, *settings(changes)]
    if way == "advise":
        return ["advise", name, *settings(changes)]
    if way == "reference":
        frequencies = ["--frequencies", "2"] if draws.chance(0.3) else []
        return ["reference", *frequencies, name,
                *settings([*changes, *SMALL_REFERENCE]), *last]
    return [name, *settings([*changes, *SHORT]), *last]


def study_command(draws, name):
    """Mostly checks: a study that runs takes longer than any scene."""
    way = draws.choose(["study", "study", "stability"])
    check = [] if draws.chance(0.25) else ["--validate"]
    return [way, "--short", *check, name, "--output-directory", "run"]


def with_few_steps(text):
    """A study whose runs are short; what it says is mutated afterwards."""
    few = b"End step=3 | Checkpoint/Wall time limit=2 | Memory limit=1"
    lines = text.split(b"\n")
    for number, line in enumerate(lines):
        if line.startswith(b"set Settings"):
            lines[number] = line + b" | " + few
            return b"\n".join(lines)
    return text + b"set Settings = " + few + b"\n"


def study_files(path, text):
    """The study where it finds its scenes."""
    files = {other: sources.read(other) for other in sources.all_files()
             if other.startswith("prm/")}
    return {**files, path: text}


def text_mutant(limber, draws):
    study = draws.chance(0.2)
    source = draws.choose(sources.studies() if study else sources.scenes())
    text = sources.read(source)
    text, done = text_mutations.mutate(with_few_steps(text) if study else text,
                                       draws)
    if study:
        return Mutant("text", source, done, study_files(source, text),
                      study_command(draws, source))
    return Mutant("text", source, done, {"scene.prm": text},
                  scene_command(draws, "scene.prm"))


def json_mutant(limber, draws):
    if draws.chance(0.15):
        source = draws.choose(sources.studies())
        tree = json_mutations.tree_of(
            sources.parse(with_few_steps(sources.read(source)).decode()))
        text, done = json_mutations.mutate(tree, draws)
        name = source.replace(".prm", ".json")
        return Mutant("json", source, done, study_files(name, text),
                      study_command(draws, name))
    source = draws.choose(sources.scenes())
    tree = json_mutations.tree_of(sources.printed_entries(limber, source))
    text, done = json_mutations.mutate(tree, draws)
    return Mutant("json", source, done, {"scene.json": text},
                  scene_command(draws, "scene.json"))


def admissible_mutant(limber, draws):
    source = draws.choose(sources.scenes())
    changes = admissible_values.changes(
        sources.printed_entries(limber, source), draws)
    return Mutant("admissible", source, changes,
                  {"scene.prm": sources.read(source)},
                  scene_command(draws, "scene.prm", changes))


def folder_mutant(limber, draws):
    """A run folder with a checkpoint, damaged; then one goes on from it."""
    damages = [folder_damage.draw(draws)
               for _ in range(draws.choose([1, 1, 1, 2]))]
    changes = folder_damage.CHANGES
    scene = ["scene.prm", *settings(changes), "--output-directory", "run"]
    words = draws.choose([[*scene, "--resume", "--set", "End step=24"],
                          [*scene, "--resume"],
                          [*scene, "--resume", "--set", "Replace=true"],
                          [*scene, "--set", "Output/Replace=true"], scene,
                          ["compare", "run", "run"]])

    def damage(folder):
        return [one(folder) for one in damages]
    return Mutant("folder", folder_damage.SCENE, [],
                  {"scene.prm": sources.read(folder_damage.SCENE)}, words,
                  damage)


def mesh_mutant(limber, draws):
    """A mesh file for the reference of a beam."""
    source = "prm/cantilever.prm"
    name, text, done = mesh_mutations.draw(draws)
    changes = ["Reference/Mesh file=" + name, *SMALL_REFERENCE]
    frequencies = ["--frequencies", "2"] if draws.chance(0.3) else []
    return Mutant("mesh", source, done,
                  {"scene.prm": sources.read(source), name: text},
                  ["reference", *frequencies, "scene.prm",
                   *settings(changes), "--output-directory", "run"])


MAKERS = {"text": text_mutant, "json": json_mutant,
          "admissible": admissible_mutant, "folder": folder_mutant,
          "mesh": mesh_mutant}


def make(limber, seed, number):
    """The same for the same seed and number, whatever was made before."""
    draws = Draws("limber fuzz", seed, number)
    return MAKERS[draws.weighted(KINDS)](limber, draws)
