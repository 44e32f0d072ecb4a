// The charts: histogram of |μ|, bounds on K, convergence.

import { viridisAt } from "./colours.js";
import { $, bounds, data, fixed, isNumber, lowerBound, mainMap, percent, roundTicks, show, svgElement, words } from "./numbers.js";
import { state } from "./state.js";

function chart(id, height) {
    const svg = $(id), width = Math.max(svg.clientWidth || svg.parentNode.clientWidth, 280);
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    return { svg, width };
}

export function drawHistogram() {
    const narrow = $("histogram-section").clientWidth < 440, row = narrow ? 92 : 76, left = 4, extra = narrow ? 15 : 0;
    const shown = data.maps.filter(map => !map.of_source), { svg, width } = chart("histogram", shown.length * row + 40);
    const end = data.histogram_end, right = width - 12, at = m => left + (right - left) * m / end;
    shown.forEach((map, i) => {
        const { name } = map, histogram = map.histogram[state.shares];
        const base = (i + 1) * row, peak = Math.max(...histogram.bins, 1e-12), n = histogram.bins.length;
        const group = svgElement(svg, "g", { class: "bins" });
        histogram.bins.forEach((share, j) => {
            if (!share) return;
            const tall = Math.max((row - 28 - extra) * share / peak, 0.7);
            svgElement(group, "rect", { x: at(end * j / n), y: base - tall, width: (right - left) / n, height: tall,
                fill: `rgb(${viridisAt(end * (j + 0.5) / n / state.top)})` });
        });
        svgElement(svg, "line", { class: "axis", x1: left, x2: right, y1: base, y2: base });
        const extras = [`peak ${percent(peak)}`];
        if (histogram.above > 0) extras.push(`${percent(histogram.above)} beyond ${show(end, 3)}`);
        if (histogram.flipped > 0) extras.push(`${percent(histogram.flipped)} flipped`);
        if (histogram.undefined > 0) extras.push(`${percent(histogram.undefined)} undefined`);
        svgElement(svg, "text", { x: left, y: base - row + 18, class: i ? "name" : "strong" }, words(name));
        svgElement(svg, "text", { x: narrow ? left : right, y: base - row + 18 + extra,
            "text-anchor": narrow ? "start" : "end" }, extras.join(" · "));
    });
    const low = shown.length * row;
    for (const [m, text] of roundTicks(0, end, width > 420 ? 6 : 4)) {
        svgElement(svg, "line", { class: "axis", x1: at(m), x2: at(m), y1: low, y2: low + 4 });
        svgElement(svg, "text", { x: at(m), y: low + 18, "text-anchor": m ? "middle" : "start" }, m ? text : "0");
    }
    svgElement(svg, "text", { x: (left + right) / 2, y: low + 36, "text-anchor": "middle" }, "|μ|");
    const of = state.shares === "area" ? "the source's area" : "the faces";
    $("histogram-note").textContent = `Share of ${of} by |μ|` +
        (shown.length > 1 ? "; each row is scaled to its own peak." : ".");
    const shares = shown.map(map => `${map.name}, 99 % of the area below ${show(map.p99)}`);
    svg.setAttribute("aria-label", `Histogram of |μ|, share of ${of}: ` + shares.join("; "));
}

function drawBounds() {
    const { K, K_lower, K_max } = mainMap;
    const rows = bounds.filter(bound => bound.kind !== "attained").map(bound => {  // which the worst face is
        const open = bound.rigorous === false;
        const of = bound.of === "mesh" ? "of this mesh, " : bound.of ? `of ${bound.of}, ` : "";
        return { at: bound.K, open, name: words(bound.kind ?? "bound"), detail: of + (open ? "estimate" : "rigorous") };
    });
    if (isNumber(K_lower) && !lowerBound) rows.push({ at: K_lower, name: "lower bound", detail: "" });
    rows.sort((a, b) => a.at - b.at);
    if (isNumber(K)) rows.push({ at: K, name: "K of this map", detail: "estimate", open: true, strong: true });
    const attained = bounds.some(bound => bound.kind === "attained");
    if (isNumber(K_max)) rows.push({ at: K_max, name: "worst face", detail: attained ? "of K*, rigorous" : "" });
    $("bounds-section").hidden = !rows.length;
    if (!rows.length) return;
    const step = 38, top = 6, foot = 40, { svg, width } = chart("bounds", rows.length * step + top + foot);
    // A far worst face would squash the rest: it is shown as an arrow at the end of the axis.
    const near = rows.filter(r => r.name !== "worst face" || !isNumber(K)).map(r => r.at);
    let low = Math.min(...near), high = Math.max(...near);
    if (isNumber(K_max) && K_max - low <= 5 * Math.max(high - low, 0.01 * low)) high = Math.max(high, K_max);
    const span = Math.max(high - low, 0.01 * low);
    low = Math.max(1, low - 0.12 * span);
    high += 0.12 * span;
    const left = Math.min(190, 0.44 * width), right = width - 62, base = top + rows.length * step;
    const at = x => left + (right - left) * (Math.min(x, high) - low) / (high - low);
    const best = isNumber(K_max) ? K_max : K, known = isNumber(K_lower) && best >= K_lower;  // a map this good exists
    for (const end of known ? [best, Math.max(K ?? best, K_lower)] : []) {
        const wide = Math.max(at(end) - at(K_lower), 1.5);
        svgElement(svg, "rect", { class: "band", x: at(K_lower), y: top, width: wide, height: base - top });
    }
    rows.forEach((r, i) => {
        const y = top + (i + 0.5) * step, far = r.at > high, x = at(r.at);
        svgElement(svg, "line", { class: "rule", x1: left, x2: right, y1: y, y2: y });
        svgElement(svg, "text", { class: r.strong ? "strong" : "name", x: 0, y: r.detail ? y - 2 : y + 4 }, r.name);
        if (r.detail) svgElement(svg, "text", { x: 0, y: y + 13, "font-size": 11 }, r.detail);
        svgElement(svg, far ? "path" : "circle", { class: r.open ? "mark open" : "mark",
            ...(far ? { d: `M${x} ${y - 5}l7 5l-7 5z` } : { cx: x, cy: y, r: 4.5 }) });
        svgElement(svg, "text", { class: r.strong ? "value strong" : "value name", x: x + 12, y: y + 4 }, fixed(r.at));
    });
    svgElement(svg, "line", { class: "axis", x1: left, x2: right, y1: base, y2: base });
    for (const [tick, text] of roundTicks(low, high, width > 520 ? 4 : 3)) {
        svgElement(svg, "line", { class: "axis", x1: at(tick), x2: at(tick), y1: base, y2: base + 4 });
        svgElement(svg, "text", { x: at(tick), y: base + 18, "text-anchor": "middle" }, text);
    }
    svgElement(svg, "text", { x: (left + right) / 2, y: base + 36, "text-anchor": "middle" }, "K");
    const sure = lowerBound?.rigorous === false ? "seems to lie" : "lies", notes = [];
    const end = isNumber(K_max) ? "the worst face" : "K";
    if (known) notes.push(`The least possible K ${sure} in the shaded interval, up to ${end}.`);
    if (rows.some(r => r.open)) notes.push("Filled: rigorous; open: an estimate.");
    if (bounds.some(b => b.of === "K*")) notes.push("K* is the least of all maps, linear on each face or not.");
    $("bounds-note").textContent = notes.join(" ");
    svg.setAttribute("aria-label", "Bounds on K: " + rows.map(r => `${r.name} ${r.detail} ${show(r.at)}`).join("; "));
}

