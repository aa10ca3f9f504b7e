// A headless browser that browser.py drives: reads one JSON object a line, {op, ...}, and answers each by one line,
// {value} or {error}. Pages are numbered; each has a profile of its own.

import { createInterface } from "node:readline";
import puppeteer from "puppeteer-core";

const [executablePath] = process.argv.slice(2);
// WebGPU on the CPU (SwiftShader), also where the canvas is read back.
const args = [
  "--no-sandbox",
  "--enable-unsafe-webgpu",
  "--use-webgpu-adapter=swiftshader",
  "--enable-features=Vulkan",
  "--use-vulkan=swiftshader",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist",
];
const PATIENCE = 120_000; // milliseconds for one command, on a busy machine

const browser = await puppeteer.launch({ executablePath, args, headless: "shell", protocolTimeout: PATIENCE });
const pages = [];

const operations = {
  async open({ width, height, scale = 1, touch = false, media = {}, before = "" }) {
    const context = await browser.createBrowserContext();
    const page = await context.newPage();
    page.setDefaultTimeout(PATIENCE);
    await page.setViewport({ width, height, deviceScaleFactor: scale, hasTouch: touch, isMobile: touch });
    await page.emulateMediaFeatures(Object.entries(media).map(([name, value]) => ({ name, value })));
    if (before) await page.evaluateOnNewDocument(before);
    const reported = { console: [], errors: [], requests: [] };
    page.on("console", (message) => reported.console.push(`${message.type()}: ${message.text()}`));
    page.on("pageerror", (error) => reported.errors.push(String(error?.stack ?? error)));
    page.on("request", (request) => reported.requests.push(request.url()));
    return pages.push({ page, context, reported }) - 1;
  },
  goto: ({ page, url }) => page.goto(url, { waitUntil: "load" }).then((answer) => answer?.status() ?? 0),
  evaluate: ({ page, code }) => page.evaluate(code),
  wait: ({ page, code }) => page.waitForFunction(code, { polling: 50 }).then(() => true),
  press: ({ page, key }) => page.keyboard.press(key),
  down: ({ page, key }) => page.keyboard.down(key),
  up: ({ page, key }) => page.keyboard.up(key),
  click: ({ page, x, y }) => page.mouse.click(x, y),
  wheel: ({ page, by }) => page.mouse.wheel({ deltaY: by }),
  async drag({ page, from, to, button = "left" }) {
    await page.mouse.move(...from);
    await page.mouse.down({ button });
    await page.mouse.move(...to, { steps: 4 });
    await page.mouse.up({ button });
  },
  async pinch({ page, from, to }) {
    const touches = [];
    for (const [x, y] of from) touches.push(await page.touchscreen.touchStart(x, y));
    for (const [i, [x, y]] of to.entries()) await touches[i].move(x, y);
    for (const touch of touches) await touch.end();
  },
  async swipe({ page, from, to }) {
    const touch = await page.touchscreen.touchStart(...from);
    for (let step = 1; step <= 8; step++) {
      await touch.move(...from.map((at, axis) => at + ((to[axis] - at) * step) / 8));
      await new Promise((done) => setTimeout(done, 16));
    }
    await touch.end();
  },
  async choose({ page, code, files }) {
    const chooser = page.waitForFileChooser();
    await page.evaluate(code);
    await (await chooser).accept(files);
  },
  resize: ({ page, width, height, scale = 1 }) => page.setViewport({ width, height, deviceScaleFactor: scale }),
  screenshot: ({ page, path }) => page.screenshot({ path }).then(() => path),
  tree: ({ page }) => page.accessibility.snapshot(),
  reported: ({ reported }) => reported,
  close: ({ context }) => context.close(),
};

for await (const line of createInterface({ input: process.stdin })) {
  const { op, on, ...given } = JSON.parse(line);
  let answer;
  try {
    answer = { value: (await operations[op]({ ...given, ...pages[on] })) ?? null };
  } catch (error) {
    answer = { error: String(error?.stack ?? error) };
  }
  process.stdout.write(`${JSON.stringify(answer)}\n`);
}
await browser.close();
