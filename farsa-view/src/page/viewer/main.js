// The page: its console, its choices and its keys.
//
// The console and tests use `farsa`. A trial is given as an object, its index or its name:
//   ready, error              true when the page is complete, and the error or null
//   first                     the time of the first picture [ms]
//   trials, tick, ticks, time  the trials, and tick, number of ticks and time [s] of the clock
//   seek(tick), play(), pause(), playing, speed (may be set), show(trial, beside?), follow(body or ""), view: "top" or "free",
//   setView("top" | "free" | "front" ...)
// and recorded values of the present tick:
//   pose(trial, body): {position [m], rotation [x, y, z, w]}, value(trial, channel, group?),
//   image(trial, name): {columns, rows, colors: red, green, blue, opacity of each pixel, or null},
//   contacts(trial): [{pair, point [m], force on the pair's first [N]}], project(position) [CSS pixels of the first view]
const farsa = window.farsa = {ready: false, error: null, trials: [], playing: false};

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const $ = (id) => document.getElementById(id);
const root = document.documentElement;
const theme = () => root.dataset.theme;
let colors = {};
const colorOf = (name) => colors[name] ??= getComputedStyle(root).getPropertyValue(name).trim();
const short = (x, unit) => `${+x.toPrecision(2)} ${unit}`;
const length = (m) => (m < 1e-3 ? short(m*1e3, "mm") : m < 1 ? short(m*100, "cm") : short(m, "m"));
const entitled = (one, name) => (one.setAttribute("aria-label", name), one);
const setPressed = (one, on) => one.setAttribute("aria-pressed", on);
const isPressed = (one) => one.getAttribute("aria-pressed") === "true";
const options = (some) => some.map(([value, text]) => assign(make("option", "", text), {value}));

function fail(text, remedy = " Make it again with farsa replay --html.") {
	farsa.error = text;
	$("app").hidden ||= !farsa.ready;
	$("message").hidden = false;
	$("message").textContent = `This page cannot be shown: ${text}.${remedy}`;
}

// Shows a message above the page.
function warn(text) {
	$("message").hidden = false;
	$("message").textContent = text;
}

// The functions for the console and tests.
function openConsole(player, trials) {
	const find = (list, what, test) => {
		const i = list.findIndex(test);
		if (i < 0) throw new Error(`there is no ${what}`);
		return i;
	};
	const trialOf = (which) => trials[find(trials, which, (trial) => [trial, trial.index, trial.name].includes(which))];
	const of = (act) => (which, ...rest) => act(trialOf(which), ...rest);
	Object.defineProperties(farsa, {
		tick: {get: () => floor(player.tick)}, time: {get: () => player.now}, ticks: {get: () => player.clock.ticks},
		view: {get: () => (player.camera.top ? "top" : "free")}, speed: {get: () => player.speed, set: (to) => player.setSpeed(to)},
	});
	assign(farsa, {
		trials,
		seek: (to) => player.seek(to), play: () => player.play(), pause: () => player.pause(), setView: (name) => player.setView(name), follow: (name) => player.follow(name),
		show: of((trial, other) => player.show(trial, other == null ? null : trialOf(other))),
		pose: of((trial, body) => trial.pose(player.at(trial), find(trial.bodies, body, (b) => b === body))),
		value: of((trial, name, group) => trial.channels[find(trial.channels, name, (c) => c.name === name && [c.group, undefined].includes(group))].values[player.at(trial)]),
		image: of((trial, name) => {
			const i = find(trial.images, name, (image) => image.name === name);
			const {columns, rows} = trial.images[i];
			return {columns, rows, colors: trial.image(player.at(trial), i)};
		}),
		contacts: of((trial) => trial.contacts(player.at(trial))),
		project: (p) => player.views[0].project(p),
	});
}

// The trials, the speed and the slider.
function offer(player, trials) {
	const names = trials.map((trial) => [trial.index, trial.name]);
	$("trial").replaceChildren(...options(names));
	$("beside").replaceChildren(...options([["", "none"], ...names]));
	$("trial").parentNode.hidden = $("beside").parentNode.hidden = trials.length < 2;
	$("speed").replaceChildren(...options(SPEEDS.map((s) => [s, `${s}×`])));
	player.setSpeed(1);
	$("trial").onchange = $("beside").onchange = () => player.show(trials[$("trial").value], trials[$("beside").value]);
	$("speed").onchange = () => player.setSpeed($("speed").value);
	$("camera").onchange = () => player.setView($("camera").value);
	$("follow").onchange = () => player.follow($("follow").value);
	$("slider").oninput = () => player.go($("slider").value);
}

