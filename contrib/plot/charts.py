"""What all charts of the project share: the modules they need, one palette for
methods, names of axes with units, and pictures that are written as a whole or
not at all.

Import this file first: without the modules it ends with a message instead of a
traceback. It imports matplotlib for files only, no window is ever opened.
"""

import os
import sys
import tempfile
import zlib
from pathlib import Path

WANTED = ("numpy", "matplotlib")


def need(*modules):
    """Ends with exit code 1 and one message where a module is missing."""
    missing = []
    for module in modules:
        try:
            __import__(module)
        except ImportError:
            missing.append(module)
    if missing:
        sys.exit(
            f"{Path(sys.argv[0]).name}: {sys.executable} has no "
            f"{' and no '.join(missing)}. Usually another Python comes before "
            "that of the system in the path. On Debian '/usr/bin/python3' has "
            "them after 'apt-get install "
            + " ".join(f"python3-{module}" for module in missing)
            + "'; LIMBER_PYTHON names the Python that 'limber plot', 'limber "
            "animate' and 'limber study' call.")


need(*WANTED)

import matplotlib  # noqa: E402
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

plt.rcParams.update({
    "font.size": 10, "axes.titlesize": 10, "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False,
    "figure.dpi": 100, "savefig.dpi": 150, "svg.fonttype": "none",
    "pdf.fonttype": 42, "svg.hashsalt": "limber"})

# Bodies, columns, runs: colours that stay apart for all kinds of sight (Okabe and
# Ito 2008), in the order of their contrast on white.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9",
           "#777777"]
plt.rcParams["axes.prop_cycle"] = plt.cycler(color=COLOURS)

ENDINGS = (".png", ".pdf", ".svg")


# ---- one palette: what a method is drawn with, wherever it occurs --------------

# Those colours, and some darker and lighter ones. By treatment of locking:
TREATMENTS = {
    "none": "#777777", "cell": "#0072B2", "cell shear": "#56B4E9",
    "cell full": "#00366b", "node": "#009E73", "hybrid": "#8a8d00",
    "assumed strain": "#D55E00", "keep": "#0072B2"}

# By kernel and frame where nothing else is said:
ALONE = {
    "linear": ("#777777", "o", "-"),
    "quadratic": ("#CC79A7", "s", "--"), "CPDI": ("#6a3d9a", "D", "-."),
    "cubic": ("#d01c8b", "p", "--"), "GIMP": ("#33a02c", "v", "-."),
    "cpGIMP": ("#17807e", "^", "-."), "CPDI2": ("#7a0177", "d", "-."),
    "DDMP": ("#b2443a", "H", "--"),
    "initial frame": ("#E69F00", "*", ":"),
    "quasi-static": ("#08519c", "h", "-"), "implicit": ("#08519c", "8", "-"),
    "FEM Q1": ("#b15928", "P", "-"), "FEM Q1-P0-P0": ("#000000", "X", "-"),
    "FEM Q2": ("#8c5a2b", "p", "--"), "FEM Q2-P1-P1": ("#000000", "h", "--"),
    "USL": ("#D55E00", "^", "-"), "USF": ("#009E73", "v", "-"),
    "MUSL": ("#0072B2", "o", "-"), "USAVG": ("#E69F00", "D", "-"),
    "MUSL cell": ("#56B4E9", "s", "--"),
    "MUSL assumed strain": ("#CC79A7", "P", "-."),
    "PIC": ("#D55E00", "v", "-"), "FLIP": ("#0072B2", "o", "-"),
    "PIC-FLIP blend": ("#56B4E9", "s", "--"), "APIC": ("#009E73", "^", "-"),
    "2 points": ("#0072B2", "o", "-"), "3 points": ("#D55E00", "s", "-"),
    "4 points": ("#009E73", "^", "-"),
    "3 points finer": ("#CC79A7", "D", "--"),
    "relax": ("#56B4E9", "s", "--"), "crossing": ("#CC79A7", "v", "--"),
    "replace": ("#E69F00", "D", "-."),
    "fine everywhere": ("#0072B2", "o", "-"),
    "fine around the footing": ("#D55E00", "s", "--"),
    "fine near the surface": ("#009E73", "^", "--"),
    "fine where sheared": ("#CC79A7", "D", "-."),
    "exact": ("#000000", "", "-"), "literature": ("#000000", "^", "")}

