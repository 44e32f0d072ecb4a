import { build, defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

const target = "es2022";

/// drawing.js with all that it imports, as a text of the page, which need not be compiled with it.
const drawing = {
    name: "drawing",
    async transformIndexHtml(html) {
        const [{ output: [{ code }] }] = await build({ configFile: false, logLevel: "warn",
            build: { target, write: false, chunkSizeWarningLimit: 1000, lib: { entry: "drawing.js", formats: ["iife"], name: "drawing" } } });
        return html.replace('id="drawing">', mark => mark + code.replaceAll("</script", "<\\/script"));
    },
};

// One file that a browser opens from anywhere, also from file://.
export default defineConfig({
    plugins: [drawing, viteSingleFile({ removeViteModuleLoader: true })],
    build: { target, chunkSizeWarningLimit: 1000, license: false },
    logLevel: "warn",
});
