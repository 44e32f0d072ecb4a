// A figure: from which side it is seen, what the hand does to it, and which face is where.

import { ask, pending } from "./beside.js";
import { $, dilatation, show } from "./numbers.js";
import { faces, source, triangles } from "./mesh.js";
import { IDENTITY, sideSeen } from "./sides.js";
import { state } from "./state.js";
import { stretchOf } from "./stretch.js";

const MOST_PIXELS = 1800;
/// Milliseconds that drawing may take, while a figure moves and when it rests; where it takes longer (without a graphics
/// card) fewer pixels are drawn, per pixel of the page not fewer than these, and not more.
const PACE = {
    moving: { budget: 12, least: 0.5, most: () => Math.max(devicePixelRatio || 1, 1), perPixel: 0 },
    still: { budget: 250, least: 1, most: () => Math.max(devicePixelRatio || 1, 2), perPixel: 0 },
};
const REST = 160;        // ms after the last movement until all is drawn
const TAP = 6;           // pixels that a finger may move and still tap

class View {
    constructor(canvas, isImage) {
        this.canvas = canvas;
        this.isImage = isImage;
        this.context = canvas.getContext("bitmaprenderer");
        this.pin = canvas.nextElementSibling;
        this.fingers = new Map();
        this.version = 0;
        this.seen = new Promise(resolve => { this.complete = resolve; });  // all of it, for the first time
        this.reset();
        this.listen();
    }
    get surface() { return this.isImage ? state.map?.surface : source; }
    get blend() { return this.isImage ? 1 : state.blend; }
    get flat() { return this.surface.planar && (this.isImage || state.blend === 0 || state.map.surface.planar); }

    /// After another map has been chosen.
    /// @param order of the triangles that have a place here, as they are drawn
    show(order, align) {
        const { wasPlanar } = this, first = !this.order;
        Object.assign(this, { order, align: this.isImage ? IDENTITY : align, wasPlanar: this.surface.planar });
        ++this.version;
        if (wasPlanar !== this.surface.planar) this.reset();
        if (first) this.schedule();  // something at once
    }
    reset() {
        this.zoom = 1;
        this.panX = this.panY = 0;
        this.axes = sideSeen(this.surface ?? { planar: true });
    }
    turn(dx, dy) {  // radians about the vertical and the horizontal of the screen
        const axes = [...this.axes];
        const rotate = (a, b, angle) => {
            const c = Math.cos(angle), s = Math.sin(angle), p = axes[a], q = axes[b];
            axes[a] = p.map((_, i) => c * p[i] + s * q[i]);
            axes[b] = p.map((_, i) => c * q[i] - s * p[i]);
        };
        rotate(0, 2, dx);
        rotate(1, 2, -dy);
        this.axes = axes;
    }
    /// Half the figure's width in pixels of the page; a surface needs room to turn, an image in the plane has none to lose.
    fit(width, height) { return Math.min(width, height) / (this.flat || this.isImage && this.surface.planar ? 2.12 : 2.5); }

    /// Asks for one picture at a time; for what has moved meanwhile when it has come.
    async render() {
        const box = this.canvas.getBoundingClientRect();
        if (!box.width) this.complete();  // nothing to be seen
        if (!box.width || !this.order) return;
        if (this.drawing) { this.stale = true; return; }
        const { moves } = this, pace = moves ? PACE.moving : PACE.still, { least, most, budget } = pace;
        const affordable = pace.perPixel ? Math.sqrt(budget / pace.perPixel / box.width / box.height) : 1;
        const ratio = Math.min(Math.max(affordable, least), most(), MOST_PIXELS / box.width);
        const width = Math.round(box.width * ratio), height = Math.round(box.height * ratio);
        const size = this.fit(box.width, box.height) * this.zoom, sourceShade = source.planar ? 0 : 1, imageShade = state.map.surface.planar ? 0 : 1;
        const { top, overlay, edges, trajectories, across, ellipses, points, outline, picked } = state;
        this.drawing = true;
        const { picture, spent } = await ask("draw", {
            isImage: this.isImage, axes: this.axes, blend: this.blend, align: this.align, moves, width, height, ratio,
            frame: [2 * size / box.width, 2 * size / box.height, 2 * this.panX * this.fit(box.width, box.height) / box.width,
                    -2 * this.panY * this.fit(box.width, box.height) / box.height],
            shaded: sourceShade * (1 - this.blend) + imageShade * this.blend, flat: this.flat,
            edgePixels: ratio * size * Math.sqrt(6 / this.order.length),
            shown: { top, overlay, edges, trajectories, across, ellipses, points, outline, picked },
        }).finally(() => { this.drawing = false; });
        this.context.transferFromImageBitmap(picture);
        this.placePin();
        this.canvas.dispatchEvent(new Event("drawn"));
        if (!moves) this.complete();
        const first = !pace.perPixel, each = spent / (width * height);
        pace.perPixel = first ? each : 0.6 * pace.perPixel + 0.4 * each;
        if (this.stale) this.soon();
        else if (first && !moves) this.schedule(true);  // at once sharper, where that costs little
        this.stale = false;
    }
    soon() {
        if (this.frame) return;
        pending(1);
        this.frame = requestAnimationFrame(() => { this.frame = 0; this.render().finally(() => pending(-1)); });
    }
    schedule(still = false) {  // quickly at once, all of it when the hand rests
        if (this.timer) { clearTimeout(this.timer); pending(-1); }
        this.timer = 0;
        ++this.version;
        this.moves = !still;
        this.soon();
        if (still) return;
        pending(1);
        this.timer = setTimeout(() => { this.schedule(true); }, REST);
    }

