// What a page from elsewhere that is open in the same browser can do to `farsa serve`: link to its page, and nothing else.

import { createServer } from "node:http";

// A page that asks for what `served` serves in the ways that need no leave, eighty times, and has links to it. Chromium ends what
// is no picture by itself, but not a window.
const page = (served) => `<!DOCTYPE html><meta charset="utf-8"><title>elsewhere</title>
<a id="page" href="${served}">page</a> <a id="events" href="${served}events?from=0">events</a>
<script>
let answered = 0;
for (let i = 0; i < 80; i++) {
  const url = "${served}events?from=0&" + i, done = () => answered++;
  if (i % 4 === 0) Object.assign(new Image(), { onload: done, onerror: done }).src = url;
  else fetch(url, { mode: "no-cors" }).then(done, done);
}
</script>`;

// `served` is the address of a page of `farsa serve`, `check` is told what holds.
export async function elsewhere(browser, served, check) {
  const server = createServer((request, response) => {
    const found = new URL(request.url, "http://localhost").pathname === "/";
    response.writeHead(found ? 200 : 404, { "Content-Type": "text/html" }).end(found ? page(served) : "");
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  // Another host for a browser: another site than 127.0.0.1.
  const from = `http://localhost:${server.address().port}/`;
  try {
    await browser.go(from);
    // A browser asks few at a time, and the next when one of them has ended.
    await browser.until(() => answered === 80).catch(() => {});
    const count = await browser.run(() => answered);
    check("what a page from elsewhere asks for ends at once", count === 80, count);
    await browser.run(() => document.querySelector("#events").click());
    await browser.until(() => location.pathname === "/events" && document.readyState === "complete");
    const said = await browser.run(() => document.body.textContent);
    check("a link from elsewhere to events is refused", said === "only for pages of this address", said);
    await browser.go(from);
    await browser.run(() => document.querySelector("#page").click());
    await browser.until(() => window.farsa && (farsa.ready || farsa.error));
    check("a link from elsewhere opens the page", await browser.run(() => farsa.error === null && location.pathname === "/"));
  } finally {
    // What was refused was said on the console.
    await browser.log();
    server.closeAllConnections();
    server.close();
  }
}
