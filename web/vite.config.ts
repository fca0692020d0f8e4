import { defineConfig } from "vitest/config";

/** Where `npm run dev` finds the Python server. */
const SERVER = "http://127.0.0.1:8765";

export default defineConfig({
  base: "./",
  build: {
    outDir: "../src/elbowroom/client",
    emptyOutDir: true,
    target: "es2022",
    license: { fileName: "licenses.md" },
    chunkSizeWarningLimit: 800,
    rolldownOptions: {
      output: {
        codeSplitting: {
          groups: [
            { name: "three", test: /node_modules[\\/]three[\\/]build/ },
            { name: "vrm", test: /node_modules[\\/]@pixiv/ },
          ],
        },
      },
    },
  },
  test: { testTimeout: 60_000 }, // machines are busy; no test is about time
  server: {
    proxy: {
      "/api": SERVER,
      "/ws": { target: SERVER.replace("http", "ws"), ws: true },
    },
  },
});