# Marker and line of a kernel that comes before or behind a treatment:
KERNELS = {
    "linear": ("o", "-"), "quadratic": ("s", "--"),
    "cubic": ("p", "--"), "GIMP": ("v", "-."),
    "cpGIMP": ("^", "-."), "CPDI": ("D", "-."), "CPDI2": ("d", "-."),
    "DDMP": ("H", "--"),
    "initial": ("*", ":"), "initial frame": ("*", ":"),
    "quasi-static": ("h", "-"), "implicit": ("8", "-")}

# What a method differs in from the one it is named after, 'cell with APIC'. With
# a kernel beside it, marker and line are the kernel's.
CHANGES = {
    "USF": ("#33a02c", "v"), "USL": ("#b2443a", "^"), "MUSL": ("#7f9ccb", "<"),
    "USAVG": ("#b8860b", ">"),
    "APIC": ("#e31a1c", "^"), "AFLIP": ("#e7298a", "v"),
    "FMPM": ("#17807e", "H"),
    "3 points": ("#17807e", "P"), "3 x 3": ("#17807e", "P"),
    "soft water": ("#a6761d", "X"), "chi 0.3": ("#6a51a3", "d"),
    "Blend time": ("#a6761d", "X"), "control": ("#d01c8b", "d"),
    "bending": ("#6a3d9a", "D"), "replaced": ("#8a8d00", "p"),
    "semi-implicit": ("#08519c", "*"), "implicit": ("#08519c", "8"),
    "quasi-static": ("#08519c", "h")}

SPARE = ("#1f78b4", "#b2443a", "#33a02c", "#6a51a3", "#b15928", "#a6761d",
         "#17807e", "#d01c8b")
MARKERS = "os^vD<>pPXh"


def kernel_and_treatment(method):
    """('quadratic', 'node') of 'quadratic node'; nothing of any other name."""
    kernel = next((k for k in sorted(KERNELS, key=len, reverse=True)
                   if method.startswith(f"{k} ")), None)
    treatment = method[len(kernel) + 1:] if kernel else ""
    return (kernel, treatment) if treatment in TREATMENTS else None


# Line and filling of the marker of a treatment that stands behind a kernel.
FILLINGS = {"none": ("-", "none"), "cell": ("-", "full"),
            "node": ((0, (4, 1.5)), "left"),
            "assumed strain": ("-.", "top")}


