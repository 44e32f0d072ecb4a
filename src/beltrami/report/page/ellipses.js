// The ellipse field: small ellipses on the source that go to circles in the image.

import { source, triangleCount, triangles } from "./mesh.js";
import { flattened, stretchOf } from "./stretch.js";

const RADIUS = 0.032, APART = 0.078;  // in half widths of the surface
const MOST_TRIES = 40000, ROUNDEST = 40;

const middleOf = (points, t) => [0, 1, 2].map(i =>
    (points[3 * triangles[3 * t] + i] + points[3 * triangles[3 * t + 1] + i] + points[3 * triangles[3 * t + 2] + i]) / 3);

/// 18 numbers each: centre and half axes on the source, centre and half axes in the image. In a picture of the source
/// itself they stay ellipses.
export function ellipses({ absMu, surface: image, measured, of_source: whole }) {
    const cells = new Map(), result = [];
    const cellOf = p => p.map(x => Math.floor(x / APART) + 2048), key = (i, j, k) => (i * 4096 + j) * 4096 + k;
    const near = p => {
        const [i, j, k] = cellOf(p);
        for (let a = i - 1; a <= i + 1; ++a) for (let b = j - 1; b <= j + 1; ++b) for (let c = k - 1; c <= k + 1; ++c)
            for (const q of cells.get(key(a, b, c)) ?? [])
                if (Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < APART) return true;
        return false;
    };
    let seed = 7;
    for (let tried = 0; tried < Math.min(MOST_TRIES, 8 * triangleCount); ++tried) {
        seed = (seed * 1103515245 + 12345) % 2147483648;
        const t = Math.floor(seed / 2147483648 * triangleCount), middle = middleOf(source.points, t);
        if (!(absMu[t] < 1) || near(middle)) continue;
        const { largest, least, angle } = stretchOf(measured.surface, t), ratio = Math.sqrt(largest / least), ends = middleOf(image.points, t);
        if (!(ratio < ROUNDEST) || !ends.every(isFinite)) continue;
        const cell = key(...cellOf(middle));
        cells.set(cell, [...(cells.get(cell) ?? []), middle]);
        // In the frames of the two triangles the map is [p q; 0 r]; the axes of the ellipse go to those of the circle.
        const here = {}, there = {}, from = flattened(source.points, t, here), to = flattened(image.points, t, there);
        const p = to.length / from.length, q = (to.x - p * from.x) / from.y, r = to.y / from.y;
        const scale = Math.sqrt(Math.abs(p * r)), size = whole ? 1 : Math.min(Math.max(scale, 0.35), 1.6) / scale;
        const axes = [[Math.cos(angle), Math.sin(angle), RADIUS / ratio], [-Math.sin(angle), Math.cos(angle), RADIUS * ratio]];
        const inSpace = ({ axes: [e, f] }, x, y) => [0, 1, 2].map(i => x * e[i] + y * f[i]);
        result.push(...middle, ...axes.flatMap(([x, y, s]) => inSpace(here, s * x, s * y)),
                    ...ends, ...axes.flatMap(([x, y, s]) => inSpace(there, size * s * (p * x + q * y), size * s * r * y)));
    }
    return new Float32Array(result);
}
