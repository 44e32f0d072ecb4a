#!/usr/bin/env python3
"""Draws the gallery's pictures: draw.py DATA_FOLDER PICTURE_FOLDER. DATA_FOLDER has pictures.json and PLY files.

A picture is a row of panels of one height: "map" (a planar mesh coloured by |mu|), "grid" (the image of a checkerboard or
of small circles of the source, or these on the source itself), "faces" (the image with the edges of its faces),
"histogram" (by area or by triangles), "curves", "lines", "surface" (a mesh in space with a checkerboard or circles of the map's plane, with its edges, or
coloured by |mu|). Or it is one "svg", an SVG file as chromium shows it."""
import io
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import ticker
from matplotlib.collections import PolyCollection
from PIL import Image, ImageChops

MOST_BYTES = 80_000
FLIPPED = (0.85, 0.1, 0.1, 1.0)
CHECKER = (0.30, 0.45, 0.69), (0.95, 0.93, 0.86)
PANEL = 2.9  # inches
WIDTH = 11.6
LEGEND = 1.2  # beside its panel
OFFSET = 1e-5  # of checkerboards: edges of the mesh often lie on their lines
DPI = 110
TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
         "float": "<f4", "double": "<f8", "int8": "i1", "uint8": "u1", "int32": "<i4", "uint32": "<u4",
         "float32": "<f4", "float64": "<f8"}


