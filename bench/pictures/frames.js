// What pages cost a browser: frames.js PAGE.html …, one line each. Milliseconds until everything is drawn, the longest
// tasks until then (a task of more than 50 ms is one that freezes the page), and the median time between frames while the
// source's figure is turned. Chromium draws in software.

import { chromium } from "@playwright/test";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const FRAMES = 70;
const browser = await chromium.launch({ executablePath: process.env.BELTRAMI_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"] });

/// Of a page as it was before, too: it marks the end in the same way.
async function measure(path) {
    const page = await browser.newPage({ viewport: { width: 1300, height: 1000 } });
    await page.addInitScript(() => {
        window.longTasks = [];
        new PerformanceObserver(list => window.longTasks.push(...list.getEntries().map(({ startTime, duration }) =>
            [Math.round(startTime), Math.round(duration)]))).observe({ type: "longtask", buffered: true });
    });
    const begun = Date.now();
    await page.goto(pathToFileURL(resolve(path)).href);
    await page.waitForFunction(() => document.documentElement.dataset.ready === "ok", null, { timeout: 120_000 });
    const opened = Date.now() - begun, parsed = await page.evaluate(() =>
        Math.round(performance.getEntriesByType("navigation")[0].domInteractive));
    const tasks = await page.evaluate(() => window.longTasks);
    const source = page.locator("#source");
    await source.scrollIntoViewIfNeeded();
    await page.waitForTimeout(1500);
    const times = await source.evaluate(async (canvas, frames) => {
        const { left, top, width, height } = canvas.getBoundingClientRect(), times = [];
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
        return times.sort((a, b) => a - b);
    }, FRAMES);
    await page.close();
    const longest = tasks.sort((a, b) => b[1] - a[1]).slice(0, 4).map(([at, long]) => `${long} (at ${at})`);
    console.log(`${path}: open ${opened}, parsed ${parsed}, longest tasks ${longest.join(", ") || "none above 50"}, ` +
        `frame ${times[times.length >> 1].toFixed(0)}, worst of 10 % ${times[Math.floor(0.9 * times.length)].toFixed(0)}`);
}

for (const path of process.argv.slice(2)) await measure(path);
await browser.close();