// Actions by key, with the id of their button.
function actsOf(player) {
	const toggle = (name) => [() => player.toggle(name), name];
	return {
		" ": [() => (farsa.playing ? player.pause() : player.play()), "play"],
		Home: [() => player.go(0), "first"], End: [() => player.go(Infinity), "last"],
		ArrowLeft: [(event) => player.step(event.shiftKey ? -10 : -1), "back"], ArrowRight: [(event) => player.step(event.shiftKey ? 10 : 1), "forward"],
		"+": [() => player.faster(1)], "-": [() => player.faster(-1)],
		t: [() => player.setView(player.camera.top ? "overview" : "top")],
		f: toggle("forces"), y: toggle("rays"), p: toggle("points"), r: toggle("trails"),
		c: [() => player.frameCamera(), "frame"], v: [() => player.record(), "record"], l: [() => player.link(), "link"], d: [() => player.setTheme(theme() === "dark" ? "light" : "dark"), "theme"],
		"?": [() => $("keys").showModal(), "help"],
	};
}

function listen(acts) {
	for (const [act, id] of Object.values(acts)) {
		if (!id) continue;
		$(id).onclick = (event) => {
			act(event);
			// After a click the space bar plays again.
			if (event.detail) $(id).blur();
		};
	}
	document.onkeydown = (event) => {
		const {target, key} = event;
		const busy = target.matches("select, input:not([type=range])") || (key === " " && target.matches("button")) || $("keys").open;
		if (busy || event.ctrlKey || event.metaKey || event.altKey || !acts[key]) return;
		event.preventDefault();
		acts[key][0](event);
	};
}

// Waits until a picture is visible: it is drawn for the next frame and on the screen by the third. A hidden page draws nothing, and
// neither does a page in a frame out of view, which does not know that it is. These wait for three seconds.
const seen = () => new Promise((done) => {
	setTimeout(done, 3e3);
	const frames = (n) => (n ? requestAnimationFrame(() => frames(n - 1)) : done());
	frames(3);
});

// The moment in the address, such as `#trial=1&t=2.0`.
const momentOf = () => fromEntries(new URLSearchParams(location.hash.slice(1)));

// Shows the moment in the address. Returns false if there is none.
async function visit(player) {
	const moment = momentOf();
	const {trial, t} = moment;
	if (!farsa.error) $("message").hidden = true;
	if (trial !== undefined && !(await player.choose(moment))) warn(`The address names trial ${trial}, which this page does not hold.`);
	else if (t !== undefined && !(+t >= 0)) warn(`The address names the time ${t}, which is no number of seconds.`);
	else if (t !== undefined) player.go(round(player.clock.tickAt(+t)));
	return t !== undefined;
}

async function main() {
	const page = readPage($("data"));
	const {trials} = page;
	trials.forEach((trial) => survey(trial, page.view === "top"));
	const begun = page.live && liveOf(page);
	const player = new Player(page);
	openConsole(player, trials);
	$("title").textContent = page.title;
	$("record").hidden = !window.MediaRecorder;
	const dark = matchMedia("(prefers-color-scheme: dark)");
	(dark.onchange = () => player.setTheme(dark.matches ? "dark" : "light"))();
	$("app").hidden = false;
	// The page is complete. A starting worker is no error.
	$("message").hidden = true;
	player.open(1);

	const attach = await begun;
	offer(player, trials);
	listen(actsOf(player));
	player.place(trials[0], trials[page.beside]);
	const whole = attach?.(player);
	await seen();
	// The parts below the scene follow.
	farsa.first = performance.now();
	if (whole) await whole();
	else player.fill();
	farsa.ready = true;
	const visited = await visit(player);
	onhashchange = () => visit(player);
	if (!visited) player.replay();
}

onerror = (message) => fail(`the viewer failed (${message})`);
document.addEventListener("DOMContentLoaded", () => {
	main().catch((error) => {
		if (error instanceof Unsupported) fail(error.message, "");
		else fail(error instanceof Damage ? error.message : `the viewer failed (${error.message})`);
	});
});
