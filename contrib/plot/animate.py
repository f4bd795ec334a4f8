#!/usr/bin/python3
"""limber animate RUN [RUN ...] [options]

Makes a film of a field, all its pictures one after the other with the same
colours; of several runs one below the other, at the same times. Ends in .mp4
(with ffmpeg, Debian: apt-get install ffmpeg) or .gif; without '--output' it is
animation.mp4, of several runs comparison_animation.mp4, in the folder of the first
run. '--frames FOLDER' keeps the pictures.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import charts
import panels
import plot
from charts import np, plt


def write_frames(arguments, sources, labels, folder):
    """One PNG a picture of the first run, all of one size."""
    look = plot.look_of(arguments, sources)
    times = sources[0].times
    # Colours and corners from some ten states, then for good.
    some = np.unique(np.linspace(0, len(times) - 1, 10).round().astype(int))
    look.fix([panels.State(source, source.nearest(times[i]), look)
              for source in sources for i in some])
    look.limits = (look.norm.vmin, look.norm.vmax)
    look.zoom = look.lower, look.upper
    for number, time in enumerate(times):
        states = [[panels.State(source, source.nearest(time), look)]
                  for source in sources]
        figure = panels.figure_of(states, look, labels, width=8)
        # ffmpeg wants even numbers of pixels
        dpi = 150
        inches = [2 * round(side * dpi / 2) / dpi
                  for side in figure.get_size_inches()]
        figure.set_size_inches(inches)
        figure.savefig(folder / f"frame_{number:05}.png", dpi=dpi)
        plt.close(figure)
    return len(times)


def write_mp4(frames, path, rate):
    command = ["ffmpeg", "-loglevel", "error", "-y", "-framerate", str(rate),
               "-i", str(frames / "frame_%05d.png"), "-vf",
               "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264",
               "-pix_fmt", "yuv420p", "-crf", "18", str(path)]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        charts.fail(f"ffmpeg could not write '{path}': {done.stderr.strip()}")


def write_gif(frames, path, rate):
    charts.need("PIL")
    from PIL import Image
    pictures = [Image.open(frame).convert("RGB")
                for frame in sorted(frames.glob("frame_*.png"))]
    # One palette for the whole film, from pictures spread over it, so that
    # colours do not change from one picture to the next.
    chosen = pictures[::max(1, len(pictures) // 8)]
    width, height = chosen[0].size
    sheet = Image.new("RGB", (width, height * len(chosen)))
    for k, picture in enumerate(chosen):
        sheet.paste(picture, (0, k * height))
    palette = sheet.quantize(256)
    pictures = [picture.quantize(palette=palette, dither=Image.FLOYDSTEINBERG)
                for picture in pictures]
    pictures[0].save(path, save_all=True, append_images=pictures[1:],
                     duration=round(1000 / rate), loop=0)


def main(words=None):
    parser = plot.parser_for("animate", __doc__)
    parser.add_argument("--rate", type=float, default=15, metavar="N",
                        help="pictures a second (15)")
    parser.add_argument("--frames", type=Path, metavar="FOLDER",
                        help="keep the single pictures here")
    arguments = parser.parse_args(words)
    sources, labels = plot.checked(arguments)
    path = charts.check_ending(
        arguments.output or sources[0].folder / (
            "comparison_animation.mp4" if len(sources) > 1
            else "animation.mp4"),
        (".mp4", ".gif"))
    if arguments.rate <= 0:
        charts.fail("'--rate' must be greater than 0.")
    if path.suffix.lower() == ".mp4" and not shutil.which("ffmpeg"):
        charts.fail("A film in .mp4 needs ffmpeg, which was not found. On Debian "
                    "'apt-get install ffmpeg' provides it; a name that ends in "
                    ".gif goes without: --output "
                    f"{path.with_suffix('.gif')}")
    if arguments.frames:
        arguments.frames.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        frames = arguments.frames or Path(scratch)
        number = write_frames(arguments, sources, labels, frames)
        film = Path(scratch) / f"film{path.suffix.lower()}"
        (write_gif if film.suffix == ".gif" else write_mp4)(
            frames, film, arguments.rate)
        os.replace(film, path)
    print(f"{path} ({number} pictures)")


if __name__ == "__main__":
    sys.exit(main())
