// Report pages, opened from the file system: they draw without an error, fetch nothing, and answer mouse, keys and fingers.

import { chromium, expect, test as base } from "@playwright/test";
import { pathToFileURL } from "node:url";
import { longestTasks } from "./tasks.js";

const addressOf = name => pathToFileURL(`${process.env.BELTRAMI_PAGES}/${name}.html`).href;

/// open(name) opens a page and, when the test is over, holds against it what the console said and what was fetched.
const test = base.extend({
    open: async ({ page }, use) => {
        const complaints = [];
        page.on("console", message => message.type() === "error" && complaints.push(message.text()));
        page.on("pageerror", error => complaints.push(error.message));
        page.on("request", request => /^(file|data|blob):/.test(request.url()) || complaints.push(request.url()));
        await use(async name => {
            await page.goto(addressOf(name));
            await expect(page.locator("html")).toHaveAttribute("data-ready", "ok", { timeout: 60_000 });
            return page;
        });
        expect(complaints).toEqual([]);
        expect(await page.locator("html").getAttribute("data-errors")).toBe("0");
    },
});

/// A figure when it has come to rest: its colours, and how many of its pixels are not empty.
async function pictureOf(page, figure) {
    await page.waitForTimeout(50);
    await expect(page.locator("html")).toHaveAttribute("data-pending", "0", { timeout: 30_000 });
    return page.evaluate(async id => {
        const image = await createImageBitmap(document.getElementById(id));
        const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
        context.drawImage(image, 0, 0);
        const { data } = context.getImageData(0, 0, image.width, image.height);
        let filled = 0, sum = 0;
        for (let i = 0; i < data.length; i += 4) {
            filled += data[i + 3] > 0;
            sum = (31 * sum + data[i] + 256 * data[i + 1] + 65536 * data[i + 2]) % 2147483647;
        }
        return { filled: filled / (image.width * image.height), sum };
    }, figure);
}

async function clickAt(page, figure, x, y) {  // in a planar figure's coordinates, from −1 to 1
    const canvas = page.locator(`#${figure}`), { width, height } = await canvas.boundingBox(), radius = Math.min(width, height) / 2.12;
    await canvas.click({ position: { x: width / 2 + x * radius, y: height / 2 - y * radius } });
}

for (const name of ["triangles", "quads_in_space", "coarsened", "differential", "cut"])
    test(`${name}: every map with everything that can be shown`, async ({ open }) => {
        const page = await open(name), seen = new Set();
        for (const option of await page.locator("#map option").all()) {
            if (await page.locator("#map").isVisible()) await page.selectOption("#map", await option.getAttribute("value"));
            for (const overlay of await page.locator("input[name=overlay]:visible:enabled").all()) {
                await overlay.check();
                for (const figure of ["source", "image"]) {
                    const { filled, sum } = await pictureOf(page, figure);
                    expect(filled).toBeGreaterThan(0.2);
                    seen.add(sum);
                }
            }
        }
        expect(seen.size).toBeGreaterThan(3);
        for (const layer of ["trajectories", "across", "points", "ellipses", "edges"]) {
            const box = page.locator(`#${layer}`);
            if (await box.isDisabled()) continue;
            const before = await pictureOf(page, "source");
            await box.setChecked(!await box.isChecked());
            await expect(page.locator("#busy")).toBeEmpty();
            if (["differential", "cut"].includes(name)) expect((await pictureOf(page, "source")).sum).not.toBe(before.sum);
        }
        await page.getByLabel("faces", { exact: true }).check();
        await expect(page.locator("#histogram rect").first()).toBeVisible();
    });

