// Trajectories on the triangles: lines along a field of directions, evenly spaced (Jobard & Lefer 1997).

import { edgeNeighbours, sameVertex, source, triangleCount, triangles } from "./mesh.js";
import { flattened, stretchOf } from "./stretch.js";

const SPACING = 0.085;         // between lines, in half widths of the surface
const LONGEST = 14, MOST_LINES = 260, MOST_TRIES = 6000, MOST_STEPS = 20000;
const FINEST = 0.01;           // length of the pieces that are drawn
const JUMP = 1e-3;             // of a line's image where it is cut open
const HUGGING = 0.02;          // radians by which a line leaves an edge along which the field pushes it
const UNDEFINED_DIRECTION = 0xffff;

/// The field of a map: angles from each triangle's first edge, NaN where there is none. Of φ, where the page brings it,
/// its horizontal trajectories; else the direction in which the map stretches most, where it tells one from the others.
export function fieldOf(map) {
    const { directions, absMu, measured: { surface } } = map;
    return t => {
        if (directions) return directions[t] === UNDEFINED_DIRECTION ? NaN : directions[t] * Math.PI / UNDEFINED_DIRECTION;
        return absMu[t] > 0.02 && absMu[t] < 1 ? stretchOf(surface, t).angle : NaN;
    };
}

/// Points that lines have passed, to keep them apart.
class Passed {
    constructor(cell) { this.cell = cell; this.cells = new Map(); }
    key(i, j, k) { return (i * 4096 + j) * 4096 + k; }
    at(p) { return p.map(x => Math.floor(x / this.cell) + 2048); }
    add(p, line, length) {
        const key = this.key(...this.at(p)), here = this.cells.get(key);
        if (here) here.push({ p, line, length }); else this.cells.set(key, [{ p, line, length }]);
    }
    /// Whether a line has passed within a distance; the same line only if it has come far since.
    near(p, distance, line, length) {
        const [i, j, k] = this.at(p);
        for (let a = i - 1; a <= i + 1; ++a) for (let b = j - 1; b <= j + 1; ++b) for (let c = k - 1; c <= k + 1; ++c)
            for (const other of this.cells.get(this.key(a, b, c)) ?? []) {
                if (other.line === line && Math.abs(length - other.length) < 3 * this.cell) continue;
                if (Math.hypot(p[0] - other.p[0], p[1] - other.p[1], p[2] - other.p[2]) < distance) return true;
            }
        return false;
    }
}

const edgeAngle = ({ length, x, y }, edge) =>
    edge === 0 ? 0 : edge === 1 ? Math.atan2(y, x - length) : Math.atan2(-y, -x);
const pointAt = (points, { t, weights }) => [0, 1, 2].map(i => weights[0] * points[3 * triangles[3 * t] + i] +
    weights[1] * points[3 * triangles[3 * t + 1] + i] + weights[2] * points[3 * triangles[3 * t + 2] + i]);

/// Walks from the middle of a triangle; visit(segment, length) gets the way through every triangle and ends the walk with
/// false.
function walk(neighbours, field, start, heading, visit) {
    let t = start, weights = [1 / 3, 1 / 3, 1 / 3], length = 0;
    for (let step = 0; step < MOST_STEPS; ++step) {
        const shape = flattened(source.points, t), c = Math.sin(heading) / shape.y;
        const b = (Math.cos(heading) - c * shape.x) / shape.length, rates = [-b - c, b, c];
        let exit = -1, way = Infinity;
        for (let i = 0; i < 3; ++i)
            if (rates[i] < -1e-9 && weights[i] / -rates[i] < way) { way = weights[i] / -rates[i]; exit = i; }
        if (exit < 0 || !isFinite(way)) return;
        const from = weights;
        weights = weights.map((w, i) => i === exit ? 0 : Math.max(w + way * rates[i], 0));
        length += way;
        if (!visit({ t, from, to: weights }, length)) return;
        const edge = (exit + 1) % 3, next = neighbours[3 * t + edge];
        if (next < 0) return;
        const vertex = triangles[3 * t + (exit + 2) % 3];  // where the edge begins for the next triangle
        const begin = [0, 1, 2].find(i => sameVertex(triangles[3 * next + i], vertex));
        const after = flattened(source.points, next), turned = edgeAngle(after, begin) + Math.PI;
        const coming = heading - edgeAngle(shape, edge) + turned;
        heading = field(next);
        if (!isFinite(heading)) return;
        if (Math.cos(heading - coming) < 0) heading += Math.PI;
        const inward = Math.sin(heading - edgeAngle(after, begin));
        if (inward < 1e-6) heading = Math.cos(heading - turned) > 0 ? turned - HUGGING : turned + Math.PI + HUGGING;
        const carried = [0, 0, 0];
        carried[begin] = weights[(exit + 2) % 3];
        carried[(begin + 1) % 3] = weights[(exit + 1) % 3];
        t = next;
        weights = carried;
    }
}

