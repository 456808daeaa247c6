import { defineConfig } from "vitest/config";

export default defineConfig({
  server: { host: "127.0.0.1" },  // a bare machine has no name for itself
  test: { include: ["tests/unit/**/*.test.ts"], environment: "node" },
});
