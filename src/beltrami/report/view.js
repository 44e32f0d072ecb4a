// The mesh, its colours, and a software rasteriser that draws it: no graphics hardware is needed.

function decode(base64, Type) {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return new Type(bytes.buffer);
}

const triangles = decode(data.triangles, Uint32Array), triangleCount = triangles.length / 3;
const faces = data.face ? decode(data.face, Uint32Array) : Uint32Array.from({ length: triangleCount }, (_, t) => t);

function surface({ dimension, coordinates }) {  // → 3 coordinates a vertex, normals if it is not planar
    const flat = decode(coordinates, Float32Array), n = flat.length / dimension;
    if (dimension === 2) {
        const points = new Float32Array(3 * n);
        for (let v = 0; v < n; ++v) { points[3 * v] = flat[2 * v]; points[3 * v + 1] = flat[2 * v + 1]; }
        return { planar: true, points };
    }
    const normals = new Float32Array(3 * n), mean = [0, 0, 0];
    let area = 0;
    for (let t = 0; t < 3 * triangleCount; t += 3) {
        const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
        const ux = flat[b] - flat[a], uy = flat[b + 1] - flat[a + 1], uz = flat[b + 2] - flat[a + 2];
        const vx = flat[c] - flat[a], vy = flat[c + 1] - flat[a + 1], vz = flat[c + 2] - flat[a + 2];
        const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        if (!isFinite(x + y + z)) continue;
        for (const v of [a, b, c]) { normals[v] += x; normals[v + 1] += y; normals[v + 2] += z; }
        mean[0] += x; mean[1] += y; mean[2] += z;
        area += Math.hypot(x, y, z);
    }
    for (let v = 0; v < 3 * n; v += 3) {
        const length = Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
        for (let i = 0; i < 3; ++i) normals[v + i] /= length;
    }
    return { planar: false, points: flat, normals, facing: Math.hypot(...mean) > 0.2 * area ? mean : null };
}

const sourceSurface = surface(data.source);
const maps = data.maps.map(map => ({ ...map, absMu: decode(map.abs_mu, Float32Array), surface: surface(map) }));

const viridis = [0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e, 0x2a788e, 0x23888e, 0x1f988b, 0x22a884,
                 0x35b779, 0x54c568, 0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725];

function viridisAt(x) {  // 0…1 → [r, g, b]
    const at = Math.min(Math.max(x, 0), 1) * 15, i = Math.min(Math.floor(at), 14), f = at - i;
    const mix = shift => (1 - f) * (viridis[i] >> shift & 255) + f * (viridis[i + 1] >> shift & 255);
    return [16, 8, 0].map(shift => Math.round(mix(shift)));
}

const UNDEFINED = 254, FLIPPED = 255, palette = new Uint8Array(3 * 256);
for (let i = 0; i < UNDEFINED; ++i) palette.set(viridisAt(i / (UNDEFINED - 1)), 3 * i);
palette.set([154, 160, 168], 3 * UNDEFINED);
palette.set([255, 0, 212], 3 * FLIPPED);

const state = { map: maps[0], overlay: "none", shares: "area", top: 1, levels: new Uint8Array(triangleCount), texture: null };

function updateLevels() {
    const { map: { absMu }, levels, top } = state;
    for (let t = 0; t < triangleCount; ++t) {
        const m = absMu[t];
        levels[t] = m !== m ? UNDEFINED : m > 1 ? FLIPPED : Math.min(m / top, 1) * (UNDEFINED - 1);
    }
}

// The texture lives in the image plane; if the image lies in space, in the plane of the source; else there is none.
function updateTexture() {
    state.texture = [state.map.surface, sourceSurface].find(s => s.planar) || null;
}

// A software rasteriser: first which triangle is seen at each pixel, then the colour of the pixel.
const CELL = 0.125, LIGHT = [-0.35, 0.45, 0.82];

