import { join } from "node:path";
import "../../src/inspection";
import { clean, openBrowser, Program, until, writeRecording } from "./program";
const out = "/tmp/f4pics";
const which = process.argv[process.argv.length - 1] ?? "all";
const program = new Program(["--scene", "four-plumes", "--seconds", "3600", ...(which === "hand" ? ["--hand", "page"] : [])]);
const browser = await openBrowser();
void writeRecording;
try {
  await program.start();
  for (const [w, h] of [[390, 844], [1024, 768], [1440, 900], [1920, 1080]] as const) {
    for (const theme of ["light", "dark"] as const) {
      const page = await browser.newPage({ viewport: { width: w, height: h }, colorScheme: theme });
      page.on("console", (m) => console.log(m.type(), m.text()));
      page.on("pageerror", (e) => console.log(String(e.stack)));
      await page.goto(`${program.address}/#picture=off`);
      await until(page, () => (window.prostm?.frames ?? 0) > 3, 0, "frames");
      await page.waitForTimeout(6000);
      if (which !== "hand") await until(page, () => (window.prostm.frame?.plan.length ?? 0) > 2 && window.prostm.frame!.numbers[24]! > 0.3, 0, "hand");
      await page.evaluate(() => { location.hash = "still"; });
      const drawn = await page.evaluate(() => window.prostm.pictures);
      await until(page, (n) => window.prostm.pictures > n + 2, drawn, "pictures", 60_000);
      await page.screenshot({ path: join(out, `${which}-${w}-${theme}.png`) });
      await page.close();
    }
  }
} finally {
  await browser.close();
  await program.stop();
  clean();
}
