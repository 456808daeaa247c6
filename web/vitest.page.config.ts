import { defineConfig } from "vitest/config";

// drives a browser against the program that PROSTM names; one after the other, since both want the processor
export default defineConfig({
  test: { include: ["tests/page/**/*.test.ts"], environment: "node", fileParallelism: false, testTimeout: 60_000, hookTimeout: 60_000 },
});
