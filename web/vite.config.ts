import { defineConfig } from "vite";

// The page is embedded into the program: few files, fixed and relative names, nothing from elsewhere.
export default defineConfig({
  base: "./",
  server: { host: "127.0.0.1" },  // a bare machine has no name for itself
  build: {
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1500,
    rollupOptions: {
      // the page of a run, and the two of a study
      input: ["index.html", "experimenter.html", "participant.html"],
      output: { entryFileNames: ({ name }) => (name === "index" ? "page.js" : "[name].js"), chunkFileNames: "[name].js", assetFileNames: "[name][extname]" },
    },
  },
});