class View {
    constructor(canvas) {
        this.canvas = canvas;
        this.context = canvas.getContext("2d");
        this.pin = canvas.nextElementSibling;
        this.width = this.height = 0;
        this.fine = true;
        this.listen();
    }
    setSurface(shown) {
        const turned = this.surface && this.surface.planar === shown.planar;
        this.surface = shown;
        const n = shown.points.length / 3;
        [this.x, this.y, this.z, this.shade, this.facing] = [0, 1, 2, 3, 4].map(() => new Float32Array(n));
        if (!turned) this.reset();
    }
    reset() {
        this.zoom = 1;
        this.panX = this.panY = 0;
        this.axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
        if (this.surface.planar) return;
        const unit = a => a.map(c => c / Math.hypot(...a));
        const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        const forward = unit(this.surface.facing || [0.55, -0.75, 0.45]);
        const up = this.surface.facing && Math.abs(forward[1]) < 0.9 ? [0, 1, 0] : [0, 0, 1];
        const right = unit(cross(up, forward));
        this.axes = [right, cross(forward, right), forward];
    }
    turn(dx, dy) {  // radians about the vertical and the horizontal of the screen
        const rotate = (a, b, angle) => {
            const c = Math.cos(angle), s = Math.sin(angle), p = this.axes[a], q = this.axes[b];
            this.axes[a] = p.map((_, i) => c * p[i] + s * q[i]);
            this.axes[b] = p.map((_, i) => c * q[i] - s * p[i]);
        };
        rotate(0, 2, dx);
        rotate(1, 2, -dy);
    }
    project() {
        const { points, normals, planar } = this.surface;
        const { x, y, z, shade, facing, axes: [r, u, f], width, height } = this;
        const radius = this.fit(width, height), s = radius * this.zoom;
        const cx = width / 2 + this.panX * radius, cy = height / 2 + this.panY * radius;
        const l = [0, 1, 2].map(i => LIGHT[0] * r[i] + LIGHT[1] * u[i] + LIGHT[2] * f[i]);
        for (let v = 0, i = 0; v < x.length; ++v, i += 3) {
            const px = points[i], py = points[i + 1], pz = points[i + 2];
            x[v] = cx + s * (r[0] * px + r[1] * py + r[2] * pz);
            y[v] = cy - s * (u[0] * px + u[1] * py + u[2] * pz);
            z[v] = f[0] * px + f[1] * py + f[2] * pz;
            if (planar) continue;
            shade[v] = l[0] * normals[i] + l[1] * normals[i + 1] + l[2] * normals[i + 2];
            facing[v] = f[0] * normals[i] + f[1] * normals[i + 1] + f[2] * normals[i + 2];
        }
    }
    fit(width, height) { return Math.min(width, height) / (this.surface.planar ? 2.12 : 2.5); }
    findTriangles() {
        const { x, y, z, width, height, ids, depth, surface: { planar } } = this, { levels } = state;
        ids.fill(-1);
        depth.fill(-Infinity);
        for (let t = 0, i = 0; t < triangleCount; ++t, i += 3) {
            const a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
            const ax = x[a], ay = y[a], bx = x[b], by = y[b], cx = x[c], cy = y[c];
            const left = Math.max(Math.ceil(Math.min(ax, bx, cx) - 0.5), 0);
            const right = Math.min(Math.floor(Math.max(ax, bx, cx) - 0.5), width - 1);
            const top = Math.max(Math.ceil(Math.min(ay, by, cy) - 0.5), 0);
            const bottom = Math.min(Math.floor(Math.max(ay, by, cy) - 0.5), height - 1);
            if (!(left <= right && top <= bottom)) continue;  // NaN ends here too
            const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
            if (area === 0) continue;
            const bX = (cy - ay) / area, bY = (ax - cx) / area, cX = (ay - by) / area, cY = (bx - ax) / area;
            const az = planar ? (levels[t] === FLIPPED ? 1 : 0) : z[a];  // in the plane flipped faces lie on top
            const bz = planar ? 0 : z[b] - az, cz = planar ? 0 : z[c] - az, step = bX * bz + cX * cz;
            for (let row = top; row <= bottom; ++row) {
                const dx = left + 0.5 - ax, dy = row + 0.5 - ay;
                let lb = dx * bX + dy * bY, lc = dx * cX + dy * cY;  // barycentric coordinates
                let at = az + lb * bz + lc * cz, p = row * width + left;
                for (let column = left; column <= right; ++column, ++p, lb += bX, lc += cX, at += step) {
                    if (lb < -1e-6 || lc < -1e-6 || lb + lc > 1 + 1e-6 || at <= depth[p]) continue;
                    depth[p] = at;
                    ids[p] = t;
                }
            }
        }
    }
    paint() {
        const { x, y, shade, facing, width, height, ids, pixels, surface: { planar } } = this;
        const { levels, overlay } = state;
        const edges = overlay === "edges", circles = overlay === "circles";
        const uv = (overlay === "checker" || circles) && state.texture ? state.texture.points : null;
        const half = (this.fine ? 0.55 : 0.4) * width / this.canvas.clientWidth;  // of an edge's width, in pixels
        let last = -1, a, b, c, ax, ay, bX, bY, cX, cY;  // a triangle, and the gradients of b's and c's coordinates
        let red, green, blue, front;
        let u, v, ub, vb, uc, vc, blur;  // texture: at a, towards b and c, and cells per pixel
        let wA, wB, wC, awayB, awayC, fade;  // edges: heights of the triangle in pixels
        for (let row = 0, p = 0; row < height; ++row) for (let column = 0; column < width; ++column, ++p) {
            const t = ids[p];
            if (t < 0) { pixels[p] = 0; continue; }
            if (t !== last) {
                last = t;
                a = triangles[3 * t]; b = triangles[3 * t + 1]; c = triangles[3 * t + 2];
                ax = x[a]; ay = y[a];
                const area = (x[b] - ax) * (y[c] - ay) - (x[c] - ax) * (y[b] - ay);
                bX = (y[c] - ay) / area; bY = (ax - x[c]) / area; cX = (ay - y[b]) / area; cY = (x[b] - ax) / area;
                front = facing[a] + facing[b] + facing[c] >= 0;
                red = palette[3 * levels[t]]; green = palette[3 * levels[t] + 1]; blue = palette[3 * levels[t] + 2];
                if (uv) {
                    u = uv[3 * a] / CELL; v = uv[3 * a + 1] / CELL;
                    ub = uv[3 * b] / CELL - u; vb = uv[3 * b + 1] / CELL - v;
                    uc = uv[3 * c] / CELL - u; vc = uv[3 * c + 1] / CELL - v;
                    blur = 1e-6 + Math.SQRT1_2 *
                        Math.hypot(bX * ub + cX * uc, bY * ub + cY * uc, bX * vb + cX * vc, bY * vb + cY * vc);
                }
                if (edges) {  // the diagonal of a quad is no edge
                    wB = 1 / Math.hypot(bX, bY); wC = 1 / Math.hypot(cX, cY); wA = 1 / Math.hypot(bX + cX, bY + cY);
                    fade = 0.75 * Math.min(Math.max((Math.min(wA, wB, wC) / half - 3) / 12, 0.12), 1);
                    awayB = t + 1 < triangleCount && faces[t + 1] === faces[t] ? 1e9 : 0;
                    awayC = t > 0 && faces[t - 1] === faces[t] ? 1e9 : 0;
                }
            }
            const dx = column + 0.5 - ax, dy = row + 0.5 - ay;
            const lb = dx * bX + dy * bY, lc = dx * cX + dy * cY, la = 1 - lb - lc;
            let r = red, g = green, d = blue;
            if (uv) {
                const s = u + lb * ub + lc * uc, q = v + lb * vb + lc * vc, is = Math.floor(s), iq = Math.floor(q);
                const fs = s - is, fq = q - iq;
                let mix;
                if (circles) {
                    mix = Math.min(Math.max(0.5 + (0.38 - Math.hypot(fs - 0.5, fq - 0.5)) / blur, 0), 1);
                } else {
                    mix = Math.min(1, 2 * Math.min(fs, 1 - fs) / blur) * Math.min(1, 2 * Math.min(fq, 1 - fq) / blur);
                    mix = (is + iq) & 1 ? 0.5 + 0.5 * mix : 0.5 - 0.5 * mix;
                }
                const scale = circles ? 1 - 0.36 * mix : 0.76 - 0.14 * mix, lift = 92 * mix;
                r = r * scale + lift; g = g * scale + lift; d = d * scale + lift;
            }
            if (!planar) {
                const light = shade[a] * la + shade[b] * lb + shade[c] * lc;
                const factor = front ? 0.66 + 0.4 * Math.max(light, 0) : 0.42 + 0.3 * Math.max(-light, 0);
                r = Math.min(r * factor, 255); g = Math.min(g * factor, 255); d = Math.min(d * factor, 255);
            }
            if (edges) {
                const distance = Math.min(la * wA, lb * wB + awayB, lc * wC + awayC);
                const line = fade * Math.min(Math.max(half + 0.5 - distance, 0), 1);
                r += (12 - r) * line; g += (14 - g) * line; d += (20 - d) * line;
            }
            pixels[p] = 0xff000000 | d << 16 | g << 8 | r;
        }
    }
    render() {
        const box = this.canvas.getBoundingClientRect();
        if (!box.width) return;
        const ratio = this.fine ? Math.max(devicePixelRatio || 1, 2) : 1;
        const width = Math.round(Math.min(box.width * ratio, 1800));
        const height = Math.round(width * box.height / box.width);
        if (width !== this.width || height !== this.height) {
            [this.width, this.height] = [this.canvas.width, this.canvas.height] = [width, height];
            this.buffer = this.context.createImageData(width, height);
            this.pixels = new Uint32Array(this.buffer.data.buffer);
            this.depth = new Float32Array(width * height);
            this.ids = new Int32Array(width * height);
        }
        this.project();
        this.findTriangles();
        this.paint();
        this.context.putImageData(this.buffer, 0, 0);
    }
    schedule(fine = false) {  // coarse at once, fine when the hand rests
        clearTimeout(this.timer);
        this.fine = fine;
        this.frame ??= requestAnimationFrame(() => { this.frame = undefined; this.render(); });
        if (!fine) this.timer = setTimeout(() => this.schedule(true), 160);
    }
    triangleAt(event) {
        const box = this.canvas.getBoundingClientRect();
        const column = Math.floor((event.clientX - box.left) / box.width * this.width);
        const row = Math.floor((event.clientY - box.top) / box.height * this.height);
        const inside = column >= 0 && row >= 0 && column < this.width && row < this.height;
        return inside ? this.ids[row * this.width + column] : -1;
    }
    point(t) {  // puts the pin on a triangle
        const corner = i => triangles[3 * t + i];
        const middle = values => (values[corner(0)] + values[corner(1)] + values[corner(2)]) / 3;
        const x = middle(this.x) / this.width, y = middle(this.y) / this.height;
        this.pin.hidden = t < 0 || !(x > 0 && x < 1 && y > 0 && y < 1);
        this.pin.style.left = 100 * x + "%";
        this.pin.style.top = 100 * y + "%";
    }
    move(dx, dy, shift) {  // in radii of the figure
        hover(-1);
        if (this.surface.planar || shift) { this.panX += dx; this.panY += dy; } else this.turn(1.3 * dx, 1.3 * dy);
        this.schedule();
    }
    zoomBy(factor, event) {
        hover(-1);
        const box = this.canvas.getBoundingClientRect(), radius = this.fit(box.width, box.height);
        const x = event ? (event.clientX - box.left - box.width / 2) / radius : 0;
        const y = event ? (event.clientY - box.top - box.height / 2) / radius : 0;
        const zoom = Math.min(Math.max(this.zoom * factor, 0.3), 200), applied = zoom / this.zoom;
        this.panX = x - (x - this.panX) * applied;
        this.panY = y - (y - this.panY) * applied;
        this.zoom = zoom;
        this.schedule();
    }
    listen() {
        const { canvas } = this;
        let from = null;
        canvas.onpointerdown = event => {
            from = event;
            canvas.setPointerCapture(event.pointerId);
            canvas.classList.add("dragging");
        };
        canvas.onpointerup = canvas.onpointercancel = () => {
            from = null;
            canvas.classList.remove("dragging");
        };
        canvas.onpointerleave = () => hover(-1);
        canvas.onpointermove = event => {
            if (!from) return hover(this.triangleAt(event), this);
            const radius = this.fit(canvas.clientWidth, canvas.clientHeight);
            this.move((event.clientX - from.clientX) / radius, (event.clientY - from.clientY) / radius, event.shiftKey);
            from = event;
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
            else return;
            event.preventDefault();
        };
    }
}

function hover(t, view) {
    for (const other of [sourceView, imageView]) other.point(other === view ? -1 : t);
    const m = t < 0 ? 0 : state.map.absMu[t];
    $("readout").textContent = t < 0 ? "Point at a face to read its values."
        : `face ${faces[t]} · |μ| ${m === Infinity ? "∞" : show(m)} · ` +
          (m > 1 ? "flipped" : m !== m ? "undefined" : `K ${show(dilatation(m))}`);
}

const sourceView = new View($("source")), imageView = new View($("image"));
const redraw = () => { sourceView.schedule(true); imageView.schedule(true); };