def read_ply(path):
    """Positions, map, triangles and |mu| of a binary PLY as the gallery writes it; quads are cut in two."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    elements = []
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    vertices = triangles = mu = None
    for name, count, properties in elements:
        if name == "vertex":
            layout = np.dtype([(p[1], TYPES[p[0]]) for p in properties])
            vertices = np.frombuffer(data, layout, count, end)
            end += layout.itemsize * count
        elif name == "face":
            triangles, mu, faces = [], [], []
            before = [p for p in properties]
            for _ in range(count):
                for p in before:
                    if p[0] == "list":
                        n = int(np.frombuffer(data, TYPES[p[1]], 1, end)[0])
                        end += np.dtype(TYPES[p[1]]).itemsize
                        face = np.frombuffer(data, TYPES[p[2]], n, end)
                        end += np.dtype(TYPES[p[2]]).itemsize * n
                    else:
                        value = np.frombuffer(data, TYPES[p[0]], 1, end)[0]
                        end += np.dtype(TYPES[p[0]]).itemsize
                        if p[1] == "abs_mu":
                            size = float(value)
                faces.append(face)
                for i in range(1, len(face) - 1):
                    triangles.append((face[0], face[i], face[i + 1]))
                    mu.append(size)
    fields = vertices.dtype.names
    space = np.stack([vertices["x"], vertices["y"], vertices["z"] if "z" in fields else 0 * vertices["x"]], 1)
    return {"space": space, "plane": np.stack([vertices["u"], vertices["v"]], 1),
            "triangles": np.array(triangles), "mu": np.array(mu), "faces": faces}


def colours_of(mu, least, largest):
    colours = matplotlib.colormaps["viridis"](np.clip((mu - least) / (largest - least), 0, 1))
    colours[mu >= 1] = FLIPPED
    return colours


def areas_of(data):
    p = data["space"][data["triangles"]]
    return 0.5 * np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)


def draw_map(axes, panel, load):
    data = load(panel["data"])
    points = data["space"][:, :2] if panel["domain"] == "source" else data["plane"]
    colours = colours_of(data["mu"], panel["min"], panel["max"])
    # Flipped faces last, so that they are seen.
    order = np.argsort(data["mu"] >= 1, kind="stable")
    polygons = points[data["triangles"][order]]
    width = 0.3 if len(polygons) < 2000 else 0.0
    # Faces also drawn as thin lines of their own colour: no seams between them.
    axes.add_collection(PolyCollection(polygons, facecolors=colours[order],
                                       edgecolors=(0, 0, 0, 0.4) if width else colours[order],
                                       linewidths=width or 0.3))
    frame(axes, points)
    return panel["min"], panel["max"]


def frame(axes, points):
    low, high = points.min(0), points.max(0)
    margin = 0.02 * (high - low).max()
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    axes.set_axis_off()


def in_circles(places, spacing):
    """Whether places of the plane lie in circles around the points of a triangular lattice."""
    inside = np.zeros(len(places), bool)
    cell = spacing * np.array([1, np.sqrt(3)])
    for offset in (0, 0.5):
        away = (places / cell - offset) - np.round(places / cell - offset)
        inside |= np.hypot(*(away * cell).T) < 0.36 * spacing
    return inside


def draw_segment(picture, seen, source, a, b, colour):
    """A straight line of the source where it is seen: as wide everywhere on the source."""
    along = (b - a) / np.linalg.norm(b - a)
    t = np.clip((source - a) @ along, 0, np.linalg.norm(b - a))
    near = np.linalg.norm(source - a - t[:, None] * along, axis=1) < 0.012
    rows, columns = np.nonzero(seen)
    picture[rows[near], columns[near]] = colour


def draw_faces(axes, panel, load):
    data = load(panel["data"])
    axes.add_collection(PolyCollection([data["plane"][face] for face in data["faces"]], facecolors=[CHECKER[1]],
                                       edgecolors=[(0.15, 0.15, 0.15)], linewidths=0.3))
    frame(axes, data["plane"])


def draw_lines(axes, panel, load):
    """Chains of points, each group in a colour of its own."""
    points = np.concatenate([np.array(line) for group in panel["groups"] for line in group["lines"]])
    for group in panel["groups"]:
        for line in group["lines"]:
            axes.plot(*np.array(line).T, color=group["colour"], linewidth=group["width"], solid_capstyle="round")
    for x, y, text in panel["labels"]:
        axes.text(x, y, text, fontsize=7, ha="center", va="center")
    frame(axes, points)


def read_svg(path):
    """The picture of an SVG, at twice its size."""
    width, height = (float(x) for x in re.search(r'width="([0-9.]+)"[^>]*height="([0-9.]+)"', path.read_text()).groups())
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"
        subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                        "--force-device-scale-factor=2", f"--window-size={int(width)},{int(height)}",
                        f"--user-data-dir={folder}/profile", f"--screenshot={picture}", path.resolve().as_uri()],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120)
        return Image.open(picture).convert("RGB")


ICING, DOUGH, SPRINKLES = (0.93, 0.55, 0.66), (0.80, 0.58, 0.33), ((0.98, 0.95, 0.80), (0.35, 0.62, 0.85), (0.98, 0.80, 0.25), (0.55, 0.78, 0.42))


def doughnut(places):
    """Colours of a doughnut with icing and sprinkles on .4 < |z| < 1."""
    radius, angle = np.hypot(*places.T), np.arctan2(places[:, 1], places[:, 0])
    wave = 0.03 * np.sin(7 * angle) + 0.02 * np.sin(11 * angle + 1)
    iced = (radius > 0.5 - wave / 2) & (radius < 0.88 + wave)
    # Darker towards both rims, as a torus is.
    height = np.sqrt(np.clip(1 - ((radius - 0.7) / 0.32) ** 2, 0, 1))
    colours = np.where(iced[:, None], ICING, DOUGH) * (0.62 + 0.38 * height[:, None])
    random = np.random.default_rng(14)
    for i in range(150):
        r, t, turn = random.uniform(0.53, 0.84), random.uniform(-np.pi, np.pi), random.uniform(0, np.pi)
        away = (places - r * np.array([np.cos(t), np.sin(t)])) @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        away[:, 0] = np.maximum(np.abs(away[:, 0]) - 0.022, 0)
        colours[iced & (np.hypot(*away.T) < 0.0085)] = SPRINKLES[i % 4]
    return colours


def draw_grid(axes, panel, load):
    data = load(panel["data"])
    pixels = 2 * int(PANEL * DPI * max(1, shape(panel, load)))
    points = data["space"][:, :2] if panel["domain"] == "source" else data["plane"]
    low, size = points.min(0), np.ptp(points, axis=0).max()
    screen = (points - low) / size * (pixels - 20) + 10
    # Flipped faces lie in front.
    depth = np.zeros(len(screen))
    depth[data["triangles"][data["mu"] >= 1]] = 1
    face, _, bary = rasterise(screen, depth, data["triangles"], pixels)
    seen = face >= 0
    flat = data["space"][:, :2]
    source = np.einsum("pi,pij->pj", bary[seen], flat[data["triangles"][face[seen]]])
    if panel["pattern"] == "doughnut":
        parity = None
    elif panel["pattern"] == "circles":
        parity = in_circles(source, np.ptp(flat, axis=0).max() / panel["count"])
    elif panel["pattern"] == "square":
        square = np.ptp(flat, axis=0).max() / panel["count"]
        parity = np.floor((source - flat.min(0)) / square + OFFSET).sum(1)
    else:
        sector = 2 * np.pi / panel["count"]
        radius = np.hypot(source[:, 0], source[:, 1])
        parity = np.floor(np.arctan2(source[:, 1], source[:, 0]) / sector + OFFSET)
        parity += np.floor(np.log(radius) / sector if panel["pattern"] == "polar" else radius * panel["count"] / 3)
    colours = doughnut(source) if parity is None else np.where(parity[:, None] % 2 == 1, CHECKER[0], CHECKER[1])
    if panel["domain"] != "source":
        colours[data["mu"][face[seen]] >= 1] = FLIPPED[:3]
    picture = np.ones((pixels, pixels, 3))
    picture[seen] = colours
    for i, (a, b) in enumerate(panel["segments"]):
        draw_segment(picture, seen, source, np.array(a), np.array(b), matplotlib.colors.to_rgb(("C3", "C1", "C2")[i % 3]))
    for chain in panel["highlights"]:
        draw_chain(picture, screen[chain])
    show(axes, picture, seen)


def draw_chain(picture, points, visible=lambda x, y, i, t: True, thin=False):
    """A black line, three pixels wide or two, through the points."""
    for i, (a, b) in enumerate(zip(points, points[1:])):
        steps = int(np.abs(a - b).max()) + 1
        for t in np.linspace(0, 1, 2 * steps):
            x, y = np.round((1 - t) * a + t * b).astype(int)
            if visible(x, y, i, t):
                picture[max(y - (not thin), 0):y + 2, max(x - (not thin), 0):x + 2] = (0.1, 0.1, 0.1)


def show(axes, picture, seen):
    """The part of a picture that is not empty."""
    rows, columns = np.flatnonzero(seen.any(1)), np.flatnonzero(seen.any(0))
    picture = picture[max(rows[0] // 2 * 2 - 8, 0):rows[-1] // 2 * 2 + 10,
                      max(columns[0] // 2 * 2 - 8, 0):columns[-1] // 2 * 2 + 10]
    axes.imshow(halved(picture), origin="lower", interpolation="none")
    axes.set_axis_off()


def halved(picture):
    """Each pixel the mean of four."""
    rows, columns = picture.shape[0] // 2, picture.shape[1] // 2
    return picture.reshape(rows, 2, columns, 2, 3).mean((1, 3))


def draw_histogram(axes, panel, load):
    bins = np.linspace(0, panel["max"], 101)
    for i, entry in enumerate(panel["series"]):
        data = load(entry["data"])
        weights = areas_of(data) if panel["weights"] == "area" else np.ones(len(data["mu"]))
        # What lies beyond the axis is counted in the last bin, flipped faces too.
        share, _ = np.histogram(np.minimum(data["mu"], panel["max"] * 0.999), bins, weights=weights)
        axes.step(bins[:-1], 100 * share / weights.sum(), where="post", label=entry["label"], linewidth=1,
                  linestyle=("-", "--", ":", "-.")[i % 4])
    if "k" in panel:
        axes.axvline(panel["k"], color="0.4", linestyle="--", linewidth=0.8)
    axes.set_xlim(0, panel["max"])
    axes.set_ylim(0)
    axes.set_xlabel("|μ|", fontsize=8)
    axes.set_ylabel("% of the area" if panel["weights"] == "area" else "% of the triangles", fontsize=8)
    axes.tick_params(labelsize=7)


def draw_curves(axes, panel, load):
    plot = axes.loglog if panel["logarithmic"] else axes.semilogy if panel.get("log_y") else axes.plot
    for entry in panel["series"]:
        plot(entry["x"], entry["y"], "o-" if panel["logarithmic"] else "-", markersize=3, linewidth=1,
             label=entry["label"])
    axes.set_xlabel(panel["x"], fontsize=8)
    axes.set_ylabel(panel["y"], fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(alpha=0.3, which="both", linewidth=0.4)
    if panel["logarithmic"]:
        axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
        axes.yaxis.set_minor_formatter(ticker.NullFormatter())
        if max(max(entry["x"]) for entry in panel["series"]) < 100 * min(min(entry["x"]) for entry in panel["series"]):
            axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 4, 8)))
            axes.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
            axes.xaxis.set_minor_formatter(ticker.NullFormatter())


def legends_of(panels):
    """Panels that have a legend: of those side by side with the same names in the same colours the last."""
    names = [[entry["label"] for entry in panel["series"]] if panel["kind"] in ("histogram", "curves") else []
             for panel in panels]
    return [i for i, own in enumerate(names) if any(own) and names[i + 1:i + 2] != [own]]


def rasterise(screen, depth, triangles, pixels):
    """Face seen at each pixel (-1: none) and its barycentric coordinates there, by a z-buffer."""
    face = np.full((pixels, pixels), -1)
    nearest = np.full((pixels, pixels), -np.inf)
    bary = np.zeros((pixels, pixels, 3))
    for f, corners in enumerate(triangles):
        a, b, c = screen[corners]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-12:
            continue
        x0, y0 = np.maximum(np.floor(np.minimum(np.minimum(a, b), c)), 0).astype(int)
        x1, y1 = np.minimum(np.ceil(np.maximum(np.maximum(a, b), c)) + 1, pixels).astype(int)
        x, y = np.meshgrid(np.arange(x0, x1), np.arange(y0, y1))
        w1 = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        w2 = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        w0 = 1 - w1 - w2
        z = w0 * depth[corners[0]] + w1 * depth[corners[1]] + w2 * depth[corners[2]]
        seen = (w0 >= -1e-9) & (w1 >= -1e-9) & (w2 >= -1e-9) & (z > nearest[y0:y1, x0:x1])
        nearest[y0:y1, x0:x1][seen] = z[seen]
        face[y0:y1, x0:x1][seen] = f
        bary[y0:y1, x0:x1][seen] = np.stack([w0, w1, w2], -1)[seen]
    return face, nearest, bary


def view(panel):
    """Unit vectors of a view: right, up, towards the eye."""
    azimuth, elevation = np.radians(panel["azimuth"]), np.radians(panel["elevation"])
    towards = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    return right, np.cross(towards, right), towards


def draw_surface(axes, panel, load):
    data = load(panel["data"])
    right, up, towards = view(panel)
    points = data["space"] - (data["space"].max(0) + data["space"].min(0)) / 2
    flat = np.stack([points @ right, points @ up], 1)
    pixels = 2 * int(PANEL * DPI * max(1, shape(panel, load)))
    low, size = flat.min(0), np.ptp(flat, axis=0).max()
    offset = (size - np.ptp(flat, axis=0)) / 2
    screen = (flat - low + offset) / size * (pixels - 20) + 10
    depth = points @ towards
    triangles = data["triangles"]
    face, nearest, bary = rasterise(screen, depth, triangles, pixels)
    seen = face >= 0
    picture = np.ones((pixels, pixels, 3))
    corners = triangles[face[seen]]
    if panel["colour"] == "faces":
        colours = np.broadcast_to(CHECKER[1], (len(corners), 3))
    elif panel["colour"] in ("checker", "circles"):
        place = np.einsum("pi,pij->pj", bary[seen], data["plane"][corners])
        square = np.ptp(data["plane"], axis=0).max() / panel["squares"]
        parity = (in_circles(place, square) if panel["colour"] == "circles"
                  else np.floor(place / square + OFFSET).astype(int).sum(1) % 2)
        colours = np.where(parity[:, None] == 1, CHECKER[0], CHECKER[1])
        colours[data["mu"][face[seen]] >= 1] = FLIPPED[:3]
    elif panel["colour"] == "signed":
        values = data["mu"][face[seen]]
        colours = matplotlib.colormaps["coolwarm"](np.clip(0.5 + 0.5 * values / panel["max"], 0, 1))[:, :3]
    else:
        colours = colours_of(data["mu"][face[seen]], 0, panel["max"])[:, :3]
    p = data["space"][triangles]
    normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    light = towards + 0.5 * up - 0.4 * right
    facing = normals @ (light / np.linalg.norm(light))
    # The back, seen through holes, is darker.
    front = normals @ towards > 0
    shade = np.where(front, 0.55 + 0.45 * np.clip(facing, 0, 1), 0.45)
    picture[seen] = colours * shade[face[seen], None]
    edges = []
    if panel["colour"] == "faces":
        edges = sorted({(min(a, b), max(a, b)) for face in data["faces"] for a, b in zip(face, np.roll(face, -1))})
    for chain in panel["highlights"] + [list(edge) for edge in edges]:
        d = depth[chain]
        draw_chain(picture, screen[chain],
                   lambda x, y, i, t: nearest[y, x] <= (1 - t) * d[i] + t * d[i + 1] + 0.02 * size,
                   panel["colour"] == "faces")
    show(axes, picture, seen)


def fixed_palette():
    """Colours of flat pictures: the scale, darker for edges; greys; flipped red and the lines of histograms, fading."""
    scale = matplotlib.colormaps["viridis"]
    colours = [c[:3] for c in scale(np.linspace(0, 1, 96))] + [0.7 * c[:3] for c in scale(np.linspace(0, 1, 48))]
    colours += [(g, g, g) for g in np.linspace(0, 1, 32)]
    lines = [matplotlib.colors.to_rgb(f"C{i}") for i in range(8)]
    for c, steps in [(np.array(FLIPPED[:3]), 8)] + [(np.array(c), 6) for c in lines + list(CHECKER)]:
        colours += [tuple(c + (1 - c) * t) for t in np.linspace(0, 1, steps, endpoint=False)]
    return np.array([[int(round(255 * x)) for x in c] for c in colours[:256]])


def with_palette(image, palette):
    """The image in the nearest colours of the palette. (PIL's own search is not exact and turns white to cream.)"""
    pixels = np.asarray(image).reshape(-1, 3).astype(np.int64)
    colours, index = np.unique(pixels @ [65536, 256, 1], return_inverse=True)
    colours = np.stack([colours >> 16, colours >> 8 & 255, colours & 255], 1)
    nearest = np.concatenate([((part[:, None] - palette[None]) ** 2).sum(2).argmin(1)
                              for part in np.array_split(colours, max(1, len(colours) // 4096))])
    result = Image.fromarray(nearest[index].reshape(image.size[::-1]).astype(np.uint8), "P")
    result.putpalette(palette.astype(np.uint8).ravel().tolist())
    return result


def image_of(figure):
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=DPI)
    plt.close(figure)
    return Image.open(buffer).convert("RGB")


def save(full, path, flat):
    """A palette PNG of at most MOST_BYTES: fewer colours (where they are not fixed), then fewer pixels, until it fits."""
    left, top, right, bottom = ImageChops.difference(full, Image.new("RGB", full.size, "white")).getbbox()
    full = full.crop((max(left - 6, 0), max(top - 6, 0), min(right + 6, full.width), min(bottom + 6, full.height)))
    for scale in (1, 0.85, 0.7, 0.55, 0.4):
        image = full if scale == 1 else full.resize([int(scale * s) for s in full.size], Image.LANCZOS)
        for count in (256,) if flat else (256, 128, 64, 32):
            packed = io.BytesIO()
            if flat:
                reduced = with_palette(image, fixed_palette())
            else:
                reduced = image.quantize(count, dither=Image.Dither.NONE)
            reduced.save(packed, "PNG", optimize=True)
            if packed.tell() <= MOST_BYTES:
                path.write_bytes(packed.getvalue())
                return
    raise SystemExit(f"{path} does not fit into {MOST_BYTES} bytes")


def shape(panel, load):
    """Width over height, limited on both sides."""
    if panel["kind"] == "lines":
        points = np.concatenate([np.array(line) for group in panel["groups"] for line in group["lines"]])
        return float(np.clip(np.divide(*np.ptp(points, axis=0)), 0.4, 2.5))
    if panel["kind"] in ("histogram", "curves"):
        return 1.15 if len(panel["series"]) < 6 else 2.0
    data = load(panel["data"])
    if panel["kind"] == "surface":
        right, up, _ = view(panel)
        points = np.stack([data["space"] @ right, data["space"] @ up], 1)
    else:
        source = panel.get("domain") == "source"
        points = data["space"][:, :2] if source else data["plane"]
    width, height = np.ptp(points, axis=0)
    return float(np.clip(width / height, 0.4, 2.5))


def main():
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    target.mkdir(parents=True, exist_ok=True)
    draw = {"map": draw_map, "grid": draw_grid, "histogram": draw_histogram, "curves": draw_curves, "surface": draw_surface,
            "faces": draw_faces, "lines": draw_lines}
    for picture in json.loads((source / "pictures.json").read_text()):
        panels = picture["panels"]
        if not panels:
            continue
        cache = {}

        def load(name):
            if name not in cache:
                cache[name] = read_ply(source / name)
            return cache[name]

        if [panel["kind"] for panel in panels] == ["svg"]:
            save(read_svg(source / panels[0]["data"]), target / (picture["name"] + ".png"), False)
            print(picture["name"])
            continue
        # One row; each panel as wide as its content asks, all of one height.
        shapes = [shape(panel, load) for panel in panels]
        legends = legends_of(panels)
        beside = LEGEND * len(legends)
        height = min(PANEL, (WIDTH - beside) / sum(shapes))
        maps = [i for i, panel in enumerate(panels) if panel["kind"] == "map"]
        # The bar of colours has a column of its own after the last map.
        bar = maps[-1] + 1 if maps else None
        ratios = shapes if bar is None else shapes[:bar] + [0.05] + shapes[bar:]
        signed = any(panel.get("colour") == "signed" for panel in panels)  # high, with surfaces alone
        figure, grid = plt.subplots(1, len(ratios), figsize=(height * sum(ratios) + 0.5 + beside, height + (0.5 if signed else 0.3)), squeeze=False,
                                    layout="constrained", width_ratios=ratios)
        scale = None
        places = [a for i, a in enumerate(grid.flat) if i != bar]
        for axes, panel in zip(places, panels):
            scale = draw[panel["kind"]](axes, panel, load) or scale
            axes.set_title(panel["title"], fontsize=8)
        for i in legends:
            places[i].legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2,
                             handlelength=1.5)
        if scale:
            colours = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(*scale), "viridis")
            figure.colorbar(colours, cax=grid.flat[bar]).ax.tick_params(labelsize=7)
            grid.flat[bar].set_box_aspect(16)
        flat = all(p["kind"] != "surface" and p.get("pattern") != "doughnut" for p in panels)
        save(image_of(figure), target / (picture["name"] + ".png"), flat)
        print(picture["name"])


if __name__ == "__main__":
    main()
