"""Mutations of a prm file as text: bytes, lines, numbers, values."""

import re

EXTREMES = [b"0", b"-1", b"1e300", b"nan", b"1e-300", b"2147483648", b"",
            b"5 m", b"-0", b"inf", b"-1e300", b"1e400", b"0x10", b"1,5",
            b"1e5", b"1e9", b"4294967296", b"18446744073709551616", b"1e-9",
            b"0.5", b"3", b"-2147483649", b"1e", b"++1", b"1 2", b"100000"]

VALUES = [b"", b"none", b"true", b"a", b"x", b"rand()", b"1/0", b"0/0",
          b"sqrt(-1)", b"x; y; z; t", b";;;", b",,,", b"a, a", b"1e300*x",
          b"(" * 300 + b"x" + b")" * 300, b"if(x>0", b"x^y^x^y", b"|", b"=",
          b"name = 1, name = 2", b"../../..", b"/dev/null", b".", b"/",
          b"a/b", b"\"", b"'", b"<>&", b"%s%n", b"$HOME", b"\\", b"auto",
          "Größe".encode(), b"1" * 400, b"a" * 5000, b"x" * 1_000_000]

NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")


def flip_bytes(text, draws):
    changed = bytearray(text)
    for _ in range(draws.between(1, 4)):
        changed[draws.below(len(changed))] ^= 1 << draws.below(8)
    return bytes(changed)


def control_bytes(text, draws):
    for _ in range(draws.between(1, 3)):
        place = draws.below(len(text) + 1)
        byte = draws.choose([b"\0", b"\x01", b"\x07", b"\x1b[2J", b"\x7f",
                             b"\xff", b"\xc3", b"\r", b"\t", b"\x0c"])
        text = text[:place] + byte + text[place:]
    return text


def truncate(text, draws):
    return text[:draws.below(len(text))]


def with_lines(change):
    """A mutation of the list of lines as one of the text."""
    def mutation(text, draws):
        lines = text.split(b"\n")
        change(lines, draws)
        return b"\n".join(lines)
    mutation.__name__ = change.__name__
    return mutation


@with_lines
def delete_line(lines, draws):
    del lines[draws.below(len(lines))]


@with_lines
def double_line(lines, draws):
    lines.insert(draws.below(len(lines)), lines[draws.below(len(lines))])


@with_lines
def swap_lines(lines, draws):
    one, other = draws.below(len(lines)), draws.below(len(lines))
    lines[one], lines[other] = lines[other], lines[one]


@with_lines
def join_lines(lines, draws):
    place = draws.below(len(lines))
    lines[place:place + 2] = [b" ".join(lines[place:place + 2])]


@with_lines
def nest(lines, draws):
    """Sections in sections, some of them without an end."""
    depth = draws.choose([1, 2, 20, 3000])
    place = draws.below(len(lines) + 1)
    lines[place:place] = ([b"subsection A"] * depth
                          + [b"end"] * draws.choose([0, depth - 1, depth]))


@with_lines
def replace_value(lines, draws):
    places = [n for n, line in enumerate(lines)
              if line.strip().startswith(b"set ")]
    if places:
        place = draws.choose(places)
        name, _, _ = lines[place].partition(b"=")
        lines[place] = name + b"= " + draws.choose(VALUES)


@with_lines
def take_value_from_elsewhere(lines, draws):
    places = [n for n, line in enumerate(lines)
              if line.strip().startswith(b"set ")]
    if places:
        place, other = draws.choose(places), draws.choose(places)
        name, _, _ = lines[place].partition(b"=")
        lines[place] = name + b"=" + lines[other].partition(b"=")[2]


def replace_number(text, draws):
    comment_free = [match for match in NUMBER.finditer(text)
                    if b"#" not in text[text.rfind(b"\n", 0, match.start()) + 1:
                                        match.start()]]
    if not comment_free:
        return text
    for _ in range(draws.choose([1, 1, 2])):
        match = draws.choose(comment_free)
    return (text[:match.start()] + draws.choose(EXTREMES)
            + text[match.end():])


def foreign_line_ends(text, draws):
    return draws.choose([b"", b"\xef\xbb\xbf"]) + text.replace(
        b"\n", draws.choose([b"\r\n", b"\r"]))


WEIGHTS = {flip_bytes: 2, control_bytes: 1, truncate: 1, delete_line: 2,
           double_line: 1, swap_lines: 1, join_lines: 1, nest: 1,
           replace_value: 5, take_value_from_elsewhere: 2,
           replace_number: 8, foreign_line_ends: 0.5}


def mutate(text, draws):
    """The mutated text and what has been done to it."""
    done = []
    for _ in range(draws.choose([1, 1, 1, 2, 3])):
        if not text:
            break
        mutation = draws.weighted(WEIGHTS)
        text = mutation(text, draws)
        done.append(mutation.__name__)
    return text, done
