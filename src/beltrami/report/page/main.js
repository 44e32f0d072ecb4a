// The controls, and what happens when the page opens.

import "./page.css";
import { drawCharts, drawHistogram } from "./charts.js";
import { viridisAt } from "./colours.js";
import { ellipses } from "./ellipses.js";
import { copyOf, maps, readMesh, source, triangleCount } from "./mesh.js";
import {
    $, count, data, dilatation, element, isNumber, percent, record, show, words, writeComparison, writeNumbers, writeRecord,
    writeSentence,
} from "./numbers.js";
import {
    cutPieces, has, hide, makeScene, outlinePieces, showEdges, showEllipses, showLines, showMap, showPicture, showPoints,
} from "./scene.js";
import { state } from "./state.js";
import { linesThrough, trajectories } from "./trajectories.js";
import { hover, makeViews, nudge, pick, redraw } from "./view.js";

const WHITE = [1, 1, 1], ALONG = [1, 0.62, 0.25], ACROSS = [0.45, 0.85, 1], CUT = [0.95, 0.3, 0.3];
const busy = text => { $("busy").textContent = text; };
let views;

async function chooseMap(index) {
    const map = maps[index];
    state.map = map;
    state.picked = -1;
    const { source: origin = {} } = record, facts = [], { histogram: { area: histogram }, surface: { planar } } = map;
    if (isNumber(origin.vertices)) facts.push(count(origin.vertices, "vertex", "vertices"));
    facts.push(count(data.faces, "face"));
    if (origin.components > 1) facts.push(count(origin.components, "component"));
    if (isNumber(origin.genus)) facts.push(`genus ${origin.genus}`);
    if (origin.boundary_loops) facts.push(count(origin.boundary_loops.length, "boundary loop"));
    $("source-caption").replaceChildren(element("b", { textContent: "Source" }), " — " + facts.join(", "));
    $("image-caption").replaceChildren(element("b", { textContent: map.of_source ? "The source, cut open" : imageInWords(map) }),
        " — " + placeInWords(map) +
        (histogram.flipped ? `, ${percent(histogram.flipped)} of the area flipped` : ""));
    $("source").setAttribute("aria-label", `Source surface, coloured by |μ| of the ${words(map.name)} map`);
    $("image").setAttribute("aria-label", map.of_source ? `The source cut open, with a ${words(map.name)}, coloured by |μ|`
                                                        : `Image under the ${words(map.name)} map, coloured by |μ|`);
    // Round circles lie in a plane; of surfaces in space the ellipses say the same.
    allow("input[value=circles]", planar || source.planar);
    if (state.overlay === "circles" && !planar && !source.planar) chooseOverlay("none");
    $("trajectories-name").textContent = map.directions ? "horizontal trajectories of φ" : "lines of largest stretch";
    $("across-name").textContent = map.directions ? "vertical ones" : "of least stretch";
    const points = map.critical_points ?? [];
    $("points-name").textContent = pointsInWords(points);
    allow("#points", points.length > 0);
    $("outline-choice").hidden = !map.outline.length;
    $("outline-name").textContent = copyOf ? "polygon and cut" : "outline";
    updateLegend();
    hover(-1);
    if (!views) return;
    showMap(map);
    for (const view of views) await view.show();
    await refreshLayers();
}

/// Zeros are counted as often as their order says.
function pointsInWords(points) {
    if (!points.length) return "zeros and poles";
    const some = (wanted, word) => {
        const orders = points.map(({ order }) => order).filter(wanted), sum = Math.abs(orders.reduce((a, b) => a + b, 0));
        return count(orders.length, word) + (sum > orders.length ? ` (${sum} by order)` : "");
    };
    return `${some(order => order > 0, "zero")}, ${some(order => order < 0, "pole")}`;
}

const imageInWords = ({ name }) => ["after", "before"].includes(name) ? `The mesh ${name}` : `Image, ${words(name)} map`;

/// Where the image lies.
function placeInWords({ surface: { planar }, outline }) {
    if (copyOf && outline.length) return outline.length > 1 ? "in the hyperbolic plane, a disk" : "in the plane, over a parallelogram";
    return planar ? "in the plane" : "in space";
}

function allow(selector, allowed) {
    const input = document.querySelector(selector);
    input.disabled = !allowed;
    input.parentNode.classList.toggle("off", !allowed);
}

function chooseOverlay(name) {
    state.overlay = name;
    for (const input of document.querySelectorAll("input[name=overlay]")) input.checked = input.value === name;
}

/// Makes what is to be shown and is not there yet.
async function refreshLayers() {
    const { map } = state;
    if (state.edges) await showEdges();
    if (state.ellipses && !has("ellipses")) showEllipses(ellipses(map));
    if (state.points && !has("points")) showPoints(criticalPoints(map));
    for (const [name, wanted, turn, colour] of [["across", state.across, Math.PI / 2, ACROSS], ["lines", state.trajectories, 0, WHITE]]) {
        if (!wanted || has(name)) continue;
        busy("Drawing lines …");
        const pieces = await trajectories(map, turn);
        if (state.map === map) showLines(name, pieces, colour, 1.5);
        busy("");
    }
    if (state.outline && map.outline.length && !has("outline")) {
        showLines("outline", outlinePieces(map), WHITE, 1.7);
        if (copyOf) {
            const pieces = await cutPieces(map);
            if (state.map === map) showLines("cut", pieces, CUT, 1.4);
        }
    }
    redraw();
}

