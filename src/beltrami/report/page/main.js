// The controls, and what happens when the page opens.

import "./page.css";
import { ask, beginDrawing, readMesh } from "./beside.js";
import { drawCharts, drawHistogram } from "./charts.js";
import { viridisAt } from "./colours.js";
import { copyOf, maps, source, takeMesh, triangleCount } from "./mesh.js";
import {
    $, count, data, dilatation, element, isNumber, percent, record, show, words, writeComparison, writeNumbers, writeRecord,
    writeSentence,
} from "./numbers.js";
import { state } from "./state.js";
import { hover, makeViews, nudge, pick, redraw } from "./view.js";

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
    const { orders, align } = await ask("choose", index);
    if (state.map !== map) return;
    views.forEach((view, i) => view.show(orders[i], align));
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

async function refreshLayers() {
    const { edges, ellipses, points, trajectories, across, outline } = state;
    if (trajectories || across) busy("Drawing lines …");
    await ask("layers", { edges, ellipses, points, trajectories, across, outline });
    busy("");
    redraw();
}

async function showPicked() {
    await ask("pick", state.picked);
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
    let shownWidth = document.body.clientWidth;
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
    $("picture-choice").hidden = !data.texture;
}

async function drawFigures() {
    views = makeViews();
    await chooseMap(0);
    connect();
    await Promise.all(views.map(view => view.seen));
}

/// Texts first, then figures as soon as the mesh has been read beside the page.
async function start() {
    writeTexts();
    busy("Reading the mesh …");
    const draws = await beginDrawing();
    takeMesh((await readMesh()).mesh, data.maps);
    state.map = maps[0];
    const planar = source.planar || state.map.surface.planar;
    chooseOverlay(data.texture ? "image" : planar ? "circles" : "none");
    state.edges = !planar && triangleCount <= 2500;
    state.points = Boolean(state.map.critical_points?.length);
    setTop(bestTop(maps));
    drawCharts();
    if (data.coarsened) $("drawing-note").textContent = `The mesh has ${show(data.faces)} faces; the figures show a coarser
        mesh of ${show(triangleCount)} triangles. All numbers and the histogram come from the full mesh.`;
    if (draws) {
        await ask("scene");
        await drawFigures();
    } else {
        $("drawing-note").textContent = "This browser draws no WebGL: the figures are left out, all numbers are there.";
        document.querySelector(".figures").hidden = true;
        await chooseMap(0);
    }
    busy("");
    document.documentElement.dataset.ready = "ok";
}

start();