    /// Where vertices are on the page, from the figure's upper left corner, and how near to the reader.
    projector() {
        const { clientWidth: width, clientHeight: height } = this.canvas, radius = this.fit(width, height), size = radius * this.zoom;
        const middle = [width / 2 + this.panX * radius, height / 2 + this.panY * radius, 0];
        const here = source.points, there = state.map.surface.points, { blend, align } = this;
        const rows = this.axes.map((axis, i) => {
            const s = [size, -size, 1][i], back = [0, 1, 2].map(j => axis[0] * align[0][j] + axis[1] * align[1][j] + axis[2] * align[2][j]);
            return [...axis.map(a => s * (1 - blend) * a), ...back.map(a => s * blend * a)];
        });
        return (v, i) => {  // NaN where the image is not defined, if anything is seen of it
            const row = rows[i], p = 3 * v;
            let sum = middle[i];
            if (blend < 1) sum += row[0] * here[p] + row[1] * here[p + 1] + row[2] * here[p + 2];
            if (blend > 0) sum += row[3] * there[p] + row[4] * there[p + 1] + row[5] * there[p + 2];
            return sum;
        };
    }
    /// Of all vertices; kept until the figure moves.
    project() {
        if (this.projected?.version === this.version) return this.projected;
        const count = source.points.length / 3, at = this.projector();
        const [x, y, z] = [0, 1, 2].map(i => Float32Array.from({ length: count }, (_, v) => at(v, i)));
        return this.projected = { version: this.version, x, y, z };
    }
    triangleAt({ clientX, clientY }) {
        if (!this.order) return -1;
        const box = this.canvas.getBoundingClientRect(), px = clientX - box.left, py = clientY - box.top;
        const { x, y, z } = this.project(), { flat } = this;
        let best = -1, nearest = -Infinity;
        for (const t of this.order) {
            const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
            if (!(Math.min(x[a], x[b], x[c]) <= px && px <= Math.max(x[a], x[b], x[c]) &&
                  Math.min(y[a], y[b], y[c]) <= py && py <= Math.max(y[a], y[b], y[c]))) continue;
            const area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]);
            const wb = ((px - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (py - y[a])) / area;
            const wc = ((x[b] - x[a]) * (py - y[a]) - (px - x[a]) * (y[b] - y[a])) / area;
            if (!(wb >= 0 && wc >= 0 && wb + wc <= 1)) continue;
            const depth = flat ? 0 : z[a] + wb * (z[b] - z[a]) + wc * (z[c] - z[a]);
            if (depth >= nearest) { nearest = depth; best = t; }
        }
        return best;
    }
    placePin() {
        const t = this.pinned ?? -1, { clientWidth: width, clientHeight: height } = this.canvas;
        let x = NaN, y = NaN;
        if (t >= 0 && this.order) {
            const at = this.projector(), mean = i => [0, 1, 2].reduce((sum, corner) => sum + at(triangles[3 * t + corner], i), 0) / 3;
            [x, y] = [mean(0) / width, mean(1) / height];
        }
        this.pin.hidden = !(x > 0 && x < 1 && y > 0 && y < 1);
        this.pin.style.left = 100 * x + "%";
        this.pin.style.top = 100 * y + "%";
    }

    move(dx, dy, shift) {  // in half widths of the figure
        if (this.flat || shift || this.isImage && this.surface.planar) { this.panX += dx; this.panY += dy; }
        else this.turn(1.3 * dx, 1.3 * dy);
        this.schedule();
    }
    zoomBy(factor, at) {
        const box = this.canvas.getBoundingClientRect(), radius = this.fit(box.width, box.height);
        const x = at ? (at.clientX - box.left - box.width / 2) / radius : 0;
        const y = at ? (at.clientY - box.top - box.height / 2) / radius : 0;
        const zoom = Math.min(Math.max(this.zoom * factor, 0.3), 200), applied = zoom / this.zoom;
        this.panX = x - (x - this.panX) * applied;
        this.panY = y - (y - this.panY) * applied;
        this.zoom = zoom;
        this.schedule();
    }
    listen() {
        const { canvas, fingers } = this;
        let began = null, travelled = 0;
        const middle = () => {
            const all = [...fingers.values()], mean = of => all.reduce((sum, f) => sum + f[of], 0) / all.length;
            const at = { clientX: mean("clientX"), clientY: mean("clientY") };
            return { ...at, apart: all.length > 1 ? Math.hypot(all[0].clientX - all[1].clientX, all[0].clientY - all[1].clientY) : 0 };
        };
        canvas.onpointerdown = event => {
            if (!fingers.size) { began = event; travelled = 0; }
            fingers.set(event.pointerId, event);
            canvas.setPointerCapture(event.pointerId);
            canvas.classList.add("dragging");
        };
        canvas.onpointerup = event => {
            if (fingers.size === 1 && began && travelled < TAP) pick(this.triangleAt(event));
            release(event);
        };
        const release = event => {
            fingers.delete(event.pointerId);
            if (!fingers.size) canvas.classList.remove("dragging");
        };
        canvas.onpointercancel = release;
        canvas.onpointerleave = () => { if (!fingers.size) hover(-1); };
        canvas.onpointermove = event => {
            if (!fingers.has(event.pointerId)) return hoverSoon(event, this);
            const before = middle();
            fingers.set(event.pointerId, event);
            const now = middle(), radius = this.fit(canvas.clientWidth, canvas.clientHeight);
            travelled += Math.hypot(now.clientX - before.clientX, now.clientY - before.clientY) + Math.abs(now.apart - before.apart);
            if (travelled < TAP && fingers.size === 1) return;
            hover(-1);
            if (before.apart && now.apart) this.zoomBy(now.apart / before.apart, now);
            this.move((now.clientX - before.clientX) / radius, (now.clientY - before.clientY) / radius, event.shiftKey || fingers.size > 1);
        };
        canvas.addEventListener("wheel", event => {
            if (document.activeElement !== canvas && !event.ctrlKey) return;  // else the wheel scrolls the page
            event.preventDefault();
            this.zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), event);
        }, { passive: false });
        canvas.onkeydown = event => {
            const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
            if (arrow) this.move(0.1 * arrow[0], 0.1 * arrow[1], event.shiftKey);
            else if (event.key === "+" || event.key === "=") this.zoomBy(1.2);
            else if (event.key === "-") this.zoomBy(1 / 1.2);
            else if (event.key === "0") { this.reset(); this.schedule(true); }
            else if (event.key === "Enter") {  // the face in the middle
                const box = canvas.getBoundingClientRect();
                pick(this.triangleAt({ clientX: box.left + box.width / 2, clientY: box.top + box.height / 2 }));
            } else if (event.key === "Escape") pick(-1);
            else return;
            event.preventDefault();
        };
    }
}