function drawLine(id, values, name, logarithmic, style) {
    const points = values.map((value, i) => [i + 1, logarithmic && value !== null ? Math.log10(value) : value])
        .filter(p => isNumber(p[1]));
    $(id).style.display = points.length ? "" : "none";
    if (!points.length) return;
    const { svg, width } = chart(id, 200), left = 58, right = width - 14, top = 24, base = 164;
    let low = Math.min(...points.map(p => p[1])), high = Math.max(...points.map(p => p[1]));
    const pad = Math.max(0.06 * (high - low), 1e-4 * Math.abs(high)) || 1, counts = !logarithmic && points.every(p => Number.isInteger(p[1]));
    low = logarithmic ? Math.floor(low + 1e-9) : Math.max(low - pad, 0);  // nothing shown here is below 0
    high = logarithmic ? Math.max(Math.ceil(high - 1e-9), low + 1) : high + pad;
    const last = Math.max(values.length, 2), x = i => left + (right - left) * (i - 1) / (last - 1);
    const y = v => base - (base - top) * (v - low) / (high - low);
    for (const [tick, text] of roundTicks(low, high, 4)) {
        if ((logarithmic || counts) && !Number.isInteger(tick)) continue;
        svgElement(svg, "line", { class: "rule", x1: left, x2: right, y1: y(tick), y2: y(tick) });
        const shown = logarithmic ? show(10 ** tick, 1) : counts ? show(tick) : text;
        svgElement(svg, "text", { x: left - 8, y: y(tick) + 4, "text-anchor": "end" }, shown);
    }
    svgElement(svg, "line", { class: "axis", x1: left, x2: right, y1: base, y2: base });
    for (const [tick] of roundTicks(1, last, 6)) {
        if (!Number.isInteger(tick)) continue;
        svgElement(svg, "text", { x: x(tick), y: base + 17, "text-anchor": "middle" }, tick);
    }
    svgElement(svg, "text", { x: (left + right) / 2, y: base + 34, "text-anchor": "middle" }, "iteration");
    svgElement(svg, "text", { class: "name", x: 0, y: 12 }, name);
    const path = points.map(p => `${x(p[0]).toFixed(1)} ${y(p[1]).toFixed(1)}`).join("L");
    svgElement(svg, "path", { class: "line " + style, d: "M" + path });
    for (const p of points.length <= 60 ? points : []) {
        svgElement(svg, "circle", { class: "dot " + style, cx: x(p[0]), cy: y(p[1]), r: 2.6 });
    }
    svg.setAttribute("aria-label",
        `${name} over ${values.length} iterations, from ${show(values[0])} to ${show(values.at(-1))}`);
}

export function drawCharts() {
    const { k, change, largest } = data.history;
    $("history-section").hidden = !k.length && !change.length;
    drawHistogram();
    drawBounds();
    drawLine("history-k", k, "k", false, "");
    drawLine("history-largest", largest.map(m => m > 0 ? Math.min(m, 1) : null), "largest |μ|", false, "");
    drawLine("history-change", change.map(c => c > 0 ? c : null), "change", true, "second");
    drawFlow(data.record.surface_flow);
}

// The steps of a flow along a surface, as the record has them.
function drawFlow(flow) {
    $("flow-section").hidden = !flow;
    if (!flow) return;
    const positive = values => values.map(value => value > 0 ? value : null), history = flow.history;
    drawLine("flow-energy", positive(history.energy), "energy of the step", true, "");
    drawLine("flow-l2", positive(history.l2), "root mean square of |μ_f − μ|", true, "");
    drawLine("flow-squared", positive(history.squared), "Σ A |μ_f − μ|²", true, "");
    drawLine("flow-sup", positive(history.sup), "largest |μ_f − μ|", true, "");
    drawLine("flow-flips", history.flips, "flipped", false, "second");
    drawLine("flow-length", positive(history.length), "part of the step taken", true, "second");
}
