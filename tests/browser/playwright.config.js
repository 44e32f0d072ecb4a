import { defineConfig } from "@playwright/test";

// The system's Chromium, without a graphics card: WebGL in software.
export default defineConfig({
    testDir: ".",
    workers: 1,
    timeout: 90_000,
    reporter: "list",
    use: {
        viewport: { width: 1300, height: 1000 },
        launchOptions: {
            executablePath: process.env.BELTRAMI_CHROMIUM,
            args: ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"],
        },
    },
});
