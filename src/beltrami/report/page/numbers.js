// The data of the page, numbers as text, and the parts of the page that are text.

export const $ = id => document.getElementById(id);
export const data = JSON.parse($("data").textContent);
export const record = data.record, mainMap = record.map || {}, solve = record.solve || {};
export const bounds = (mainMap.bounds || []).filter(bound => typeof bound.K === "number");
// The bound that K_lower repeats, if it is among them.
export const lowerBound = bounds.find(bound => Math.abs(bound.K - mainMap.K_lower) < 1e-9 * bound.K);

export function element(tag, attributes = {}, ...children) {
    const node = document.createElement(tag);
    Object.assign(node, attributes);
    node.append(...children);
    return node;
}

export function svgElement(parent, tag, attributes = {}, text) {
    const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const name in attributes) node.setAttribute(name, attributes[name]);
    if (text !== undefined) node.textContent = text;
    parent.append(node);
    return node;
}

export const isNumber = x => typeof x === "number" && isFinite(x);

export function show(x, digits = 4) {
    if (!isNumber(x)) return "—";
    if (Number.isInteger(x) && Math.abs(x) < 1e9) return String(x).replace(/\B(?=(\d{3})+$)/g, "\u202f");
    const size = Math.abs(x);
    if (size >= 1e-3 && size < 1e6) return String(parseFloat(x.toPrecision(digits)));
    const [mantissa, power] = x.toExponential(Math.min(digits - 1, 2)).split("e");
    const raised = [...String(+power)].map(c => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻").join("");
    return (parseFloat(mantissa) === 1 ? "" : parseFloat(mantissa) + "·") + "10" + raised;
}

export const fixed = (x, digits = 4) =>  // with the zeros at the end
    isNumber(x) && Math.abs(x) >= 1e-3 && Math.abs(x) < 10 ** digits ? x.toPrecision(digits) : show(x, digits);
export const percent = x => x > 0 && x < 0.001 ? "< 0.1 %" : show(100 * x, 3) + " %";
export const count = (n, word, many = word + "s") => `${n ? show(n) : "no"} ${n === 1 ? word : many}`;
export const words = text => String(text).replace(/_/g, " ");
export const dilatation = k => k < 1 ? (1 + k) / (1 - k) : Infinity;

export function roundTicks(low, high, wanted) {  // ticks as pairs of number and text
    const raw = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 2.5, 5, 10].find(digit => digit * power >= raw * 0.999) * power, ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push(i * step);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9) + (step / power === 2.5 ? 1 : 0));
    return ticks.map(x => [x, decimals > 6 ? show(x) : x.toFixed(decimals)]);
}

function turnsInWords({ outer_loop, holes = [] }) {
    const turned = holes.filter(hole => hole.meaningful && hole.turns !== 0)
        .map(({ loop, turns }) => `loop ${loop} by ${count(Math.abs(turns), "whole turn")} ` +
            (turns > 0 ? "counter-clockwise" : "clockwise"));
    const unclear = holes.filter(hole => !hole.meaningful).map(hole => `loop ${hole.loop}`);
    return (turned.length ? `Against loop ${outer_loop} the map turns ${turned.join(", ")}.`
                          : `No hole is turned against loop ${outer_loop}.`) +
        (unclear.length ? ` Of ${unclear.join(", ")} it cannot be told: faces there are flipped.` : "");
}

export function writeSentence() {
    const { K, K_max, K_lower, flipped, degenerate } = mainMap, sentences = [];
    if (isNumber(K)) {
        let sentence = `This map stretches by K ≈ ${fixed(K)}`;
        if (isNumber(K_max)) {
            sentence = K_max > 1.005 * K ? `${sentence} (the worst face by ${fixed(K_max)})`
                                         : `This map stretches nowhere by more than K ≈ ${fixed(Math.max(K, K_max))}`;
        }
        if (isNumber(K_lower)) {
            const closed = record.source?.boundary_loops?.length === 0;
            const rivals = (lowerBound?.of === "mesh" ? "no map of this mesh" : "no map") +
                (closed ? " of the same homotopy class" : " with the same boundary conditions") +
                (record.homotopy?.holes?.length ? " in the same homotopy class" : "");
            sentence += lowerBound?.rigorous === false
                ? `; by an estimate, ${rivals} gets below about ${fixed(K_lower)}`
                : `; ${rivals} can do better than ${fixed(K_lower)}`;
        }
        sentences.push(sentence + ".");
    }
    if (flipped === 0) sentences.push("No face is flipped.");
    const faces = n => count(n, "face is", "faces are");
    if (flipped > 0) sentences.push(`${faces(flipped)} flipped: there the map is not one-to-one.`);
    if (degenerate > 0) sentences.push(`${faces(degenerate)} degenerate.`);
    if (record.least_maximum) {
        const { before, after } = record.least_maximum;
        sentences.push(`The largest |μ| of a face was ${fixed(before)} and is now ${fixed(after)}.`);
    }
    if (record.certificate) {
        const { wanted, reason } = record.certificate;
        sentences.push(`Certificate of ${percent(wanted)}: ${reason}.`);
    }
    if (record.homotopy) sentences.push(turnsInWords(record.homotopy));
    if (solve.termination) {
        const steps = isNumber(solve.iterations) ? ` after ${count(solve.iterations, "iteration")}` : "";
        const converged = solve.termination === "converged";
        sentences.push(converged ? `The computation converged${steps}.`
                                 : `The computation ended${steps}: ${words(solve.termination)}.`);
    }
    $("lead").textContent = sentences.join(" ");
}