test("a face that is clicked keeps its numbers and shows the lines through it", async ({ open }) => {
    const page = await open("triangles");
    const before = await pictureOf(page, "source");
    // Cells of 1/15, two faces each: the lower right half of the one in column 22 and row 18 comes first.
    await clickAt(page, "image", -1 + 22.7 / 15, -1 + 18.2 / 15);
    await expect(page.locator("#readout")).toContainText(`face ${2 * (18 * 30 + 22)} · |μ| 0.3 · K 1.857`);
    await page.mouse.move(5, 5);
    await expect(page.locator("#readout")).toContainText("face 1124");
    await expect(page.locator("#source + .pin")).toBeVisible();
    await expect.poll(async () => (await pictureOf(page, "source")).sum).not.toBe(before.sum);
    await page.locator("#image").press("Escape");
    await expect(page.locator("#readout")).toContainText("Point at a face");
    await page.locator("#image").press("Enter");
    await expect(page.locator("#readout")).toContainText(/face \d+/);
});

test("the mouse and the keys turn a surface, and 0 turns it back", async ({ open }) => {
    const page = await open("triangles"), source = page.locator("#source"), before = await pictureOf(page, "source");
    const { x, y, width, height } = await source.boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 90, y + height / 2 + 40, { steps: 6 });
    await page.mouse.up();
    const turned = await pictureOf(page, "source");
    expect(turned.sum).not.toBe(before.sum);
    await source.press("ArrowLeft");
    await source.press("+");
    expect((await pictureOf(page, "source")).sum).not.toBe(turned.sum);
    await source.press("0");
    await expect.poll(async () => (await pictureOf(page, "source")).filled).toBeCloseTo(before.filled, 2);
});

test("the slider leads from the source to the image", async ({ open }) => {
    const page = await open("triangles"), before = await pictureOf(page, "source");
    await page.locator("#blend").fill("1");
    const { filled, sum } = await pictureOf(page, "source");
    expect(sum).not.toBe(before.sum);
    // A square of half width 1 where 2.5 is the width.
    expect(filled).toBeCloseTo((2 / 2.5) ** 2, 1);
});

test("an image is laid over both figures", async ({ open }) => {
    const page = await open("differential");
    await expect(page.locator("input[value=image]")).toBeChecked();
    const image = await pictureOf(page, "image");
    await page.locator("input[value=none]").check();
    expect((await pictureOf(page, "image")).sum).not.toBe(image.sum);
});

test("a chart of faces that never are flipped begins at 0", async ({ open }) => {
    const page = await open("differential");
    expect(await page.locator("#flow-flips text").allTextContents()).toEqual(["0", "1", "1", "2", "3", "iteration", "flipped"]);
});

test("trajectories and zeros are those of φ where the page brings one", async ({ open }) => {
    const page = await open("differential");
    await expect(page.locator("#trajectories-name")).toHaveText("horizontal trajectories of φ");
    await expect(page.locator("#points-name")).toHaveText("1 zero, 1 pole");
    await expect(page.locator("#points")).toBeChecked();
});

test("a surface that is cut open shows its polygon, and lines that go on across the cut", async ({ open }) => {
    const page = await open("cut");
    await expect(page.locator("#points-name")).toHaveText("1 zero (2 by order), no poles");
    await expect(page.locator("#outline-choice")).toBeHidden();
    await page.selectOption("#map", { label: "fundamental polygon" });
    await expect(page.locator("#image-caption")).toContainText("The source, cut open — in the plane");
    const pictures = async () => Promise.all(["source", "image"].map(async figure => (await pictureOf(page, figure)).sum));
    const shown = await pictures();
    await page.locator("#outline").uncheck();
    const hidden = await pictures();
    expect(hidden[0]).not.toBe(shown[0]);  // the cut
    expect(hidden[1]).not.toBe(shown[1]);  // the outline
    // The line through a face near the right side goes on from the left side: it is drawn there too.
    await page.locator("#points").uncheck();
    const left = () => page.evaluate(async () => {
        const image = await createImageBitmap(document.getElementById("image")), { width, height } = image;
        const context = new OffscreenCanvas(width, height).getContext("2d");
        context.drawImage(image, 0, 0);
        const { data } = context.getImageData(width * 0.3, height * 0.3, width * 0.08, height * 0.4);
        return data.reduce((sum, value, i) => (31 * sum + value * (i % 97)) % 2147483647, 0);
    });
    await page.waitForTimeout(250);
    const before = await left();
    await clickAt(page, "image", 0.42, 0);
    await expect(page.locator("#readout")).toContainText("face");
    await page.mouse.move(5, 5);
    await expect.poll(left).not.toBe(before);
    await page.locator("#image").press("Escape");
    await page.locator("#trajectories").check();
    await expect(page.locator("#busy")).toBeEmpty();
    expect((await pictures())[1]).not.toBe(hidden[1]);
});

