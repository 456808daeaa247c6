import { defineConfig } from "vitest/config";

// drives a browser against the program that PROSTM names; one after the other, since both want the processor
export default defineConfig({
  server: { host: "127.0.0.1" },  // a bare machine has no name for itself
  test: {
    include: ["tests/page/**/*.test.ts"], environment: "node", fileParallelism: false, testTimeout: 60_000, hookTimeout: 60_000,
    expect: { poll: { timeout: 10_000 } },  // pictures that the processor draws are seconds apart
  },
});
