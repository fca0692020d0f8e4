import { fileURLToPath } from "node:url";
import { defineConfig, type Plugin } from "vite";

/** In place of the decoders that are fetched when they are needed: one that is small, and there. */
const smallDecoders: Plugin = {
  name: "small-decoders",
  enforce: "pre",
  resolveId: (source) => (source.endsWith("/decoders") ? fileURLToPath(new URL("src/standalone/meshopt_only.ts", import.meta.url)) : null),
};

/** The player of pages that hold one run: one script and one style sheet, with all that they need in them. */
export default defineConfig({
  plugins: [smallDecoders],
  define: { "process.env.NODE_ENV": '"production"' },
  publicDir: false,
  build: {
    outDir: "../src/elbowroom/client/player",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 1500,
    lib: {
      entry: "src/standalone/main.ts", formats: ["iife"], name: "elbowroomPlayer",
      fileName: () => "player.js", cssFileName: "player",
    },
  },
});
