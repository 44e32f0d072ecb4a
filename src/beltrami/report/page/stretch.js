// A map on one triangle: its principal stretches, in frames whose first axis is the triangle's first edge.

import { source, triangles } from "./mesh.js";

/// Vertices of a triangle in its own plane: (0, 0), (length, 0), (x, y); with `frame` also that frame's axes in space.
export function flattened(points, t, frame) {
    const [a, b, c] = [3 * triangles[3 * t], 3 * triangles[3 * t + 1], 3 * triangles[3 * t + 2]];
    const edge = [0, 1, 2].map(i => points[b + i] - points[a + i]), side = [0, 1, 2].map(i => points[c + i] - points[a + i]);
    const length = Math.hypot(...edge), x = (edge[0] * side[0] + edge[1] * side[1] + edge[2] * side[2]) / length;
    const along = edge.map(value => value / length), across = side.map((value, i) => value - x * along[i]);
    const y = Math.hypot(...across);
    if (frame) frame.axes = [along, across.map(value => value / y)];
    return { length, x, y };
}

/// The largest and the least stretch, and the angle of the direction of the largest.
export function stretchOf(image, t) {
    const from = flattened(source.points, t), to = flattened(image.points, t);
    const p = to.length / from.length, q = (to.x - p * from.x) / from.y, r = to.y / from.y;
    const half = 0.5 * (p * p - q * q - r * r), mixed = p * q;
    const largest = Math.sqrt(0.5 * (p * p + q * q + r * r) + Math.hypot(half, mixed));
    return { largest, least: Math.abs(p * r) / largest, angle: 0.5 * Math.atan2(mixed, half) };
}
