// The page: one clock, up to two lives in step, keys and fingers.
//
// For the console and for tests there is `farsa`; a life is given as itself, its index or its name:
//   ready, error              whether all is up; what is wrong, or null
//   lives, tick, ticks, time  the lives; the clock's present tick, how many it has, its time [s]
//   seek(tick), play(), pause(), playing, speed (may be set), show(life, beside?), setView("top" | "free"), view
// and, as recorded at the present tick:
//   pose(life, body): {position [m], rotation [x, y, z, w]}, value(life, channel, group?),
//   contacts(life): [{pair, point [m], force on the pair's first [N]}], project(position) [CSS pixels of the first view]
const farsa = window.farsa = {ready: false, error: null, lives: [], playing: false};

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const $ = (id) => document.getElementById(id);
const root = document.documentElement;
const theme = () => root.dataset.theme;
let colors = {};
const colorOf = (name) => colors[name] ??= getComputedStyle(root).getPropertyValue(name).trim();
const prefers = (what) => matchMedia(`(prefers-${what})`);
const short = (x, unit) => `${+x.toPrecision(2)} ${unit}`;
const length = (m) => (m < 1e-3 ? short(m*1e3, "mm") : m < 1 ? short(m*100, "cm") : short(m, "m"));
const options = (some) => some.map(([value, text]) => Object.assign(make("option", "", text), {value}));

function fail(text) {
	farsa.error = text;
	$("message").hidden = false;
	$("message").textContent = `This page cannot be shown: ${text}. Make it again with farsa replay --html.`;
}

