"""Mutations of a scene as JSON: its structure rather than its bytes.

An object is a list of [key, value] pairs, as keys may come twice; a value is
such a list, or the text of any other JSON value.
"""

import json


def tree_of(entries):
    """The nested object of a list of entries."""
    tree = []
    for entry in entries:
        node = tree
        for name in entry.section:
            found = [pair for pair in node if pair[0] == name]
            if not found:
                found = [[name, []]]
                node.append(found[0])
            node = found[0][1]
        node.append([entry.name, json.dumps(entry.value)])
    return tree


def text_of(node):
    if isinstance(node, str):
        return node
    return "{" + ",\n".join(json.dumps(key) + ": " + text_of(value)
                            for key, value in node) + "}"


def objects(tree):
    """The tree and all objects in it."""
    found = [tree]
    for _, value in tree:
        if isinstance(value, list):
            found += objects(value)
    return found


def some_pair(tree, draws):
    """An object that is not empty, and a place in it."""
    node = draws.choose([node for node in objects(tree) if node] or [[]])
    return node, draws.below(len(node))


VALUES = ["null", "true", "false", "1", "-1", "1e300", "2147483648", "1e999",
          "[]", "{}", "[1, 2]", '["a", ["b"]]', '""', '"\\u0000"',
          '"a\\nset End time = 2"', '"\\ud800"', '"\\u001b[2J"', "NaN",
          "[null]", '{"value": "1"}', '{"value": null, "pattern": "x"}',
          '{"": ""}', '"' + "a" * 100_000 + '"']

LEVELS = [3, 15, 17, 100, 5000, 100_000]


def change_type(tree, draws):
    node, place = some_pair(tree, draws)
    node[place][1] = draws.choose(VALUES)


def delete(tree, draws):
    node, place = some_pair(tree, draws)
    del node[place]


def rename(tree, draws):
    node, place = some_pair(tree, draws)
    node[place][0] = draws.choose(
        ["", " ", "/", ".", "..", "\0", "end", "subsection A", "\n", "'",
         node[place][0] + "s", node[place][0].upper(), "a" * 10_000])


def double_key(tree, draws):
    node, place = some_pair(tree, draws)
    other, source = some_pair(tree, draws)
    node.insert(place, [node[place][0], other[source][1]
                        if isinstance(other[source][1], str) else "{}"])


def move(tree, draws):
    node, place = some_pair(tree, draws)
    pair = node.pop(place)
    target = draws.choose([to for to in objects(tree) if to is not pair[1]])
    if pair[1] is target or (isinstance(pair[1], list)
                             and any(to is target for to in objects(pair[1]))):
        target = tree
    target.append(pair)


def nest_deeply(tree, draws):
    node, place = some_pair(tree, draws)
    levels = draws.choose(LEVELS)
    start, end = draws.choose([("[", "]"), ('{"a":', "}")])
    node[place][1] = start * levels + "1" + end * levels


WEIGHTS = {change_type: 6, delete: 2, rename: 3, double_key: 2, move: 2,
           nest_deeply: 2}


def break_text(text, draws):
    """Not JSON any more."""
    place = draws.below(len(text))
    return draws.choose([text[:place], text[:place] + "," + text[place:],
                         "[" + text + "]", text + text, text[:place]
                         + "\0" + text[place:], "1", '"a"', "null", "[]"])


def mutate(tree, draws):
    """The text of the mutated tree and what has been done to it."""
    done = []
    for _ in range(draws.choose([1, 1, 2, 3])):
        if not any(objects(tree)):
            break
        mutation = draws.weighted(WEIGHTS)
        mutation(tree, draws)
        done.append(mutation.__name__)
    text = text_of(tree) + "\n"
    if draws.chance(0.15):
        text = break_text(text, draws)
        done.append("break_text")
    return text.encode(), done
