// The controls, and what happens when the page opens.

function chooseMap(index) {
    state.map = maps[index];
    updateTexture();
    updateLevels();
    imageView.setSurface(state.map.surface);
    for (const input of document.querySelectorAll("input[value=checker], input[value=circles]")) {
        input.disabled = !state.texture;
        input.parentNode.classList.toggle("off", !state.texture);
    }
    const { source = {} } = record, facts = [], { histogram: { area: histogram }, surface: { planar } } = state.map;
    if (isNumber(source.vertices)) facts.push(count(source.vertices, "vertex", "vertices"));
    facts.push(count(data.faces, "face"));
    if (source.components > 1) facts.push(count(source.components, "component"));
    if (isNumber(source.genus)) facts.push(`genus ${source.genus}`);
    if (source.boundary_loops) facts.push(count(source.boundary_loops.length, "boundary loop"));
    $("source-caption").replaceChildren(element("b", { textContent: "Source" }), " — " + facts.join(", "));
    $("image-caption").replaceChildren(element("b", { textContent: `Image, ${words(state.map.name)} map` }),
        " — " + (planar ? "in the plane" : "in space") +
        (histogram.flipped ? `, ${percent(histogram.flipped)} of the area flipped` : ""));
    $("source").setAttribute("aria-label", `Source surface, coloured by |μ| of the ${words(state.map.name)} map`);
    $("image").setAttribute("aria-label", `Image under the ${words(state.map.name)} map, coloured by |μ|`);
    updateLegend();
}

function setTop(top) {
    state.top = Math.min(Math.max(top, 0.001), 1);
    $("range").value = Math.log10(state.top);
    $("range-value").textContent = show(state.top, 2);
    $("range").setAttribute("aria-valuetext", show(state.top, 2));
    updateLevels();
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

function connect() {
    maps.forEach((map, i) => $("map").append(element("option", { value: i, textContent: words(map.name) })));
    $("map-choice").hidden = maps.length < 2;
    $("map").onchange = () => { chooseMap(+$("map").value); redraw(); };
    for (const input of document.querySelectorAll("input[name=overlay]")) {
        input.checked = input.value === state.overlay;
        input.onchange = () => { state.overlay = input.value; redraw(); };
    }
    for (const input of document.querySelectorAll("input[name=shares]")) {
        input.checked = input.value === state.shares;
        input.onchange = () => { state.shares = input.value; drawHistogram(); };
    }
    $("range").oninput = () => { setTop(10 ** +$("range").value); sourceView.schedule(); imageView.schedule(); };
    $("fit").onclick = () => { setTop(bestTop([state.map])); redraw(); };
    $("reset").onclick = () => { sourceView.reset(); imageView.reset(); redraw(); };
    if (data.coarsened) {
        $("drawing-note").textContent = `The mesh has ${show(data.faces)} faces; the figures show a coarser mesh of
            ${show(triangleCount)} triangles. All numbers and the histogram come from the full mesh.`;
    }
    let shownWidth = 0;
    new ResizeObserver(() => {
        if (document.body.clientWidth === shownWidth) return;
        shownWidth = document.body.clientWidth;
        drawCharts();
        redraw();
    }).observe(document.body);
}

function selfTest() {  // page.html#selftest: every map with every overlay, turned and zoomed
    for (let i = 0; i < maps.length; ++i) {
        chooseMap(i);
        for (const overlay of ["none", "checker", "circles", "edges"]) for (const view of [sourceView, imageView]) {
            state.overlay = overlay;
            view.turn(0.4, 0.2);
            view.fine = false;
            const start = performance.now();
            view.render();
            document.documentElement.dataset.milliseconds = Math.round(performance.now() - start);
            const t = view.ids.find(id => id >= 0);
            if (t === undefined) throw new Error(`nothing is drawn: ${maps[i].name}, ${overlay}`);
            hover(t);
        }
    }
    for (state.shares of ["faces", "area"]) drawHistogram();
    for (const view of [sourceView, imageView]) {
        view.move(0.1, 0.1, true);
        view.zoomBy(2);
        view.reset();
        view.schedule(true);
    }
    setTop(0.5);
    state.overlay = "none";
    hover(-1);
    chooseMap(0);
}

function start() {
    writeSentence();
    writeNumbers();
    writeComparison();
    writeRecord();
    sourceView.setSurface(sourceSurface);
    chooseMap(0);
    state.overlay = state.texture ? "circles" : triangleCount <= 2500 ? "edges" : "none";
    connect();
    setTop(bestTop(maps));
    drawCharts();
    hover(-1);
    sourceView.render();
    imageView.render();
    if (location.hash === "#selftest") { selfTest(); sourceView.render(); imageView.render(); }
    document.documentElement.dataset.ready = "ok";
}

start();
