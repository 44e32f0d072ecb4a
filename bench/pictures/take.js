// Takes the pictures of docs/pictures from report pages: take.js PAGES_FOLDER PICTURE_FOLDER, with the pages face.html (of a
// scan and the star), bunny.html (the same of the demo's scan, with a texture), closed.html (a registration, with one) and
// handles.html (one of surfaces of genus 2); and from readme.html.

import { chromium } from "@playwright/test";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, pictures] = process.argv.slice(2).map(path => resolve(path));
const browser = await chromium.launch({ executablePath: process.env.BELTRAMI_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"] });

async function open(name, options) {
    const page = await browser.newPage({ viewport: { width: 1300, height: 1000 }, ...options });
    await page.goto(pathToFileURL(`${folder}/${name}.html`).href);
    await page.waitForFunction(() => document.documentElement.dataset.ready === "ok");
    return page;
}

/// A figure as it has come to rest, as an address of data.
async function figure(page, id) {
    await page.waitForTimeout(1500);
    return page.evaluate(async id => {
        const image = await createImageBitmap(document.getElementById(id)), canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [image.width, image.height];
        canvas.getContext("2d").drawImage(image, 0, 0);
        return canvas.toDataURL();
    }, id);
}

async function firstScreen() {
    const page = await open("face", { viewport: { width: 1100, height: 1000 } });
    const record = JSON.parse(await page.locator("#json").textContent());
    await page.locator("input[value=circles]").check();
    await page.locator("#points").uncheck();
    const show = x => x.toPrecision(5), panels = [[await figure(page, "source"), "a scan", `${record.source.faces.toLocaleString("en")} faces`]];
    await page.selectOption("#map", { label: "harmonic" });
    panels.push([await figure(page, "image"), "harmonic map", `${record.comparison[0].map.flipped} faces flipped (magenta)`]);
    await page.selectOption("#map", { label: "extremal" });
    const { K, K_lower, flipped } = record.map;
    panels.push([await figure(page, "image"), "extremal map", `${flipped || "none"} flipped, ${show(K_lower)} ≤ K* ≤ ${show(K)} (estimates)`]);
    await page.setContent(`<style>body { margin: 0; background: #fff; color: #1a1f26; font: 15px system-ui, sans-serif; text-align: center }
        div { display: inline-grid; grid-template-columns: repeat(3, 320px); gap: 0 16px; padding: 10px 14px 14px } img { width: 320px }
        b { display: block; font-size: 17px }</style><div>${panels.map(([src, name, detail]) =>
        `<figure style="margin:0"><img src="${src}"><b>${name}</b>${detail}</figure>`).join("")}</div>`);
    await page.locator("div").screenshot({ path: `${pictures}/first_screen.png` });
    await page.close();
}

async function screen(name, file, options, prepare) {
    const page = await open(name, options);
    await prepare(page);
    await page.waitForTimeout(200);
    await page.waitForFunction(() => document.documentElement.dataset.pending === "0");
    await page.screenshot({ path: `${pictures}/${file}.png` });
    await page.close();
}

const tick = async (page, ...boxes) => { for (const box of boxes) await page.locator(`#${box}`).check(); };
const toFigures = page => page.evaluate(() => document.getElementById("maps-heading").scrollIntoView());

await firstScreen();
/// The page of a scan mapped to a star and that of a closed surface carried onto another one, on a screen and on a phone, in
/// the light and in the dark: with trajectories and ellipses; in the dark a face is kept, and the image lies over the scan.
const widths = { screen: {}, phone: { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true } };
for (const [name, subject] of [["bunny", "scan"], ["closed", "closed"]])
    for (const [width, size] of Object.entries(widths))
        for (const colorScheme of ["light", "dark"])
            await screen(name, `page_${subject}_${width}_${colorScheme}`, { ...size, colorScheme }, async page => {
                if (subject === "scan" && colorScheme === "light") await page.locator("input[value=none]").check();
                await tick(page, "trajectories", "ellipses");
                await toFigures(page);
                if (colorScheme === "light") return;
                const { x, y, width, height } = await page.locator("#source").boundingBox();
                await page.mouse.click(x + 0.45 * width, y + 0.55 * height);
            });
await screen("handles", "page_polygon", {}, async page => {
    await page.selectOption("#map", { label: "fundamental polygon" });
    await tick(page, "trajectories");
    await toFigures(page);
});

// With the first screen's picture as it has just been taken.
const readme = await browser.newPage({ viewport: { width: 1280, height: 1000 } });
await readme.goto(pathToFileURL(`${folder}/readme.html`).href);
await readme.screenshot({ path: `${pictures}/readme.png` });
await browser.close();