function main() {
	const page = readPage($("data"));
	const {lives} = page;
	lives.forEach(survey);
	const camera = new Camera();
	camera.top = page.view === "top";
	const visible = {forces: true, rays: true, points: true, trails: camera.top};
	const views = [];
	let [shown, clock, tick, speed, asked, before] = [[lives[0]], lives[0], 0, 1, false, 0];

	const now = () => clock.timeAt(tick);
	const part = () => (now() - clock.times[0])/(clock.end - clock.times[0] || 1);
	// In step by time; a shorter life stands still at its end.
	const tickOf = (life) => (life === clock ? tick : life.tickAt(now()));
	const at = (life) => floor(tickOf(life));
	const strips = stripsOf((x) => go(round(clock.tickAt(clock.times[0] + x*(clock.end - clock.times[0])))));
	const graph = graphOf();

	function ask() {
		if (!asked) requestAnimationFrame(frame);
		asked = true;
	}

	function frame(time) {
		asked = false;
		if (farsa.playing) {
			// A page that was hidden goes on where it was.
			tick = clock.tickAt(now() + min(100, max(0, time - before))/1000*speed);
			before = time;
			if (tick >= clock.ticks - 1) pause();
			ask();
		}
		shown.forEach((life, i) => views[i].draw(life, tickOf(life), visible));
		const seconds = `${clock.times[floor(tick)].toFixed(2)} s`;
		$("slider").value = floor(tick);
		$("slider").setAttribute("aria-valuetext", seconds);
		$("clock").textContent = `${seconds} · tick ${floor(tick)} of ${clock.ticks - 1}`;
		strips.update(shown.map(tickOf), part(), farsa.playing);
		graph.update(at(shown[0]));
	}

	function seek(to) {
		tick = min(clock.ticks - 1, max(0, +to || 0));
		ask();
	}

	function play() {
		if (tick >= clock.ticks - 1) tick = 0;
		before = performance.now();
		farsa.playing = true;
		marks();
	}

	function pause() {
		// It stands on a tick: what is shown was recorded.
		tick = floor(tick);
		farsa.playing = false;
		marks();
	}

	const go = (to) => (pause(), seek(to));
	const step = (by) => go(floor(tick) + by);

	function setSpeed(to) {
		$("speed").value = speed = +to;
	}

	function marks() {
		$("play").classList.toggle("playing", farsa.playing);
		$("play").setAttribute("aria-label", farsa.playing ? "Pause" : "Play");
		for (const [name, on] of Object.entries({top: camera.top, ...visible})) $(name).setAttribute("aria-pressed", on);
		ask();
	}

	function setView(name) {
		camera.top = name === "top";
		marks();
	}

	function frameCamera() {
		const {clientWidth: w, clientHeight: h} = views[0].element;
		camera.frame(shown, w/h || 1.6);
		ask();
	}

	function change(name) {
		root.dataset.theme = name;
		colors = {};
		strips.resize();
		graph.layout();
		ask();
	}

	function showLives(a, b) {
		shown = [...new Set([a, b || a])];
		const two = shown.length > 1;
		const mark = (i) => (two ? `life-${i}` : "");
		clock = shown.reduce((x, y) => (y.end > x.end ? y : x));
		tick = min(tick, clock.ticks - 1);
		$("app").classList.toggle("two", two);
		shown.forEach((life, i) => (views[i] ??= viewOf(camera, ask)).set(life, mark(i)));
		if (views[1]) views[1].element.hidden = !two;
		$("life").value = a.index;
		$("beside").value = two ? b.index : "";
		$("slider").max = clock.ticks - 1;
		// Phases colour the slider's track.
		const words = a === clock && a.channels.find((c) => c.words);
		const percent = (t) => `${100*t/(a.ticks - 1 || 1)}%`;
		const stops = words ? runs(words.values).map(([from, to, color]) => `${color} ${percent(from)} ${percent(to)}`) : ["var(--line)", "var(--line)"];
		$("slider").style.setProperty("--track", `linear-gradient(90deg, ${stops}, ${stops.at(-1)})`);
		for (const name of ["forces", "rays", "points"]) $(name).hidden = !shown.some((life) => life.has[name]);
		strips.set(shown, min(...shown.map((l) => l.times[0])), clock.end);
		$("network").hidden = !a.network;
		if (a.network) graph.set(a);
		$("facts").replaceChildren(...shown.map((life, i) => make("div", "", make("h2", mark(i), life.name),
			make("dl", "", ...life.facts.flatMap(([name, text]) => [make("dt", "", name), make("dd", "", text)])),
			make("p", "soft", `Positions within ${length(life.position_unit/2)}, forces within ${short(life.force_unit/2, "N")} of what was recorded; channels: point at their names.`))), make("p", "soft", page.made_by || ""));
		frameCamera();
	}

	const find = (list, what, test) => {
		const i = list.findIndex(test);
		if (i < 0) throw new Error(`there is no ${what}`);
		return i;
	};
	const lifeOf = (which) => lives[find(lives, which, (life) => [life, life.index, life.name].includes(which))];
	const of = (act) => (which, ...rest) => act(lifeOf(which), ...rest);
	Object.defineProperties(farsa, {
		tick: {get: () => floor(tick)}, time: {get: now}, ticks: {get: () => clock.ticks},
		view: {get: () => (camera.top ? "top" : "free")}, speed: {get: () => speed, set: setSpeed},
	});
	Object.assign(farsa, {
		lives, seek, play, pause, setView,
		show: of((life, other) => showLives(life, other == null ? null : lifeOf(other))),
		pose: of((life, body) => life.pose(at(life), find(life.bodies, body, (b) => b === body))),
		value: of((life, name, group) => life.channels[find(life.channels, name, (c) => c.name === name && [c.group, undefined].includes(group))].values[at(life)]),
		contacts: of((life) => life.contacts(at(life))),
		project: (p) => views[0].project(p),
	});

	const names = lives.map((life) => [life.index, life.name]);
	$("title").textContent = page.title;
	$("life").replaceChildren(...options(names));
	$("beside").replaceChildren(...options([["", "none"], ...names]));
	$("life").parentNode.hidden = $("beside").parentNode.hidden = lives.length < 2;
	$("speed").replaceChildren(...options(SPEEDS.map((s) => [s, `${s}×`])));
	setSpeed(1);
	$("life").onchange = $("beside").onchange = () => showLives(lives[$("life").value], lives[$("beside").value]);
	$("speed").onchange = () => setSpeed($("speed").value);
	$("slider").oninput = () => go($("slider").value);

	const faster = (by) => [() => setSpeed(SPEEDS[SPEEDS.indexOf(speed) + by] || speed)];
	const toggle = (name) => [() => {
		visible[name] = !visible[name];
		marks();
	}, name];
	// By key; a button has the id that follows.
	const acts = {
		" ": [() => (farsa.playing ? pause() : play()), "play"], Home: [() => go(0), "first"], End: [() => go(Infinity), "last"],
		ArrowLeft: [(event) => step(event.shiftKey ? -10 : -1), "back"], ArrowRight: [(event) => step(event.shiftKey ? 10 : 1), "forward"],
		"+": faster(1), "-": faster(-1), t: [() => setView(camera.top ? "free" : "top"), "top"],
		f: toggle("forces"), y: toggle("rays"), p: toggle("points"), r: toggle("trails"),
		c: [frameCamera, "frame"], d: [() => change(theme() === "dark" ? "light" : "dark"), "theme"], "?": [() => $("keys").showModal(), "help"],
	};
	for (const [act, id] of Object.values(acts)) {
		if (!id) continue;
		$(id).onclick = (event) => {
			act(event);
			// After a mouse the space bar shall play again.
			if (event.detail) $(id).blur();
		};
	}
	document.onkeydown = (event) => {
		const {target, key} = event;
		const busy = target.matches("select") || (key === " " && target.matches("button")) || $("keys").open;
		if (busy || event.ctrlKey || event.metaKey || event.altKey || !acts[key]) return;
		event.preventDefault();
		acts[key][0](event);
	};
	const dark = prefers("color-scheme: dark");
	(dark.onchange = () => change(dark.matches ? "dark" : "light"))();

	$("app").hidden = false;
	showLives(lives[0]);
	marks();
	$("message").hidden = true;
	farsa.ready = true;
	if (!prefers("reduced-motion: reduce").matches) play();
}

