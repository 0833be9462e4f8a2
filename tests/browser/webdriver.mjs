// As much of the W3C WebDriver protocol as the tests need, over fetch to chromedriver, or with BROWSER=firefox to geckodriver.

import { spawn } from "node:child_process";
import { accessSync, constants, mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { delimiter, join } from "node:path";
import { tmpdir } from "node:os";
import { setTimeout as sleep } from "node:timers/promises";

// A program's path: of the environment, of PATH, or where Debian puts it.
function find(variable, names) {
  if (process.env[variable]) return process.env[variable];
  for (const folder of [...(process.env.PATH || "").split(delimiter), "/usr/bin"]) {
    for (const name of names) {
      try {
        accessSync(join(folder, name), constants.X_OK);
        return join(folder, name);
      } catch {
        // Not here.
      }
    }
  }
  throw new Error(`${names.join(" or ")} not found: install a browser and its driver, or set ${variable}`);
}

function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

async function ask(url, method, body, limit = 60_000) {
  const headers = body ? { "Content-Type": "application/json" } : {};
  const answer = await fetch(url, { method, headers, body: body && JSON.stringify(body), signal: AbortSignal.timeout(limit) });
  const { value } = await answer.json();
  if (value?.error) throw new Error(`${value.error}: ${value.message.split("\n")[0]}`);
  return value;
}

export const isFirefox = process.env.BROWSER === "firefox";

// Starts the driver; `stop` ends it and everything it started.
export async function startDriver() {
  const port = await freePort();
  // A group of its own, so that no browser outlives it.
  const [program, args] = isFirefox
    ? [find("GECKODRIVER", ["geckodriver"]), [`--port=${port}`, "--log=error"]]
    : [find("CHROMEDRIVER", ["chromedriver"]), [`--port=${port}`, "--log-level=SEVERE"]];
  // Without a screen Firefox draws by EGL alone, and by Mesa's software.
  const env = { ...process.env, MOZ_WEBGL_FORCE_EGL: "1", LIBGL_ALWAYS_SOFTWARE: "1" };
  const child = spawn(program, args, { env, stdio: isFirefox ? ["ignore", "pipe", "pipe"] : "ignore", detached: true });
  // Firefox writes its console there, with words of its own parts; what it warns of is its own.
  const said = [];
  for (const stream of [child.stdout, child.stderr]) stream?.setEncoding("utf8").on("data", (text) => said.push(...text.split("\n").filter((line) => /^console\.(error|warn)|^JavaScript error: (file|http|blob)/.test(line) && !/resource:|RSLoader/.test(line))));
  const kill = () => {
    try {
      process.kill(-child.pid, "SIGKILL");
    } catch {
      // Gone already.
    }
  };
  process.on("exit", kill);
  for (const signal of ["SIGINT", "SIGTERM"]) process.on(signal, () => process.exit(1));
  const base = `http://127.0.0.1:${port}`;
  for (let tries = 0; ; tries++) {
    try {
      if ((await ask(`${base}/status`, "GET")).ready) break;
    } catch (error) {
      if (tries > 100) throw new Error(`${program} does not answer: ${error.message}`);
    }
    await sleep(100);
  }
  return { open: (options) => (isFirefox ? Firefox.open(base, { ...options, said }) : Browser.open(base, options)), stop: kill };
}

export class Browser {
  // `size` [width, height]; `phone`: with touch and a narrow screen; `flags`: more for chromium.
  static async open(base, { size = [1280, 800], phone = false, flags = [] } = {}) {
    const profile = mkdtempSync(join(tmpdir(), "farsa-browser-"));
    const options = {
      binary: find("CHROMIUM", ["chromium", "chromium-browser", "google-chrome"]),
      args: ["--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
        "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
        `--user-data-dir=${profile}`, `--window-size=${size}`, ...flags],
    };
    if (phone) {
      options.mobileEmulation = { deviceMetrics: { width: size[0], height: size[1], pixelRatio: 2, touch: true, mobile: true } };
    }
    const capabilities = { alwaysMatch: { browserName: "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": { browser: "ALL" } } };
    const { sessionId } = await ask(`${base}/session`, "POST", { capabilities });
    const browser = new Browser(`${base}/session/${sessionId}`, profile);
    await browser.post("timeouts", { script: 60_000, pageLoad: 120_000 });
    if (!phone) await browser.cdp("Emulation.setDeviceMetricsOverride", { width: size[0], height: size[1], deviceScaleFactor: 1, mobile: false });
    return browser;
  }

  constructor(url, profile) {
    Object.assign(this, { url, profile });
  }

  post(path, body) {
    return ask(`${this.url}/${path}`, "POST", body);
  }

  cdp(cmd, params = {}) {
    return this.post("goog/cdp/execute", { cmd, params });
  }

  // Of `prefers-color-scheme` and the like.
  media(features) {
    return this.cdp("Emulation.setEmulatedMedia", { features: Object.entries(features).map(([name, value]) => ({ name, value })) });
  }

  go(url) {
    return this.post("url", { url: String(url) });
  }

  // Runs a function in the page; the arguments and what it returns are JSON.
  run(script, ...args) {
    return this.post("execute/sync", { script: `return (${script})(...arguments)`, args });
  }

  // Waits until the function gives something true.
  async until(script, ...args) {
    const end = Date.now() + 240_000;
    for (;;) {
      const value = await this.run(script, ...args);
      if (value) return value;
      if (Date.now() > end) {
        const shown = await this.run(() => `${document.visibilityState} ${location.href} with ${document.activeElement?.outerHTML.slice(0, 100)}: ${document.body?.innerText.slice(0, 300)}`);
        throw new Error(`never true: ${script} on the ${shown.replace(/\s+/g, " ")}`);
      }
      await sleep(50);
    }
  }

  // Whatever the console said since the last call.
  async log() {
    return (await this.post("se/log", { type: "browser" })).map(({ level, message }) => `${level} ${message}`);
  }

  async screenshot() {
    return Buffer.from(await ask(`${this.url}/screenshot`, "GET"), "base64");
  }

  // Presses at a place and, if there are more places, drags through them.
  async drag(places, { touch = false, button = 0 } = {}) {
    const [first, ...rest] = places.map(([x, y]) => ({ type: "pointerMove", duration: 30, x: Math.round(x), y: Math.round(y) }));
    const actions = [first, { type: "pointerDown", button }, ...rest, { type: "pointerUp", button }];
    await this.post("actions", { actions: [{ type: "pointer", id: touch ? "finger" : "mouse", parameters: { pointerType: touch ? "touch" : "mouse" }, actions }] });
  }

  wheel(x, y, deltaY) {
    return this.post("actions", { actions: [{ type: "wheel", id: "wheel", actions: [{ type: "scroll", x: Math.round(x), y: Math.round(y), deltaX: 0, deltaY, duration: 50 }] }] });
  }

  // Keys by their WebDriver characters, while another one may be held.
  async keys(text, held = null) {
    const of = (type) => (held ? [{ type, value: held }] : []);
    const actions = [...of("keyDown"), ...[...text].flatMap((value) => [{ type: "keyDown", value }, { type: "keyUp", value }]), ...of("keyUp")];
    await this.post("actions", { actions: [{ type: "key", id: "keys", actions }] });
  }

  async close() {
    await ask(this.url, "DELETE").catch(() => {});
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

// Firefox has no emulation of screens and preferences: those of the session stay as they were when it began.
class Firefox extends Browser {
  static async open(base, { size = [1280, 800], said }) {
    const prefs = { "ui.systemUsesDarkTheme": 0, "ui.prefersReducedMotion": 1, "devtools.console.stdout.content": true, "webgl.force-enabled": true,
      "browser.download.alwaysOpenPanel": false, "browser.download.folderList": 2, "browser.download.dir": tmpdir() };
    const options = { binary: find("FIREFOX", ["firefox-esr", "firefox"]), args: ["-headless", "--kiosk"], prefs };
    const capabilities = { alwaysMatch: { browserName: "firefox", "moz:firefoxOptions": options } };
    const { sessionId } = await ask(`${base}/session`, "POST", { capabilities });
    const browser = Object.assign(new Firefox(`${base}/session/${sessionId}`, null), { said });
    await browser.post("timeouts", { script: 60_000, pageLoad: 120_000 });
    await browser.post("window/rect", { width: size[0], height: size[1] });
    return browser;
  }

  cdp() {
    throw new Error("Firefox has no DevTools protocol of Chromium");
  }

  async media() {}

  async log() {
    return this.said.splice(0);
  }

  async close() {
    await ask(this.url, "DELETE").catch(() => {});
  }
}

export const KEY = { backspace: "\uE003", enter: "\uE007", pageUp: "\uE00E", left: "\uE012", up: "\uE013", right: "\uE014", down: "\uE015", home: "\uE011", tab: "\uE004", end: "\uE010", escape: "\uE00C", shift: "\uE008" };
