import { defineConfig } from "vite";

// One JavaScript and one CSS file without hashes; scripts/place.mjs inlines them into viewer.html.
export default defineConfig({
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
  build: {
    target: "es2022",
    cssCodeSplit: false,
    modulePreload: false,
    rollupOptions: {
      output: {
        entryFileNames: "viewer.js",
        assetFileNames: "viewer[extname]",
        codeSplitting: false,
      },
    },
  },
  worker: { format: "iife" },
});