// A picture with labels, to be moved with mouse and fingers.
function viewOf(camera, ask) {
	const [canvas, labels, caption, note] = [make("canvas", "scene"), make("div", "labels"), make("figcaption"), make("span", "soft")];
	const element = make("figure", "", canvas, labels, caption);
	$("views").append(element);
	let scene;
	try {
		scene = sceneOn(canvas, ask);
	} catch (error) {
		element.append(make("p", "none", `No 3D picture: this browser offers no WebGL 2 (${error.message}). All else works.`));
	}
	const size = () => {
		const [width, height] = [element.clientWidth, element.clientHeight].map((x) => max(1, round(x*min(2, devicePixelRatio))));
		if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
		ask();
	};
	new ResizeObserver(size).observe(element);

	function set(life, mark) {
		canvas.setAttribute("aria-label", `Scene of ${life.name}`);
		caption.replaceChildren(make("b", mark, life.name), make("div", "", note, ` ${life.facts.slice(0, 2).map((fact) => fact.join(" ")).join(" · ")}`));
		labels.replaceChildren(...life.points.map((name) => make("span", "", name)));
		size();
	}

	function draw(life, tick, visible) {
		if (!scene) return;
		scene.draw(life, tick, camera, visible);
		life.points.forEach((_, p) => {
			const at = visible.points && scene.project(life.point(tick, p));
			labels.children[p].hidden = !at;
			if (at) labels.children[p].style.transform = `translate(${at[0]*element.clientWidth + 9}px, ${at[1]*element.clientHeight - 20 + 15*p}px)`;
		});
		const {long, newtons} = camera.arrow();
		note.textContent = [
			life.has.forces && visible.forces ? `arrow of ${length(long)}: ${short(newtons, "N")}` : "",
			visible.trails ? `trails: ${life.trails.map((trail) => trail.name).join(", ") || "nothing moves"}` : "",
			tick >= life.ticks - 1 ? "ended" : "",
		].filter(Boolean).join(" · ");
	}

	function project(p) {
		const place = scene?.project(p);
		const box = canvas.getBoundingClientRect();
		return place && {x: box.left + place[0]*box.width, y: box.top + place[1]*box.height};
	}

	const fingers = new Map();
	canvas.onpointerdown = (event) => {
		fingers.set(event.pointerId, event);
		canvas.setPointerCapture(event.pointerId);
	};
	canvas.onpointerup = canvas.onpointercancel = (event) => fingers.delete(event.pointerId);
	canvas.oncontextmenu = (event) => event.preventDefault();
	canvas.onpointermove = (event) => {
		const last = fingers.get(event.pointerId);
		if (!last) return;
		const height = canvas.clientHeight;
		const [dx, dy] = [event.clientX - last.clientX, event.clientY - last.clientY];
		const other = [...fingers.values()].find((f) => f.pointerId !== event.pointerId);
		if (other) {
			const gap = (f) => hypot(f.clientX - other.clientX, f.clientY - other.clientY) || 1;
			camera.zoom(gap(last)/gap(event));
			// Each finger moves the picture by its half.
			camera.pan(dx/2/height, dy/2/height);
		} else if (camera.top || event.shiftKey || event.buttons & 6) camera.pan(dx/height, dy/height);
		else camera.turn(dx, dy);
		fingers.set(event.pointerId, event);
		ask();
	};
	canvas.addEventListener("wheel", (event) => {
		event.preventDefault();
		camera.zoom(Math.exp(event.deltaY*(event.deltaMode ? 0.02 : 0.0012)));
		ask();
	}, {passive: false});
	return {element, set, draw, project};
}

window.onerror = (message) => fail(`the viewer failed (${message})`);
document.addEventListener("DOMContentLoaded", () => {
	try {
		main();
	} catch (error) {
		fail(error instanceof Damage ? error.message : `the viewer failed (${error.message})`);
	}
});
