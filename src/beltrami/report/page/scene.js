// What is drawn, on the graphics card: one scene for all figures, drawn from each figure's side in turn.

import {
    BufferAttribute, BufferGeometry, Camera, CanvasTexture, CustomBlending, DataTexture, DoubleSide, GLSL3, InstancedBufferGeometry,
    InstancedInterleavedBuffer, InterleavedBufferAttribute, LinearFilter, LineSegments, Matrix3, Mesh, MirroredRepeatWrapping,
    OneFactor, OneMinusSrcAlphaFactor, RawShaderMaterial, RGBAFormat, Scene, Sphere, Texture, Vector2, Vector3, Vector4, WebGLRenderer,
    LinearSRGBColorSpace,
} from "three";

import { viridisAt } from "./colours.js";
import { copyOf, corners, decode, edgeNeighbours, faces, inSlices, maps, origins, source, triangleCount, triangles } from "./mesh.js";
import * as shaders from "./shaders.js";
import { state } from "./state.js";
import { flattened } from "./stretch.js";

const LIGHT = [-0.35, 0.45, 0.82];
const OVERLAYS = ["none", "checker", "circles", "image"];
/// More triangles than these are not all drawn while a figure moves.
const MOST_MOVING = 20000;

let renderer, scene, camera, shared, parts, buffers;

function material(shader, uniforms, options = {}) {
    return new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: shader.vertex, fragmentShader: shader.fragment,
        side: DoubleSide, uniforms: { ...shared, ...uniforms }, ...options });
}
const over = { transparent: true, depthWrite: false, blending: CustomBlending, blendSrc: OneFactor, blendDst: OneMinusSrcAlphaFactor };

function add(object, order) {
    object.frustumCulled = false;
    object.geometry.boundingSphere = new Sphere();  // or three.js looks for one
    object.renderOrder = order;
    scene.add(object);
    return object;
}

/// A little square, or a strip, for each row of an array.
function instances(array, width, names, square) {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(square, 2));
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    const buffer = new InstancedInterleavedBuffer(array, width);
    names.forEach(([name, size, offset]) => geometry.setAttribute(name, new InterleavedBufferAttribute(buffer, size, offset)));
    geometry.instanceCount = array.length / width;
    return geometry;
}
const SQUARE = new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), STRIP = new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]);
const LINE = [["from", 3, 0], ["to", 3, 3], ["imageFrom", 3, 6], ["imageTo", 3, 9]];
const ELLIPSE = [["centre", 3, 0], ["first", 3, 3], ["second", 3, 6], ["imageCentre", 3, 9], ["imageFirst", 3, 12], ["imageSecond", 3, 15]];
const POINT = [["centre", 3, 0], ["imageCentre", 3, 3], ["order", 1, 6]];

