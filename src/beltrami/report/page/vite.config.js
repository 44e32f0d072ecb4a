import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One file that a browser opens from anywhere, also from file://.
export default defineConfig({
    plugins: [viteSingleFile({ removeViteModuleLoader: true })],
    build: { target: "es2022", chunkSizeWarningLimit: 1000, license: false },
    logLevel: "warn",
});