let soon;
function hoverSoon(event, view) {  // at most once a frame
    if (!soon) requestAnimationFrame(() => { hover(soon.view.triangleAt(soon.event), soon.view); soon = null; });
    soon = { event, view };
}

/// Shows a face's numbers and its place in the other figure; with none those of the face that was picked.
export function hover(t, view) {
    const shown = t >= 0 ? t : state.picked;
    for (const other of views) {
        other.pinned = other === view ? state.picked : shown;
        other.placePin();
    }
    $("readout").textContent = shown < 0 ? "Point at a face to read its values; click to keep it." : numbersOf(shown);
}

function numbersOf(t) {
    const m = state.map.absMu[t], words = [`face ${faces[t]}`, `|μ| ${m === Infinity ? "∞" : show(m)}`];
    if (m > 1) words.push("flipped");
    else if (m !== m) words.push("undefined");
    else {
        const { measured: { surface, scale } } = state.map, { largest, least } = stretchOf(surface, t);
        words.push(`K ${show(dilatation(m))}`, `stretches ${show(scale * least, 3)} … ${show(scale * largest, 3)}`,
                   `area × ${show(scale * scale * least * largest, 3)}`);
    }
    return words.join(" · ");
}

export function pick(t) {
    state.picked = t;
    hover(-1);
    dispatchEvent(new Event("pick"));
}

let views = [];
export function makeViews() { return views = [new View($("source"), false), new View($("image"), true)]; }
export const redraw = () => views.forEach(view => view.schedule(true));
export const nudge = () => views.forEach(view => view.schedule());
