// From which side a surface is seen at first.

export const IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const unit = a => a.map(c => c / Math.hypot(...a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

export function sideSeen({ planar, facing }) {
    if (planar) return IDENTITY;
    const forward = unit(facing || [0.55, -0.75, 0.45]);
    const right = unit(cross(facing && Math.abs(forward[1]) < 0.9 ? [0, 1, 0] : [0, 0, 1], forward));
    return [right, cross(forward, right), forward];
}

/// The rotation that lays a planar image onto the side from which the source is seen, turned to lie as near to it as can be.
export function alignment(source, image) {
    if (!image.planar) return IDENTITY;
    const [right, up] = sideSeen(source), { points: at } = source;
    let real = 0, imaginary = 0;  // of Σ source · conj(image)
    for (let v = 0; v < at.length; v += 3) {
        const x = right[0] * at[v] + right[1] * at[v + 1] + right[2] * at[v + 2], y = up[0] * at[v] + up[1] * at[v + 1] + up[2] * at[v + 2];
        const a = image.points[v], b = image.points[v + 1];
        if (!isFinite(a + b + x + y)) continue;
        real += x * a + y * b;
        imaginary += y * a - x * b;
    }
    const size = Math.hypot(real, imaginary) || 1, c = real / size, s = imaginary / size;
    const first = right.map((r, i) => c * r + s * up[i]), second = right.map((r, i) => c * up[i] - s * r);
    const third = cross(first, second);
    return [0, 1, 2].map(i => [first[i], second[i], third[i]]);
}
