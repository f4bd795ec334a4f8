"""What a program must never do, whatever its input is."""

import re
import signal

MOST_WORDS = 60
LONGEST_WORD = 200

CODES = {0, 1, 2, 3, 4}
SIGNALS = {128 + int(number) for number in (signal.SIGTERM, signal.SIGINT)}

# Things that only the machinery below the program says.
RAW = ["std::", "what():", "terminate called", "bad_alloc", "basic_string",
       "vector::", "map::at", "stoi", "stod", "iostream error", "boost::",
       "dealii::", "An error occurred in", "The violated condition was",
       "Additional information:", "Stacktrace", "stack trace", "Backtrace",
       "HDF5-DIAG", "MPI_ABORT", "MPI_Abort", "[libsc]", "Abort:", "p4est",
       "Epetra", "Teuchos", "mu::", "muParser", "Assertion", "assertion",
       "Segmentation", "Floating point exception", "Process received signal",
       "core dumped", "Sanitizer", "runtime error:"]
RULE = re.compile(r"^-{8,}\s*$", re.MULTILINE)
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f]")
# Names libraries with their versions, as it should.
BANNER = re.compile(r"^deal\.II .*Trilinos.*p4est.*$", re.MULTILINE)


def warnings(stdout):
    """On the screen each stands in a line of its own."""
    return [line for line in stdout.splitlines()
            if line.startswith(("Error: ", "Warning: "))]


def errors(stderr):
    """All that stands behind an 'Error: ' belongs to it."""
    return [text.strip() for text in
            re.split(r"^(?=Error: |Warning: )", stderr, flags=re.MULTILINE)
            if text.strip()]


def on_end(outcome):
    if outcome.killed:
        return ["hangs: had to be killed"]
    if outcome.code < 0:
        return [f"died of {signal.Signals(-outcome.code).name} after "
                f"{outcome.seconds:.1f} s"]
    if outcome.code not in CODES | SIGNALS:
        return [f"exit code {outcome.code} is none of the documented ones"]
    return []


def on_words(outcome):
    found = []
    for stream in (outcome.stdout, outcome.stderr):
        plain = BANNER.sub("", stream)
        found += [f"raw words: {word}" for word in RAW if word in plain]
        if RULE.search(plain):
            found.append("a rule of dashes, as around raw exceptions")
        control = CONTROL.search(plain)
        if control:
            found.append(f"control byte {control[0]!r} in what it says")
        if "\ufffd" in plain:
            found.append("bytes that are no UTF-8 in what it says")
    return found


def on_length(text):
    """What is wrong with the form of one message."""
    words = text.partition(": ")[2].split() or [""]
    found = []
    if len(words) >= MOST_WORDS:
        found.append(f"message of {len(words)} words: {text[:600]}")
    if max(map(len, words)) > LONGEST_WORD:
        found.append(f"message with a word of {max(map(len, words))} letters: "
                     f"{text[:200]}")
    return found


def on_messages(outcome):
    found = []
    said = errors(outcome.stderr)
    for text in warnings(outcome.stdout) + said:
        found += on_length(text)
        if "\n" in text:
            found.append(f"message of several lines: {text[:200]}")
    foreign = [text for text in said
               if not text.startswith(("Error: ", "Warning: "))]
    if foreign:
        found.append(f"noise on the error stream: {foreign[0][:200]}")
    said = [text for text in said if text.startswith("Error: ")]
    if outcome.code in (1, 2, 3) and len(said) != 1:
        found.append(f"exit code {outcome.code} with {len(said)} messages")
    if outcome.code == 0 and said:
        found.append(f"exit code 0 with an error: {said[0][:300]}")
    if any(len(text.split()) < 8 for text in said):
        found.append(f"hardly a message: {said}")
    return found


def on_traces(outcome, limits):
    found = []
    if outcome.memory > limits.memory:
        found.append(f"took {outcome.memory >> 20} MiB of memory")
    if outcome.strangers:
        found.append("changed outside its folder: "
                     + ", ".join(outcome.strangers[:5]))
    return found


def complaints(outcome, limits):
    """All that is wrong with a run; nothing, if nothing is."""
    return (on_end(outcome) + on_words(outcome) + on_messages(outcome)
            + on_traces(outcome, limits))
