// What pages cost a browser: frames.js PAGE.html …, one line each. Milliseconds until everything is drawn; the longest task
// of the page itself until then by the clock (one of more than 50 ms freezes it), by the processor, and of it script; and
// the median time between pictures while the source's figure is turned. Chromium draws in software.

import { chromium } from "@playwright/test";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { longestTasks } from "./tasks.js";

const FRAMES = 70;
const browser = await chromium.launch({ executablePath: process.env.BELTRAMI_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"] });

/// Of a page as it was before, too: it marks the end in the same way.
async function measure(path) {
    const page = await browser.newPage({ viewport: { width: 1300, height: 1000 } });
    let opened = 0;
    const { clock, processor, script } = await longestTasks(browser, page, async () => {
        const begun = Date.now();
        await page.goto(pathToFileURL(resolve(path)).href);
        await page.waitForFunction(() => document.documentElement.dataset.ready === "ok", null, { timeout: 120_000 });
        opened = Date.now() - begun;
    });
    const source = page.locator("#source");
    await source.scrollIntoViewIfNeeded();
    await page.waitForTimeout(1500);
    const times = await source.evaluate(async (canvas, frames) => {
        const { left, top, width, height } = canvas.getBoundingClientRect(), times = [], pictures = [];
        canvas.addEventListener("drawn", () => pictures.push(performance.now()));
        const fire = (type, way) => canvas.dispatchEvent(new PointerEvent(type, {
            pointerId: 1, clientX: left + width / 2 + way, clientY: top + height / 2 + way / 3, bubbles: true }));
        canvas.setPointerCapture = () => {};
        fire("pointerdown", 0);
        for (let i = 0, last; i <= frames; ++i) {
            const now = await new Promise(requestAnimationFrame);
            if (last) times.push(now - last);
            last = now;
            fire("pointermove", 3 * i);
        }
        fire("pointerup", 3 * frames);
        // A page that does not say when it has drawn draws between its frames.
        const between = pictures.length ? pictures.slice(1).map((time, i) => time - pictures[i]) : times;
        return between.sort((a, b) => a - b);
    }, FRAMES);
    await page.close();
    const round = x => x.toFixed(0);
    console.log(`${path}: open ${opened}, longest task ${round(clock)} by the clock, ${round(processor)} of the processor, ` +
        `script ${round(script)}, ` +
        `frame ${times[times.length >> 1].toFixed(0)}, worst of 10 % ${times[Math.floor(0.9 * times.length)].toFixed(0)}`);
}

for (const path of process.argv.slice(2)) await measure(path);
await browser.close();
