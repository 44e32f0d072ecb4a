// The mesh as the page brings it: triangles, the surface and its images. It is read beside the page and handed to it.
// Everything that takes longer than a moment is done in slices, between which whoever waits is answered.

const PIECE = 1000, SLICE = 8;  // of a loop, between looks at the clock; ms
let resumed = 0;

export async function pause() {
    await new Promise(resolve => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => { port1.close(); resolve(); };
        port2.postMessage(0);
    });
    resumed = performance.now();
}

/// body(first, last) for pieces of 0…count.
export async function inSlices(count, body) {
    for (let first = 0; first < count; first += PIECE) {
        body(first, Math.min(first + PIECE, count));
        if (performance.now() - resumed > SLICE) await pause();
    }
}

export let triangles, triangleCount, faces;  // three vertices a triangle; the face of the mesh behind each
export let corners, origins;  // three *corners* a triangle; the vertex of each corner
export let source, maps;
export let copyOf = null;  // of a surface that is cut open: the vertex that each vertex is a copy of

/// Whether two vertices are one on the surface.
export const sameVertex = (a, b) => copyOf ? copyOf[a] === copyOf[b] : a === b;

export async function decode(base64, Type) {
    const bytes = Uint8Array.fromBase64 ? Uint8Array.fromBase64(base64) : new Uint8Array(3 * base64.length / 4
        - (base64.endsWith("==") ? 2 : base64.endsWith("=") ? 1 : 0));
    if (!Uint8Array.fromBase64) await inSlices(bytes.length / 3, (first, last) => {
        const text = atob(base64.slice(4 * first, 4 * last));
        for (let i = 0; i < text.length; ++i) bytes[3 * first + i] = text.charCodeAt(i);
    });
    await pause();
    return new Type(bytes.buffer);
}

/// Three coordinates a vertex and, unless it is planar, normals. A surface that does not close faces where its normals do.
async function surface({ dimension, coordinates }) {
    const flat = await decode(coordinates, Float32Array), count = flat.length / dimension;
    if (dimension === 2) {
        const points = new Float32Array(3 * count);
        for (let v = 0; v < count; ++v) { points[3 * v] = flat[2 * v]; points[3 * v + 1] = flat[2 * v + 1]; }
        return { planar: true, points, normals: null, facing: null };
    }
    const normals = new Float32Array(3 * count), mean = [0, 0, 0];
    let area = 0;
    await inSlices(triangleCount, (first, last) => {
        for (let t = 3 * first; t < 3 * last; t += 3) {
            const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
            const ux = flat[b] - flat[a], uy = flat[b + 1] - flat[a + 1], uz = flat[b + 2] - flat[a + 2];
            const vx = flat[c] - flat[a], vy = flat[c + 1] - flat[a + 1], vz = flat[c + 2] - flat[a + 2];
            const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
            if (!isFinite(x + y + z)) continue;
            for (const corner of [a, b, c]) {
                const v = copyOf ? 3 * copyOf[corner / 3] : corner;
                normals[v] += x; normals[v + 1] += y; normals[v + 2] += z;
            }
            mean[0] += x; mean[1] += y; mean[2] += z;
            area += Math.hypot(x, y, z);
        }
    });
    await inSlices(count, (first, last) => {
        for (let v = 3 * first; v < 3 * last; v += 3) {
            const own = copyOf ? 3 * copyOf[v / 3] : v;  // not after v
            const length = own < v ? 1 : Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
            for (let i = 0; i < 3; ++i) normals[v + i] = normals[own + i] / length;
        }
    });
    return { planar: false, points: flat, normals, facing: Math.hypot(...mean) > 0.2 * area ? mean : null };
}