/// 7 numbers each: place on the source, place in the image, order.
function criticalPoints({ critical_points: points = [], surface: image }) {
    const at = (positions, { vertices, weights }) => [0, 1, 2].map(i =>
        vertices.reduce((sum, vertex, j) => sum + (weights[j] && weights[j] * positions[3 * vertex + i]), 0));
    return new Float32Array(points.flatMap(point => [...at(source.points, point), ...at(image.points, point), point.order]));
}

async function showPicked() {
    const { map, picked } = state;
    for (const name of ["picked", "pickedAcross"]) hide(name);
    if (picked >= 0) {
        const [along, across] = await linesThrough(map, picked);
        if (state.picked !== picked || state.map !== map) return;
        showLines("pickedAcross", across, ACROSS, 1.7);
        showLines("picked", along, ALONG, 2);
    }
    redraw();
}

function setTop(top) {
    state.top = Math.min(Math.max(top, 0.001), 1);
    $("range").value = Math.log10(state.top);
    $("range-value").textContent = show(state.top, 2);
    $("range").setAttribute("aria-valuetext", show(state.top, 2));
    updateLegend();
    drawHistogram();
}

function updateLegend() {
    const { top } = state, css = [];
    for (let i = 0; i <= 15; ++i) css.push(`rgb(${viridisAt(i / 15)})`);
    $("bar").style.background = `linear-gradient(to right, ${css})`;
    const ticks = [0, 0.25, 0.5, 0.75, 1].map(s => s * top);
    $("ticks").replaceChildren(...ticks.map((m, i) => {
        const k = (i === 0 ? "|μ| = " : i === 4 && top < 1 ? "≥ " : "") + show(m, 3);
        const K = (i === 0 ? "K = " : i === 4 && top < 1 ? "≥ " : "") + (m < 1 ? show(dilatation(m), 3) : "∞");
        const tick = element("span", {}, k, element("br"), K);
        tick.style.left = 25 * i + "%";
        return tick;
    }));
    const swatch = (variable, text) => {
        const box = element("i", { className: "swatch" });
        box.style.background = `var(${variable})`;
        const part = element("span", {}, box, text);
        part.style.marginRight = "18px";
        return part;
    };
    const { flipped, undefined: none } = state.map.histogram.area;
    $("swatches").replaceChildren(...(flipped ? [swatch("--flip", `flipped (${percent(flipped)} of the area)`)] : []),
                                  ...(none ? [swatch("--void", `undefined (${percent(none)} of the area)`)] : []));
}

function bestTop(chosen) {  // a round number; others may exceed the main map, but must not hide it
    const top = 1.1 * Math.min(Math.max(...chosen.map(map => map.p99)), 1.6 * chosen[0].p99) || 0.01;
    const power = 10 ** Math.floor(Math.log10(top));
    return Math.min(1, power * [1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9, 10].find(digit => digit * power >= top * 0.999));
}

function setBlend(blend) {
    state.blend = blend;
    $("blend").value = blend;
    $("blend").setAttribute("aria-valuetext", blend === 0 ? "source" : blend === 1 ? "image" : percent(blend));
}

function connect() {
    maps.forEach((map, i) => $("map").append(element("option", { value: i, textContent: words(map.name) })));
    $("map-choice").hidden = maps.length < 2;
    $("map").onchange = () => chooseMap(+$("map").value);
    for (const input of document.querySelectorAll("input[name=overlay]"))
        input.onchange = () => { state.overlay = input.value; redraw(); };
    for (const layer of ["edges", "trajectories", "across", "ellipses", "points", "outline"]) {
        $(layer).checked = state[layer];
        $(layer).onchange = () => { state[layer] = $(layer).checked; refreshLayers(); };
    }
    for (const input of document.querySelectorAll("input[name=shares]")) {
        input.checked = input.value === state.shares;
        input.onchange = () => { state.shares = input.value; drawHistogram(); };
    }
    $("range").oninput = () => { setTop(10 ** +$("range").value); nudge(); };
    $("blend").oninput = () => { setBlend(+$("blend").value); views[0].schedule(); };
    $("fit").onclick = () => { setTop(bestTop([state.map])); redraw(); };
    $("reset").onclick = () => { setBlend(0); pick(-1); views.forEach(view => view.reset()); redraw(); };
    addEventListener("pick", showPicked);
    let shownWidth = 0;
    new ResizeObserver(() => {
        if (document.body.clientWidth === shownWidth) return;
        shownWidth = document.body.clientWidth;
        drawCharts();
        redraw();
    }).observe(document.body);
}

function writeTexts() {
    writeSentence();
    writeNumbers();
    writeComparison();
    writeRecord();
    if (data.coarsened) $("drawing-note").textContent = `The mesh has ${show(data.faces)} faces; the figures show a coarser
        mesh of ${show(triangleCount)} triangles. All numbers and the histogram come from the full mesh.`;
    $("picture-choice").hidden = !data.texture;
}

async function drawFigures() {
    try {
        makeScene();
    } catch {
        $("drawing-note").textContent = "This browser draws no WebGL: the figures are left out, all numbers are there.";
        document.querySelector(".figures").hidden = true;
        return;
    }
    views = makeViews();
    if (data.texture) await showPicture(data.texture);
    await chooseMap(0);
}

async function start() {
    busy("Reading the mesh …");
    await readMesh();
    writeTexts();
    state.map = maps[0];
    const planar = source.planar || state.map.surface.planar;
    chooseOverlay(data.texture ? "image" : planar ? "circles" : "none");
    state.edges = !planar && triangleCount <= 2500;
    state.points = Boolean(state.map.critical_points?.length);
    setTop(bestTop(maps));
    drawCharts();
    await drawFigures();
    if (views) connect(); else await chooseMap(0);
    busy("");
    document.documentElement.dataset.ready = "ok";
}

start();