/// A line through the middle of a triangle, both ways, as segments in order.
function line(neighbours, field, start, turn, accept) {
    const heading = field(start) + turn;
    if (!isFinite(heading)) return [];
    const halves = [[], []];
    for (const side of [0, 1]) walk(neighbours, t => field(t) + turn, start, heading + side * Math.PI, (segment, length) => {
        halves[side].push(segment);
        return length < LONGEST && accept({ t: segment.t, weights: segment.to }, side ? -length : length);
    });
    return [...halves[1].reverse().map(({ t, from, to }) => ({ t, from: to, to: from })), ...halves[0]];
}

/// Straight pieces of segments, short in the source and in the image: 12 numbers each, both ends there and there. Where
/// the image is cut open a piece ends and another one begins on the other side.
function addPieces(pieces, segments, image) {
    const at = (t, weights) => [pointAt(source.points, { t, weights }), pointAt(image.points, { t, weights })];
    const apart = (p, q) => Math.max(...[0, 1].map(j => Math.hypot(...p[j].map((x, k) => x - q[j][k]))));
    let begin = null, end = null;
    const finish = () => {
        if (begin && apart(begin, end) > 0) pieces.push(...begin[0], ...end[0], ...begin[1], ...end[1]);
        begin = null;
    };
    for (const { t, from, to } of segments) {
        const here = at(t, from), there = at(t, to);
        if (!here.flat().every(isFinite) || !there.flat().every(isFinite)) { finish(); continue; }
        if (begin && apart(end, here) > JUMP) finish();
        begin ??= here;
        end = there;
        if (apart(begin, end) > FINEST) { finish(); begin = end; }
    }
    finish();
}

/// @param turn from the field, in radians: a right angle gives the vertical trajectories, lines of least stretch
/// @return pieces as addPieces makes them
export async function trajectories(map, turn) {
    const neighbours = await edgeNeighbours(), field = fieldOf(map), passed = new Passed(SPACING), pieces = [];
    let seed = 1, lines = 0, begun = performance.now();
    for (let tried = 0; tried < Math.min(MOST_TRIES, 4 * triangleCount) && lines < MOST_LINES; ++tried) {
        if (performance.now() - begun > 12) { await new Promise(resolve => setTimeout(resolve)); begun = performance.now(); }
        seed = (seed * 1103515245 + 12345) % 2147483648;
        const start = Math.floor(seed / 2147483648 * triangleCount);
        const middle = pointAt(source.points, { t: start, weights: [1 / 3, 1 / 3, 1 / 3] });
        if (passed.near(middle, SPACING, lines, 0)) continue;
        const points = [[middle, 0]];
        let checked = [0, 0];
        const found = line(neighbours, field, start, turn, (place, length) => {
            const side = length < 0 ? 1 : 0;
            if (Math.abs(length - checked[side]) < 0.2 * SPACING) return true;
            checked[side] = length;
            const here = pointAt(source.points, place);
            const free = !passed.near(here, 0.5 * SPACING, lines, length) && !comesBack(points, here, length);
            points.push([here, length]);
            return free;
        });
        const lengths = points.map(([, length]) => length), reach = Math.max(...lengths) - Math.min(...lengths);
        if (reach < 2.5 * SPACING) continue;
        for (const [p, length] of points) passed.add(p, lines, length);
        addPieces(pieces, found, map.surface);
        ++lines;
    }
    return new Float32Array(pieces);
}

const comesBack = (points, here, length) => points.some(([p, at]) => Math.abs(length - at) > 3 * SPACING &&
    Math.hypot(p[0] - here[0], p[1] - here[1], p[2] - here[2]) < 0.3 * SPACING);

/// The lines through a triangle: the field's, and the one across it.
export async function linesThrough(map, t) {
    const neighbours = await edgeNeighbours(), field = fieldOf(map);
    return [0, Math.PI / 2].map(turn => {
        const pieces = [], met = [];
        addPieces(pieces, line(neighbours, field, t, turn, (place, length) => {
            const here = pointAt(source.points, place);
            if (Math.abs(length - (met.at(-1)?.[1] ?? 0)) > 0.2 * SPACING) met.push([here, length]);
            return !met.some(([p, at]) => at * length > 0 && Math.abs(length - at) > 2 * SPACING &&
                Math.hypot(p[0] - here[0], p[1] - here[1], p[2] - here[2]) < 0.15 * SPACING);
        }), map.surface);
        return new Float32Array(pieces);
    });
}