def style_of(method):
    """Colour, marker and line of a method, by its name alone: the same in every
    chart. A kernel alone, or without treatment, has open markers; with one the
    colour and the marker stay the kernel's, the line and the filling of the
    marker say which treatment. A name that is not known gets a style that only
    depends on it."""
    filling = "full"
    known = kernel_and_treatment(method)
    if method in ALONE:
        colour, marker, line = ALONE[method]
        if method in KERNELS and method not in ("initial frame", "quasi-static",
                                                "implicit"):
            filling = "none"
    elif known:
        kernel, treatment = known
        colour, marker, _ = ALONE[kernel if kernel != "initial"
                                  else "initial frame"]
        line, filling = FILLINGS.get(treatment, (":", "full"))
    else:
        words = method.replace(",", " ").replace("(", " ").split()
        text = f" {' '.join(words)} "
        kernel = next((k for k in sorted(KERNELS, key=len, reverse=True)
                       if f" {k} " in text), None)
        rest = text.replace(f" {kernel} ", " ", 1) if kernel else text
        treatment = next((t for t in sorted(TREATMENTS, key=len, reverse=True)
                          if f" {t} " in rest), None)
        change = next((c for c in sorted(CHANGES, key=len, reverse=True)
                       if f" {c} " in rest), None)
        marker, line = KERNELS.get(kernel, ("o", "-"))
        if change and not kernel:
            marker, line = CHANGES[change][1], "--"
        elif change in ("implicit", "quasi-static"):
            marker = CHANGES[change][1]
        if change:
            colour = CHANGES[change][0]
        elif treatment:
            colour = TREATMENTS[treatment]
        elif kernel:
            colour = ALONE[kernel if kernel != "initial"
                           else "initial frame"][0]
        else:
            number = zlib.crc32(method.encode())
            colour, marker = SPARE[number % 8], MARKERS[number // 8 % 11]
    return {"color": colour, "marker": marker or "None",
            "linestyle": line or "None", "fillstyle": filling}


def styles_of(methods):
    """style_of() each of the methods in one chart; where two would look alike,
    the later one gets another marker and dashes."""
    styles, seen = {}, set()
    for method in methods:
        style = style_of(method)
        for marker in MARKERS:
            look = tuple(map(str, style.values()))
            if look not in seen:
                break
            style.update(marker=marker, linestyle=(0, (2, 1)))
        seen.add(look)
        styles[method] = style
    return styles


def line_of(method):
    """As style_of(), for dense curves: without markers."""
    return {**style_of(method), "marker": "None"}


# ---- axes -----------------------------------------------------------------------

PREFIXES = {**dict.fromkeys(("Pa", "J", "N"),
                            ((1e9, "G"), (1e6, "M"), (1e3, "k"))),
            # 0.15 s, but 50 ms
            **dict.fromkeys(("s", "m"), ((1, ""), (1e-3, "m"), (1e-6, "µ")))}


def scaled_unit(unit, largest):
    """Factor and unit that make numbers up to @p largest short: 1e6, 'MPa'."""
    for factor, prefix in PREFIXES.get(unit, ()):
        if largest >= factor * (1 if factor > 1 else 0.1):
            return factor, prefix + unit
    return 1, unit


def with_time(seconds, longest):
    """'t = 20 µs', in the unit that suits the longest of several times."""
    factor, unit = scaled_unit("s", longest)
    return f"t = {seconds / factor:.4g} {unit}"


def with_unit(name, unit):
    """'pressure [kPa]'; what has no unit stands alone."""
    return f"{name} [{unit}]" if unit else name


def legend_outside(axis, **options):
    """To the right of an axis, where it hides nothing."""
    handles, _ = axis.get_legend_handles_labels()
    if handles:
        axis.legend(**{"loc": "upper left", "bbox_to_anchor": (1.01, 1.02),
                       "fontsize": 8, **options})


# ---- pictures -------------------------------------------------------------------


def fail(message):
    """Ends with exit code 1; nothing has been written or changed."""
    sys.exit(f"Error: {message}")


def check_ending(path, endings=ENDINGS):
    path = Path(path)
    if path.suffix.lower() not in endings:
        fail(f"The picture '{path}' must end in {', '.join(endings[:-1])} or "
             f"{endings[-1]}; its ending says what is written.")
    if not os.access(path.parent, os.W_OK | os.X_OK) or path.is_dir():
        fail(f"The picture '{path}' cannot be written: "
             + ("that is a folder." if path.is_dir() else
                f"there is no folder '{path.parent}'. Usually it is misspelt."
                if not path.parent.is_dir() else
                f"the folder '{path.parent}' is not open to you."))
    return path


def save(figure, path, close=True, pixels=1600, **options):
    """Writes beside the place and moves there: a picture that is there is
    replaced by a whole one or stays. pixels: the width of a PNG."""
    path = Path(path)
    try:
        handle, scratch = tempfile.mkstemp(suffix=path.suffix, dir=path.parent)
        os.close(handle)
        try:
            figure.savefig(scratch, dpi=pixels / figure.get_size_inches()[0],
                           **options)
            os.chmod(scratch, 0o666 & ~_mask())
            os.replace(scratch, path)
        except BaseException:
            os.unlink(scratch)
            raise
    except OSError as error:
        fail(f"The picture '{path}' cannot be written: {error.strerror}.")
    if close:
        plt.close(figure)
    print(path)


def _mask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
