// The page's end of drawing.js: what is asked of it, and its answers.

import { pause } from "./mesh.js";
import { $ } from "./numbers.js";

const waiting = new Map();
let port, asked = 0;

/// For checks of the page: data-pending counts what has been begun and is not yet seen.
export function pending(change) { document.documentElement.dataset.pending = (+document.documentElement.dataset.pending || 0) + change; }

/// @throw Error as drawing.js does
export function ask(name, given) {
    pending(1);
    return new Promise((resolve, reject) => {
        waiting.set(++asked, { resolve, reject });
        port.postMessage({ number: asked, name, given }, given instanceof ArrayBuffer ? [given] : []);
    }).finally(() => pending(-1));
}

function listen(end) {
    port = end;
    port.onmessage = ({ data: { number, result, error } }) => {
        const { resolve, reject } = waiting.get(number);
        waiting.delete(number);
        if (error === undefined) resolve(result); else reject(new Error(error));
    };
}

async function inWorker() {
    const address = URL.createObjectURL(new Blob([$("drawing").textContent], { type: "text/javascript" })), worker = new Worker(address);
    worker.onerror = () => {
        for (const { reject } of waiting.values()) reject(new Error("no worker begins"));
        waiting.clear();
    };
    listen(worker);
    try {
        await ask("begin");
        worker.onerror = null;  // what goes wrong later is for the console
    } catch (error) {
        worker.terminate();
        throw error;
    } finally {
        URL.revokeObjectURL(address);
    }
}

async function inPage() {
    const { port1, port2 } = new MessageChannel(), script = document.createElement("script");
    globalThis.drawingPort = port2;
    script.textContent = $("drawing").textContent;
    document.head.append(script);
    listen(port1);
    await ask("begin");
}

/// Begins to draw, in the page where a worker cannot; false where neither can. All else is answered then, too.
export async function beginDrawing() {
    for (const begin of [inWorker, inPage]) {
        try {
            await begin();
            return true;
        } catch { /* the next */ }
    }
    return false;
}

const PIECE = 1 << 19;

/// Hands over what the page draws, piece by piece: nothing is held up by its length.
export async function readMesh() {
    const text = $("mesh").textContent, bytes = new Uint8Array(text.length), encoder = new TextEncoder();  // of ASCII alone
    for (let at = 0; at < text.length; at += PIECE) {
        encoder.encodeInto(text.slice(at, at + PIECE), bytes.subarray(at));
        await pause();
    }
    return ask("read", bytes.buffer);
}