/// Every triangle's last corner becomes one of its own, which carries its values to the graphics card; where a vertex
/// has more triangles than corners it is there again.
async function makeCorners() {
    const vertexCount = source.points.length / 3, taken = new Uint8Array(vertexCount), added = [];
    corners = new Uint32Array(triangles.length);
    await inSlices(triangleCount, (first, last) => {
        for (let t = 3 * first; t < 3 * last; t += 3) {
            let own = 2;
            while (own >= 0 && taken[triangles[t + own]]) --own;
            const vertex = triangles[t + (own < 0 ? 2 : own)], after = own < 0 ? 0 : (own + 1) % 3;
            corners[t] = triangles[t + after];
            corners[t + 1] = triangles[t + (after + 1) % 3];
            corners[t + 2] = own < 0 ? vertexCount + added.push(vertex) - 1 : vertex;
            taken[vertex] = 1;
        }
    });
    origins = new Uint32Array(vertexCount + added.length);
    for (let v = 0; v < vertexCount; ++v) origins[v] = v;
    origins.set(added, vertexCount);
}

/// @param data what the page draws: triangles, face, joined, source and maps
export async function readMesh(data) {
    triangles = await decode(data.triangles, Uint32Array);
    triangleCount = triangles.length / 3;
    faces = data.face ? await decode(data.face, Uint32Array) : Uint32Array.from({ length: triangleCount }, (_, t) => t);
    copyOf = data.joined ? await decode(data.joined, Uint32Array) : null;
    source = await surface(data.source);
    await makeCorners();
    maps = [];
    for (const { coordinates, abs_mu, directions: angles, outline, ...map } of data.maps) {
        if (map.of_source) {  // all but its place is that of the first map
            maps.push({ ...maps[0], ...map, surface: await surface({ ...map, coordinates }), measured: maps[0], outline: await curves(outline) });
            continue;
        }
        maps.push({ ...map, absMu: await decode(abs_mu, Float32Array), directions: angles && await decode(angles, Uint16Array),
                    surface: await surface({ ...map, coordinates }), scale: map.radius / data.source.radius, outline: await curves(outline) });
        maps.at(-1).measured = maps.at(-1);
    }
}

const curves = (outline = []) => Promise.all(outline.map(curve => decode(curve, Float32Array)));

/// What the page itself needs of it, in copies that go over to it.
export function handedMesh() {
    const copies = [], copy = array => {
        if (!array) return null;
        copies.push(array.slice());
        return copies.at(-1);
    };
    const without = ({ normals, points, ...surface }) => ({ ...surface, points: copy(points) });
    const mesh = { triangles: copy(triangles), faces: copy(faces), copyOf: copy(copyOf), source: without(source),
        maps: maps.map(({ surface: s, absMu, directions, critical_points, scale, outline, measured }) => ({ surface: without(s), absMu: copy(absMu),
            directions: Boolean(directions), critical_points, scale, outline, measured: maps.indexOf(measured) })) };
    return { mesh, copies: copies.map(({ buffer }) => buffer) };
}

/// @param numbers what the page knows of the maps
export function takeMesh(mesh, numbers) {
    ({ triangles, faces, copyOf, source } = mesh);
    triangleCount = triangles.length / 3;
    maps = mesh.maps.map((map, i) => ({ ...numbers[map.measured], ...numbers[i], ...map }));
    for (const map of maps) map.measured = maps[map.measured];
}

let neighbours;

/// The triangle across each edge: three a triangle, −1 at the boundary; that of edge i runs from vertex i to the next.
export async function edgeNeighbours() {
    if (neighbours) return neighbours;
    const vertexCount = source.points.length / 3, first = new Uint32Array(vertexCount + 1);
    const vertexAt = e => copyOf ? copyOf[triangles[e]] : triangles[e];
    for (let e = 0; e < triangles.length; ++e) ++first[vertexAt(e) + 1];
    for (let v = 0; v < vertexCount; ++v) first[v + 1] += first[v];
    const edges = new Uint32Array(triangles.length), next = first.slice();  // those that leave each vertex
    for (let e = 0; e < triangles.length; ++e) edges[next[vertexAt(e)]++] = e;
    const end = e => vertexAt(e % 3 === 2 ? e - 2 : e + 1), found = new Int32Array(triangles.length).fill(-1);
    await inSlices(triangles.length, (from, to) => {
        for (let e = from; e < to; ++e) {
            const a = vertexAt(e), b = end(e);
            for (let i = first[b]; i < first[b + 1]; ++i) if (end(edges[i]) === a) { found[e] = edges[i] / 3 | 0; break; }
        }
    });
    return neighbours = found;
}
