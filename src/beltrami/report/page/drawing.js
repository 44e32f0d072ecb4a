// The part of the page that runs beside it, in a worker, so that the page is never held up: reads the mesh, follows lines,
// draws. Where a browser lets no worker draw it runs in the page, in slices, with a port of it.

import { ellipses } from "./ellipses.js";
import { copyOf, handedMesh, maps, readMesh, source } from "./mesh.js";
import {
    cutPieces, draw, has, hide, makeRenderer, makeScene, outlinePieces, showEdges, showEllipses, showLines, showMap, showPicture, showPoints,
} from "./scene.js";
import { alignment } from "./sides.js";
import { state } from "./state.js";
import { linesThrough, trajectories } from "./trajectories.js";

const WHITE = [1, 1, 1], ALONG = [1, 0.62, 0.25], ACROSS = [0.45, 0.85, 1], CUT = [0.95, 0.3, 0.3];

/// 7 numbers each: place on the source, place in the image, order.
function criticalPoints({ critical_points: points = [], surface: image }) {
    const at = (positions, { vertices, weights }) => [0, 1, 2].map(i =>
        vertices.reduce((sum, vertex, j) => sum + (weights[j] && weights[j] * positions[3 * vertex + i]), 0));
    return new Float32Array(points.flatMap(point => [...at(source.points, point), ...at(image.points, point), point.order]));
}

/// Makes what is to be shown and is not there yet.
async function makeLayers(wanted) {
    const { map } = state;
    if (wanted.edges) await showEdges();
    if (wanted.ellipses && !has("ellipses")) showEllipses(ellipses(map));
    if (wanted.points && !has("points")) showPoints(criticalPoints(map));
    for (const [name, asked, turn, colour] of [["across", wanted.across, Math.PI / 2, ACROSS], ["lines", wanted.trajectories, 0, WHITE]])
        if (asked && !has(name)) showLines(name, await trajectories(map, turn), colour, 1.5);
    if (wanted.outline && map.outline.length && !has("outline")) {
        showLines("outline", outlinePieces(map), WHITE, 1.7);
        if (copyOf) showLines("cut", await cutPieces(map), CUT, 1.4);
    }
}

async function pick(triangle) {
    for (const name of ["picked", "pickedAcross"]) hide(name);
    if (triangle < 0) return;
    const [along, across] = await linesThrough(state.map, triangle);
    showLines("pickedAcross", across, ACROSS, 1.7);
    showLines("picked", along, ALONG, 2);
}

let texture;  // an address

/// What the page asks for, one thing after another; each may take a while. `copies` go over to it.
const tasks = {
    begin: makeRenderer,
    /// @param bytes the page's JSON of what it draws
    async read(bytes) {
        const data = JSON.parse(new TextDecoder().decode(bytes));
        await readMesh(data);
        ({ texture } = data);
        return handedMesh();
    },
    async scene() {
        await makeScene();
        if (texture) await showPicture(texture);
    },
    /// @return triangles that have a place in either figure, in the order in which they are drawn, and how the image lies
    async choose(index) {
        const orders = (await showMap(maps[index])).map(order => order.slice());
        return { orders, align: alignment(source, maps[index].surface), copies: orders.map(({ buffer }) => buffer) };
    },
    layers: makeLayers,
    pick,
    draw({ shown, ...figure }) {
        Object.assign(state, shown);
        const begun = performance.now(), picture = draw(figure);
        return { picture, spent: performance.now() - begun, copies: [picture] };
    },
};

const port = globalThis.drawingPort ?? globalThis;
let last = Promise.resolve();

async function answer({ number, name, given }) {
    try {
        const { copies = [], ...result } = await tasks[name](given) ?? {};
        port.postMessage({ number, result }, copies);
    } catch (error) {
        port.postMessage({ number, error: error.message || String(error) });
    }
}

port.onmessage = ({ data }) => {
    if (data.name === "draw") answer(data);  // between the others
    else last = last.then(() => answer(data));
};