test("a page of 200 000 faces opens without being held up, and turns", async ({ browser, page, open }) => {
    const opened = await longestTasks(browser, page, () => open("large")), source = page.locator("#source");
    await source.scrollIntoViewIfNeeded();
    const { median, pictures } = await source.evaluate(async canvas => {
        const { left, top, width, height } = canvas.getBoundingClientRect(), times = [], pictures = [];
        const fire = (type, way) => canvas.dispatchEvent(new PointerEvent(type, {
            pointerId: 1, clientX: left + width / 2 + way, clientY: top + height / 2 + way / 3, bubbles: true }));
        canvas.setPointerCapture = () => {};
        canvas.addEventListener("drawn", () => times.push(performance.now()));
        fire("pointerdown", 0);
        for (let i = 0; times.length < 30; ++i) {
            await new Promise(requestAnimationFrame);
            fire("pointermove", 4 * (i % 100));
        }
        fire("pointerup", 160);
        for (let i = 1; i < times.length; ++i) pictures.push(times[i] - times[i - 1]);
        return { median: pictures.sort((a, b) => a - b)[pictures.length >> 1], pictures: times.length };
    });
    console.log(`longest script ${opened.script.toFixed(1)} ms, longest task ${opened.processor.toFixed(1)} ms of the processor, median frame ${median.toFixed(1)} ms`);
    expect(opened.script).toBeGreaterThan(0);
    expect(opened.script).toBeLessThan(100);
    expect(pictures).toBeGreaterThanOrEqual(30);
    expect(median).toBeLessThan(250);
});

test("where no worker begins the page draws itself", async ({ page, open }) => {
    await page.addInitScript(() => { window.Worker = class { constructor() { throw new Error("no worker"); } }; });
    await open("triangles");
    expect((await pictureOf(page, "source")).filled).toBeGreaterThan(0.2);
    await clickAt(page, "image", -1 + 22.7 / 15, -1 + 18.2 / 15);
    await expect(page.locator("#readout")).toContainText("face 1124");
});

test.describe("on a phone", () => {
    test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    test("nothing is wider than the screen; two fingers make the figure larger", async ({ open }) => {
        const page = await open("triangles");
        expect(await page.evaluate(() => document.scrollingElement.scrollWidth)).toBeLessThanOrEqual(390);
        await page.locator("#image").scrollIntoViewIfNeeded();
        await page.locator("#image").tap();
        await expect(page.locator("#readout")).toContainText(/face \d+/);
        const { x, y, width, height } = await page.locator("#image").boundingBox(), before = await pictureOf(page, "image");
        const client = await page.context().newCDPSession(page), middle = { x: x + width / 2, y: y + height / 2 };
        const fingers = apart => [{ x: middle.x - apart, y: middle.y, id: 0 }, { x: middle.x + apart, y: middle.y, id: 1 }];
        await client.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: fingers(30) });
        for (const apart of [40, 60, 90]) await client.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: fingers(apart) });
        await client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
        expect((await pictureOf(page, "image")).filled).toBeGreaterThan(1.05 * before.filled);
    });
});

test("without WebGL the numbers are there and the page says what is missing", async () => {
    const browser = await chromium.launch({ executablePath: process.env.BELTRAMI_CHROMIUM,
        args: ["--no-sandbox", "--disable-gpu", "--disable-software-rasterizer", "--disable-3d-apis"] });
    const page = await browser.newPage();
    await page.goto(addressOf("triangles"));
    await expect(page.locator("html")).toHaveAttribute("data-ready", "ok");
    await expect(page.locator("#drawing-note")).toContainText("no WebGL");
    await expect(page.locator("#numbers")).toContainText("1.857");
    await expect(page.locator("#histogram rect").first()).toBeVisible();
    await browser.close();
});
