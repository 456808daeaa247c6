/// Takes the screenshots for README and docs from the program itself: PROSTM=… npm run pictures -- FOLDER

import { join } from "node:path";
import "../../src/inspection";
import { clean, openBrowser, Program, until } from "./program";
import { comes, protocol, Study } from "./study";

const out = process.argv[process.argv.length - 1] ?? ".";
const kPictures = [
  { name: "page-light", theme: "light", study: false },
  { name: "page-dark", theme: "dark", study: false },
  { name: "page-gate", theme: "light", study: true },
] as const;

const browser = await openBrowser();

/// The participant's page while a stimulus is presented.
async function takeStudy(): Promise<void> {
  const study = new Study(protocol('[study]\ntitle = "One plume or four"\n[training]\nseconds = 0\n[trials]\ngate = "off"'), 1);
  try {
    await study.start();
    const size = { viewport: { width: 1000, height: 640 } };
    const [experimenter, participant] = [await browser.newPage(size), await browser.newPage(size)];
    await experimenter.goto(study.url);
    await participant.goto(`${study.url}participant`);
    await comes(experimenter, "ready");
    await experimenter.keyboard.press("Enter");
    await comes(participant, "presenting");
    await participant.screenshot({ path: join(out, "study-participant.png") });
    await experimenter.screenshot({ path: join(out, "study-experimenter.png") });
  } finally {
    await study.kill();
  }
}

try {
  await takeStudy();
  for (const { name, theme, study } of kPictures) {
    const program = new Program(["--scene", "four-plumes", "--seconds", "3600", ...(study ? ["--hand", "study"] : [])]);
    try {
      await program.start();
      const page = await browser.newPage({ viewport: { width: 1440, height: 900 }, colorScheme: theme });
      // without the picture the run keeps its rates meanwhile
      await page.goto(`${program.address}/#picture=off`);
      await until(page, () => (window.prostm?.frame?.hands.length ?? 0) > 0, 0, "a hand");
      // half a minute, so that the strips are full; then stop at the next moment with the open hand well in the
      // smoke, or with the gate passed
      await page.waitForTimeout(32_000);
      await until(page, (study) => {
        const { plan, numbers, hands, gate } = window.prostm.frame!;
        const tip = hands[0]?.joints.subarray(8 * 15, 8 * 15 + 3), palm = hands[0]?.joints;
        const open = tip !== undefined && palm !== undefined && Math.hypot(tip[0]! - palm[0]!, tip[1]! - palm[1]!, tip[2]! - palm[2]!) > 0.11;
        const pressed = open && plan.length === 4 && numbers[24]! > 0.08 && numbers[18]! > 0.92;
        const good = study ? gate?.passed === true : pressed;
        if (good) {
          const mode = document.querySelector<HTMLSelectElement>("#picture-mode")!;
          mode.value = "auto";
          mode.dispatchEvent(new Event("change"));
          location.hash = "still";
        }
        return good;
      }, study, "what the picture is to show", 180_000);
      const drawn = await page.evaluate(() => window.prostm.pictures);
      await until(page, (n) => window.prostm.pictures > n + 3, drawn, "pictures with every pixel", 180_000);
      await page.screenshot({ path: join(out, `${name}.png`) });
      await page.close();
    } finally {
      await program.stop();
    }
  }
} finally {
  await browser.close();
  clean();
}
