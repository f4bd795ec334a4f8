"""Other values for an entry, within the range that the program prints."""

import re

FACTORS = [0.01, 0.1, 0.5, 0.9, 0.99, 1.01, 1.1, 1.5, 2, 3, 10, 100]
SMALL = [0.001, 0.1, 0.25, 0.5, 1, 2, 10]
FORMULAS = ["0", "1", "x", "y", "t", "x*y", "-9.81*t", "sin(pi*x)", "x-0.5",
            "1e3*exp(-x^2)", "if(x>0.5,1,0)", "sqrt(x)", "1e-3/x"]


def number_near(value, draws, least=None, most=None):
    """A multiple of the value, or a small number in place of zero."""
    try:
        number = float(value)
    except ValueError:
        number = 0.0
    changed = number * draws.choose(FACTORS) if number else draws.choose(SMALL)
    if least is not None and changed <= least:
        changed = least + draws.choose(SMALL)
    if most is not None and changed >= most:
        middle = least if least is not None else most - 1
        changed = middle + (most - middle) * draws.choose([0.01, 0.5, 0.99])
    return f"{changed:.6g}"


def integer_near(value, draws, least=1):
    """Few enough that a run starts at once."""
    number = int(float(value)) if re.fullmatch(r"[\d.]+", value) else 2
    changed = draws.choose([number - 1, number + 1, number * 2, number // 2,
                            draws.between(1, 12)])
    return str(min(max(changed, least), 150))


def one_word(admissible, draws):
    words = admissible.split(" | ")
    words[-1] = re.split(r", or |, separated", words[-1])[0]
    return draws.choose(words)


def list_of(value, count, one_of_them):
    parts = [part.strip() for part in value.split(",")]
    if len(parts) != count:
        parts = ["1"] * count
    return ", ".join(map(one_of_them, parts))


def formula(admissible, draws):
    components = re.search(r"with (\d) components", admissible)
    return "; ".join(draws.choose(FORMULAS)
                     for _ in range(int(components[1]) if components else 1))


def draw(entry, draws):
    """A value for the entry, or None where the range does not tell."""
    words = entry.admissible
    if "or empty" in words and draws.chance(0.15):
        return ""
    special = re.search(r", or '([^']*)'", words)
    if special and draws.chance(0.3):
        return special[1]
    for start in ("one of ", "some of "):
        if words.startswith(start):
            return one_word(words[len(start):], draws)
    if "formula of" in words:
        return formula(words, draws)
    several = re.search(r"(\d) (numbers|integers)", words)
    if several and several[2] == "integers":
        return list_of(entry.value, int(several[1]),
                       lambda part: integer_near(part, draws))
    if several:
        return list_of(entry.value, int(several[1]),
                       lambda part: number_near(part, draws))
    if words.startswith("an integer"):
        return integer_near(entry.value, draws,
                            1 if "greater than 0" in words else 0)
    if words.startswith("a number"):
        least = re.search(r"(?:greater than|not less than|from) ([-\d.e]+)",
                          words)
        most = re.search(r"(?:and less than|to) ([-\d.e]+)", words)
        return number_near(entry.value, draws,
                           float(least[1]) if least else None,
                           float(most[1]) if most else None)
    return None


def changes(entries, draws):
    """Some 'Section/Name=value', what they set is admissible by itself."""
    # Names decide which sections there are, paths lead elsewhere: nothing is
    # drawn for these.
    entries = [entry for entry in entries
               if re.match("(a|an|one|some|\\d) |formula of", entry.admissible)]
    result = {}
    for _ in range(draws.choose([1, 1, 2, 3, 5])):
        entry = draws.choose(entries)
        value = draw(entry, draws)
        if value is not None:
            result[entry.path] = value
    return [f"{path}={value}" for path, value in result.items()]