export function writeNumbers() {
    const add = (name, value, detail = "", alarm = false) => $("numbers").append(element("div", {},
        element("dt", { textContent: name }),
        element("dd", { textContent: value, className: alarm ? "value alarm" : "value" }),
        element("dd", { textContent: detail, className: "detail" })));
    const { k, K, K_lower, K_lower_proved, K_upper, K_max, mu = {}, flipped, degenerate, boundary_residual } = mainMap, { seconds = {} } = solve;
    if (isNumber(K)) add("Dilatation K", fixed(K), isNumber(k) ? `k = ${fixed(k)}` : "");
    const gap = isNumber(K) && K > K_lower ? K / K_lower - 1 : 0;
    if (isNumber(K_lower)) add("Lower bound", fixed(K_lower), isNumber(K) ? `gap ${percent(gap)}` : "");
    if (isNumber(K_lower_proved) && K_lower_proved < K_lower) add("Proved bound", fixed(K_lower_proved), "the other one is an estimate");
    if (isNumber(K_upper)) add("Verified upper bound", fixed(K_upper), "of K*, by a piecewise quadratic map");
    if (K_max !== undefined) add("K of worst face", fixed(K_max), isNumber(mu.max) ? `|μ| = ${fixed(mu.max)}` : "");
    if (isNumber(mu.mean)) add("Mean |μ|", fixed(mu.mean), isNumber(mu.std) ? `± ${show(mu.std, 2)}` : "");
    if (flipped !== undefined) add("Flipped faces", show(flipped), `${show(degenerate ?? 0)} degenerate`, flipped > 0);
    if (isNumber(boundary_residual)) add("Boundary error", show(boundary_residual, 2));
    if (isNumber(solve.iterations)) add("Iterations", show(solve.iterations), words(solve.termination ?? ""));
    const { corners } = record, sharpest = corners?.sharpest;
    if (corners) add("Corners, kinks", show(corners.count),
                     sharpest ? `at vertex ${sharpest.vertex} K ≥ about ${fixed(sharpest.K)}` : "");
    if (record.split) add("Edges split", show(record.split.edges), count(record.split.added.length, "added vertex", "added vertices"));
    const factorizations = solve.factorizations ? count(solve.factorizations, "factorization") : "";
    if (isNumber(seconds.total)) add("Time", show(seconds.total, 3) + "\u202fs", factorizations);
    if (!$("numbers").children.length) $("numbers").hidden = true;
    for (const warning of record.warnings || []) {
        $("warnings").hidden = false;
        const text = typeof warning === "string" ? warning : JSON.stringify(warning);
        $("warnings").lastElementChild.append(element("li", { textContent: text }));
    }
}

export function writeComparison() {
    const rows = [{ method: data.maps[0].name, map: mainMap, solve }, ...(record.comparison || [])];
    $("comparison-section").hidden = rows.length < 2;
    const columns = {
        "method": r => words(r.method ?? ""),
        "K": r => fixed(r.map?.K),
        "K worst face": r => fixed(r.map?.K_max),
        "mean |μ|": r => fixed(r.map?.mu?.mean),
        "std |μ|": r => fixed(r.map?.mu?.std, 3),
        "max |μ|": r => fixed(r.map?.mu?.max),
        "flipped": r => show(r.map?.flipped),
        "iterations": r => show(r.solve?.iterations),
        "seconds": r => fixed(r.solve?.seconds?.total, 3),
    };
    const head = Object.keys(columns).map(name => element("th", { scope: "col", textContent: name }));
    const body = rows.map(row => {
        const cells = Object.values(columns).map(value => element("td", { textContent: value(row) }));
        if (row.map?.flipped > 0) cells[Object.keys(columns).indexOf("flipped")].className = "alarm";
        return element("tr", {}, ...cells);
    });
    $("comparison").append(element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...body));
}

export function writeRecord() {
    $("json").textContent = JSON.stringify(record, null, 2);
    $("copy").onclick = async () => {
        try {
            await navigator.clipboard.writeText($("json").textContent);
        } catch {
            getSelection().selectAllChildren($("json"));
            document.execCommand("copy");
        }
        $("copy").textContent = "Copied";
        setTimeout(() => $("copy").textContent = "Copy", 1500);
    };
}