function palette() {
    const bytes = new Uint8Array(4 * 256);
    for (let i = 0; i < 256; ++i) bytes.set([...viridisAt(i / 255), 255], 4 * i);
    const texture = new DataTexture(bytes, 256, 1, RGBAFormat);
    texture.minFilter = texture.magFilter = LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

/// The orders of zeros as they are written into their discs: 2 to 9, then +.
const GLYPHS = "23456789+";
function glyphs() {
    const side = 64, sheet = new OffscreenCanvas(side * GLYPHS.length, side), context = sheet.getContext("2d");
    context.font = `bold ${0.8 * side}px sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    [...GLYPHS].forEach((glyph, i) => context.fillText(glyph, (i + 0.5) * side, 0.54 * side));
    const texture = new CanvasTexture(sheet);
    texture.minFilter = LinearFilter;
    texture.generateMipmaps = false;
    return texture;
}

async function placesOf(points) {  // no card draws what is not a number
    const array = new Float32Array(3 * origins.length);
    await inSlices(origins.length, (first, last) => {
        for (let c = first; c < last; ++c)
            for (let i = 0; i < 3; ++i) array[3 * c + i] = isFinite(points[3 * origins[c] + i]) ? points[3 * origins[c] + i] : 0;
    });
    return array;
}

async function normalsOf({ normals }) {
    const array = new Int8Array(4 * origins.length);
    await inSlices(origins.length, (first, last) => {
        for (let c = first; c < last; ++c)
            for (let i = 0; i < 3; ++i) array[4 * c + i] = normals ? Math.round(127 * normals[3 * origins[c] + i]) : i === 2 ? 127 : 0;
    });
    return array;
}

/// @throw Error where the browser has no WebGL
export function makeRenderer() {
    renderer = new WebGLRenderer({ canvas: new OffscreenCanvas(1, 1), alpha: true, antialias: false, premultipliedAlpha: true });
    renderer.outputColorSpace = LinearSRGBColorSpace;  // colours are written as they are
    renderer.setClearColor(0, 0);
    renderer.setPixelRatio(1);
}

/// The surface, once its mesh has been read.
export async function makeScene() {
    scene = new Scene();
    camera = new Camera();
    shared = { axes: { value: new Matrix3() }, align: { value: new Matrix3() }, frame: { value: new Vector4() },
               blend: { value: 0 }, pixel: { value: new Vector2() } };
    buffers = { index: new BufferAttribute(new Uint32Array(corners), 1) };
    for (const [name, array, size, unit] of [["position", Float32Array, 3], ["image", Float32Array, 3], ["normal", Int8Array, 4, true],
                                             ["imageNormal", Int8Array, 4, true], ["absMu", Float32Array, 1]])
        buffers[name] = new BufferAttribute(new array(size * origins.length), size, unit);
    buffers.position.array.set(await placesOf(source.points));
    buffers.normal.array.set(await normalsOf(source));
    const geometry = new BufferGeometry();
    for (const name of ["position", "image", "normal", "imageNormal", "absMu"]) geometry.setAttribute(name, buffers[name]);
    parts = { surface: add(new Mesh(geometry, material(shaders.surface, {
        palette: { value: palette() }, picture: { value: null }, pictureScale: { value: new Vector2(1, 1) }, top: { value: 1 },
        shaded: { value: 0 }, overlay: { value: 0 }, spherical: { value: false }, textureOnImage: { value: false },
        light: { value: new Vector3() } })), 0) };
}

/// The image's places and values, when another map is chosen; all at once, since pictures are drawn meanwhile.
export async function showMap(map) {
    const image = await placesOf(map.surface.points), normals = await normalsOf(map.surface), indices = await indicesOf(map);
    const values = new Float32Array(origins.length);
    await inSlices(triangleCount, (first, last) => {
        for (let t = first; t < last; ++t) {
            const m = map.absMu[t];
            values[corners[3 * t + 2]] = m !== m ? -1 : m > 1 ? 2 : m;
        }
    });
    state.map = map;
    shownIndices = indices;
    for (const [name, array] of [["image", image], ["imageNormal", normals], ["absMu", values]]) {
        buffers[name].array.set(array);
        buffers[name].needsUpdate = true;
    }
    for (const name of ["lines", "across", "ellipses", "points", "picked", "pickedAcross", "outline", "cut"]) drop(name);
    return indices.map(({ order }) => order);
}

let shownIndices, sourceIndex;
/// Of the source's figure and of the image's.
async function indicesOf(map) { return [sourceIndex ??= await indexOf(source, []), await indexOf(map.surface, map.absMu)]; }

function drop(name) {
    if (!parts[name]) return;
    scene.remove(parts[name]);
    parts[name].geometry.dispose();
    parts[name].material.dispose();
    parts[name] = null;
}

export function showLines(name, array, core, width) {
    drop(name);
    const geometry = instances(array, 12, LINE, STRIP);
    parts[name] = add(new Mesh(geometry, material(shaders.lines, { core: { value: new Vector3(...core) }, halfWidth: { value: 1 } }, over)), 3);
    parts[name].userData.width = width;
}
export function showEllipses(array) {
    drop("ellipses");
    parts.ellipses = add(new Mesh(instances(array, 18, ELLIPSE, SQUARE), material(shaders.ellipses, {}, over)), 2);
}
export function showPoints(array) {
    drop("points");
    parts.points = add(new Mesh(instances(array, 7, POINT, SQUARE), material(shaders.points, { halfWidth: { value: 6 }, glyphs: { value: glyphs() } }, over)), 4);
    parts.points.userData.width = 6.5;
}
export const hide = drop;
export const has = name => Boolean(parts[name]);

/// The mesh's own edges: the diagonal of a quad is none.
export async function showEdges() {
    if (parts.edges) return;
    const neighbours = await edgeNeighbours(), index = [];
    const placed = v => maps.every(({ surface: { points } }) => isFinite(points[3 * v] + points[3 * v + 1] + points[3 * v + 2]));
    await inSlices(triangleCount, (first, last) => {
        for (let e = 3 * first; e < 3 * last; ++e) {
            const next = neighbours[e], t = e / 3 | 0, ends = [triangles[e], triangles[e % 3 === 2 ? e - 2 : e + 1]];
            const cut = copyOf && next >= 0 && !ends.every(v => [0, 1, 2].some(i => triangles[3 * next + i] === v));
            if ((next < 0 || (next > t || cut) && faces[next] !== faces[t]) && ends.every(placed)) index.push(...ends);
        }
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", buffers.position);
    geometry.setAttribute("image", buffers.image);
    geometry.setIndex(new BufferAttribute(new Uint32Array(index), 1));
    parts.edges = add(new LineSegments(geometry, material(shaders.edges, { fade: { value: 1 } }, over)), 1);
}

/// Curves of the image, in its own figure only: pieces as trajectories() makes them.
export function outlinePieces({ outline }) {
    const pieces = [];
    for (const curve of outline) for (let i = 0; i + 3 < curve.length; i += 2) {
        const from = [curve[i], curve[i + 1], 0], to = [curve[i + 2], curve[i + 3], 0];
        pieces.push(...from, ...to, ...from, ...to);
    }
    return new Float32Array(pieces);
}

/// The edges along which the source is cut open.
export async function cutPieces({ surface: image }) {
    const neighbours = await edgeNeighbours(), pieces = [];
    const at = (points, v) => [points[3 * v], points[3 * v + 1], points[3 * v + 2]];
    await inSlices(triangleCount, (first, last) => {
        for (let e = 3 * first; e < 3 * last; ++e) {
            const next = neighbours[e], ends = [triangles[e], triangles[e % 3 === 2 ? e - 2 : e + 1]];
            if (next < 0 || ends.every(v => [0, 1, 2].some(i => triangles[3 * next + i] === v))) continue;
            pieces.push(...ends.flatMap(v => at(source.points, v)), ...ends.flatMap(v => at(image.points, v)));
        }
    });
    return new Float32Array(pieces);
}

/// @param address of an image, as data:
export async function showPicture(address) {
    const [head, text] = address.split(","), bytes = await decode(text, Uint8Array);
    const image = await createImageBitmap(new Blob([bytes], { type: head.slice(5).split(";")[0] }), { imageOrientation: "flipY" });
    const texture = new Texture(image);
    texture.flipY = false;  // of a bitmap no card turns it
    texture.wrapS = texture.wrapT = MirroredRepeatWrapping;
    texture.anisotropy = renderer.capabilities.getMaxAnisotropy();
    texture.needsUpdate = true;
    const { uniforms } = parts.surface.material, longest = image.width / image.height;
    uniforms.picture.value = texture;
    uniforms.pictureScale.value.set(longest > 1 ? 1 / longest : 1, longest < 1 ? longest : 1);
}

/// Indices of corners for a figure: triangles that have a place there, flipped ones last (in the plane these then lie on
/// top); a second, shorter list of triangles between cells of a grid, while the figure moves.
async function indexOf({ points }, absMu) {
    const plain = [], flipped = [];
    await inSlices(triangleCount, (first, last) => {
        for (let t = first; t < last; ++t) {
            let sum = 0;
            for (let i = 0; i < 3; ++i) {
                const v = 3 * triangles[3 * t + i];
                sum += points[v] + points[v + 1] + points[v + 2];
            }
            if (isFinite(sum)) (absMu[t] > 1 ? flipped : plain).push(t);
        }
    });
    const order = Uint32Array.from(plain.concat(flipped)), full = new Uint32Array(3 * order.length);
    await inSlices(order.length, (first, last) => {
        for (let i = first; i < last; ++i) for (let j = 0; j < 3; ++j) full[3 * i + j] = corners[3 * order[i] + j];
    });
    return { order, full: new BufferAttribute(full, 1), moving: order.length > MOST_MOVING ? await coarser(points, order) : null };
}

/// About two triangles a cell of a grid that the surface meets.
async function coarser(points, order) {
    let area = 0, kept;
    await inSlices(order.length, (first, last) => {
        for (let i = first; i < last; ++i) {
            const { length, y } = flattened(points, order[i]);
            area += 0.5 * length * y || 0;
        }
    });
    let cells = Math.sqrt(2 * MOST_MOVING / Math.max(area, 1e-6));
    do {
        const cellOf = new Map(), cell = new Uint32Array(origins.length), first = [];  // a corner of each cell stands for all
        await inSlices(origins.length, (from, to) => {
            for (let c = from; c < to; ++c) {
                let key = 0;
                for (let i = 0; i < 3; ++i) key = key * 4096 + Math.floor((points[3 * origins[c] + i] + 1) * cells / 2 || 0);
                if (!cellOf.has(key)) { cellOf.set(key, first.length); first.push(c); }
                cell[c] = cellOf.get(key);
            }
        });
        const seen = new Set(), count = first.length;
        kept = [];
        await inSlices(order.length, (from, to) => {
            for (let i = from; i < to; ++i) {
                const own = [0, 1, 2].map(j => cell[corners[3 * order[i] + j]]), [a, b, c] = [...own].sort((p, q) => p - q);
                if (a === b || b === c || seen.has((a * count + b) * count + c)) continue;
                seen.add((a * count + b) * count + c);
                kept.push(...own.map(index => first[index]));
            }
        });
        cells *= 0.85;
    } while (kept.length > 3 * MOST_MOVING);
    return new BufferAttribute(new Uint32Array(kept), 1);
}

/// A picture of what a figure shows.
/// @param figure axes, scale and shift in pixels, blend, align, size, whether it moves, whether it is the image's
export function draw({ isImage, axes, frame, blend, align, moves, width, height, ratio, shaded, edgePixels, flat }) {
    const { domElement: sheet } = renderer, index = shownIndices[isImage ? 1 : 0];
    if (sheet.width !== width || sheet.height !== height) renderer.setSize(width, height, false);
    shared.axes.value.set(...axes.flat());
    shared.align.value.set(...align.flat());
    shared.frame.value.set(...frame);
    shared.blend.value = blend;
    shared.pixel.value.set(2 / width, 2 / height);
    const { surface, edges } = parts, { uniforms } = surface.material;
    surface.geometry.setIndex(moves && index.moving || index.full);
    uniforms.top.value = state.top;
    uniforms.shaded.value = shaded;
    uniforms.overlay.value = OVERLAYS.indexOf(state.overlay);
    uniforms.textureOnImage.value = state.map.surface.planar || !source.planar;
    uniforms.spherical.value = !state.map.surface.planar && !source.planar;
    uniforms.light.value.set(...[0, 1, 2].map(i => LIGHT[0] * axes[0][i] + LIGHT[1] * axes[1][i] + LIGHT[2] * axes[2][i]));
    surface.material.depthTest = !flat;
    if (edges) {
        edges.visible = state.edges && !(moves && index.moving);
        edges.material.uniforms.fade.value = 0.75 * Math.min(Math.max((edgePixels / ratio - 3) / 12, 0.16), 1);
    }
    for (const [name, wanted] of [["lines", state.trajectories], ["across", state.across], ["outline", state.outline && isImage],
                                  ["cut", state.outline && !isImage], ["ellipses", state.ellipses], ["points", state.points],
                                  ["picked", state.picked >= 0], ["pickedAcross", state.picked >= 0]]) {
        const part = parts[name];
        if (!part) continue;
        part.visible = wanted;
        if (part.userData.width) part.material.uniforms.halfWidth.value = part.userData.width * ratio;
        part.material.depthTest = !flat;
    }
    renderer.render(scene, camera);
    return sheet.transferToImageBitmap();
}
