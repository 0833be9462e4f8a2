// An agent whose trials are run in the page, by a WebAssembly module in a worker, intact and with changes.

// The worker, which answers requests in order. It is passed as text, together with the functions for unpacking only.
function inWorker() {
	let module, last = Promise.resolve();
	// Opens a session as a function that answers requests.
	const opened = (script) => {
		const own = new WebAssembly.Instance(module, {}).exports;
		const said = (length) => new TextDecoder().decode(new Uint8Array(own.memory.buffer, own.output(), length));
		const give = (text) => {
			const bytes = new TextEncoder().encode(text);
			const at = own.input(bytes.length);
			new Uint8Array(own.memory.buffer, at, bytes.length).set(bytes);
		};
		give(JSON.stringify(script));
		const wrong = said(own.open());
		if (wrong) throw new Error(wrong);
		return (request) => (give(JSON.stringify(request)), JSON.parse(said(own.answer())));
	};
	const acts = {
		async compile({packed}) {
			const headers = {"Content-Type": "application/wasm"};
			const refused = (error) => {
				throw new Error(`the page's module cannot be unpacked or compiled (${error.message})`);
			};
			return module = await WebAssembly.compileStreaming(new Response(unpacked(packed), {headers})).catch(refused);
		},
		take: (rest) => void ({module} = rest),
		open: ({script}) => void Object.assign(acts, {script, session: opened(script), changed: null}),
		// The session of a request: the run's, or one with the same individuals and another configuration.
		of({request, config}) {
			if (request.do === "add") {
				acts.script.individuals.push(request.individual);
				acts.changed = null;
			}
			if (!config) return acts.session(request);
			if (acts.changed?.config !== config) acts.changed = {config, answer: opened({...acts.script, config})};
			return acts.changed.answer(request);
		},
		// Opens a temporary session.
		once: ({script, request}) => opened(script)(request),
		ask: (given) => acts.of(given),
		// The ticks in each phase and the bodies at the first tick.
		brief(given) {
			const {film, success, fitness, error} = acts.of(given);
			if (error) return {error};
			const {ticks, bodies, channels, blocks, position_origin: origin, position_unit: unit} = film;
			const {buffer} = bytesOf(film.data);
			const [values, times] = [new Uint16Array(buffer, 0, buffer.byteLength >> 1), new Float32Array(buffer, blocks.times, ticks)];
			const at = channels.findIndex((channel) => channel.words && channel.group === "phase");
			const {words = [], minimum} = channels[at] ?? {};
			const counts = words.map(() => 0);
			for (let t = 0; words[0] && t < ticks; t++) counts[minimum + values[blocks.channels/2 + at*ticks + t]]++;
			const starts = bodies.map((_, body) => [0, 1, 2].map((i) => origin[i] + unit*values[blocks.poses/2 + 7*body + i]));
			return {success, fitness, bodies, starts, words, counts, step: ticks > 1 ? (times[ticks - 1] - times[0])/(ticks - 1) : times[0]};
		},
		// Without the recording.
		earned(given) {
			const {success, fitness, error} = acts.of(given);
			return {success, fitness, error};
		},
	};
	onmessage = ({data: {id, act, ...rest}}) => {
		last = last.then(() => acts[act](rest)).then((found) => postMessage({id, found}), (error) => postMessage({id, error: error.message}));
	};
}

// Decompresses base64 of gzip, as a stream.
const unpacked = (text) => new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("gzip"));

// Creates a worker. `send` returns its answers in order.
function worker() {
	const worker = new Worker(URL.createObjectURL(new Blob([`"use strict";${bytesOf}const unpacked=${unpacked};(${inWorker})()`], {type: "text/javascript"})));
	const waiting = new Map();
	worker.onmessage = ({data: {id, found, error}}) => {
		const [done, failed] = waiting.get(id);
		waiting.delete(id);
		const wrong = error || found?.error;
		if (wrong) failed(new Error(wrong));
		else done(found);
	};
	let next = 0;
	return (act, rest) => new Promise((done, failed) => {
		waiting.set(next, [done, failed]);
		worker.postMessage({id: next++, act, ...rest});
	});
}

// The first worker starts while the page's data are still being read.
const capable = window.WebAssembly && window.Worker && window.DecompressionStream;
const firstWorker = capable && worker();

// An agent in another worker.
async function agentOf(module, script) {
	const send = worker();
	send("take", {module});
	await send("open", {script});
	return {ask: (request) => send("ask", {request})};
}

// The answer of the first worker, with `act` "earned" without a recording, under another configuration if one is given.
const answerOf = ({config, ...request}, act = "ask") => firstWorker(act, {request, config});

// The trial of an answer for the player.
function trialOf(page, {film}, index, pushes = []) {
	const trial = assign(new Trial(film, index), {pushes, changed: index > 0});
	survey(trial, page.view === "top");
	return trial;
}

// The script with trials of one step, or null if it does not set their number.
function shortened(script) {
	const config = script.config.replace(/(\n\[trial\]\n(?:[^[].*\n)*?steps = )\d+/, (_, before) => `${before}1`);
	return config === script.config ? null : {...script, config};
}

// Runs the first trial of a live page, and first only its first step if possible. Returns a function that attaches the panel to
// the player, which then shows the whole trial.
async function liveOf(page) {
	if (!capable) throw new Unsupported("it needs a browser with WebAssembly");
	const {live: {module: packed, script, about: {individuals}}} = page;
	// The best trial of the run is shown first.
	// A trial that broke down has no fitness.
	const earned = individuals.at(-1).trials.map(({fitness}) => fitness ?? -Infinity);
	const best = max(0, earned.indexOf(max(...earned)));
	// Changes in the address follow when the whole trial is shown.
	const last = individuals.length - 1;
	const state = {individual: last, newest: last, trial: {number: best}, ...heldBy(momentOf(), page.live.about, last), changes: new Map(), settings: new Map(), moves: [], pushes: [], watched: null};
	const request = {do: "film", ...asked(state), lesion: ""};
	const module = firstWorker("compile", {packed}).catch((error) => {
		// A function that returns a vector.
		throw WebAssembly.validate(bytesOf("AGFzbQEAAAABBQFgAAF7AwIBAAoKAQgAQQD9D/1iCw==")) ? error : new Unsupported("it needs a browser with SIMD in WebAssembly");
	});
	const short = shortened(script);
	const begun = short && firstWorker("once", {script: short, request}).catch(() => {});
	const opened = Promise.all([module, firstWorker("open", {script})]);
	let answer = null;
	const whole = () => answer ??= opened.then(() => answerOf(request));
	page.trials.push(trialOf(page, await begun ?? await whole(), 0));
	const open = async (standing) => agentOf(await module, {...script, standing});
	return (player) => attach(page, state, whole, player, open);
}

// The trial of a name in the address: a number of the run, or `fresh-` and a number.
function trialNamed(name, {trials}) {
	const [, fresh, number] = /^(fresh-)?(\d{1,9})$/.exec(name) ?? [];
	return fresh ? {fresh: {number: +number, seed: 1}} : number < trials ? {number: +number} : null;
}

// The agent, trial and changes of an address, or null if the page does not hold them.
function heldBy({trial: name, agent, change = "", set = ""}, about, last) {
	const [individual, trial] = [+(agent ?? last), trialNamed(name, about)];
	const changes = new Map(change.split(",").filter(Boolean).map((part) => [...part.split("="), ""].slice(0, 2)));
	const settings = new Map(set.split(";").filter(Boolean).map((part) => [part.split("=")[0], part.slice(part.indexOf("=") + 1)]));
	return trial && about.individuals[individual] ? {individual, trial, changes, settings} : null;
}

const asked = ({individual, trial, watched}) => ({individual, trial, watched});
// As `farsa test --lesion` takes it.
const listOf = ({changes}) => [...changes].map(([part, value]) => (value === "" ? part : `${part}=${value}`)).join(",");
// The configuration with the changed settings.
const configOf = ({live: {script: {config}}}, {settings}) => configWith(config, settingsOf(config), settings);
const bare = (title) => title.replace(/ \[[^\]]*\]$/, "");
const KINDS = ["sensor", "neuron", "output"];

// The name of a node or link in a list of changes.
function partOf(chosen) {
	const name = ({layer, name}) => `${KINDS[layer]} ${bare(name)}`;
	if (chosen.direct) return partOf(chosen.from);
	return chosen.links ? `${KINDS[chosen.layer]}:${bare(chosen.name)}` : `link:${name(chosen.from)}-${name(chosen.to)}`;
}

// Describes the first difference between the page's trial and the run's.
function compared({digests}, {stride, digests: run}) {
	const own = digests.filter((_, t) => (t + 1)%stride === 0 || t === digests.length - 1);
	const at = run.findIndex((digest, i) => digest !== own[i]);
	if (at < 0 && own.length === run.length) return `Equal to the run, bit by bit: ${digests.length} ticks, digest ${digests.at(-1).toString(16).padStart(8, "0")}`;
	return `Differs from the run within ${stride} ticks from tick ${max(0, (at < 0 ? run.length : at)*stride)}`;
}

function verdictOf({fresh, number}, {trials}, answer) {
	if (fresh) return "A fresh start is no trial of the run";
	return trials[number] ? compared(answer, trials[number]) : "The run has no trial of an individual of this page";
}

const button = (text, act = null) => assign(make("button", "", text), {onclick: act});
const earnedBy = ({fitness, success}) => fitness === null ? "broken down" : `${success === null ? "fitness " : success ? "success, " : "no success, "}${+fitness.toPrecision(4)}`;

function pick(label, some, act) {
	const list = entitled(make("select", "", ...options(some)), label);
	list.onchange = () => act(list.value);
	return list;
}

// Creates the panel with its controls.
function controlsOf({live: {about: {robots}}}, acts) {
	const value = entitled(assign(make("input"), {type: "number", step: "any", placeholder: "value"}), "Value");
	const own = {
		generation: pick("Generation", [], (place) => acts.change({individual: +place})),
		trial: pick("Trial that is run", [], (number) => number !== "" && acts.change({trial: {number: +number}})),
		robot: pick("Robot that is recorded", [], (robot) => acts.change({watched: robot === "" ? null : +robot})),
		fresh: button("New start", acts.fresh), random: button("Random genome", acts.random), value, part: make("b"), parts: pick("Part", [["", "part ..."]], acts.choose),
		apply: button("Change", () => acts.alter(value.value)), cut: button("Silence or cut", () => acts.alter("")),
		noise: button("Noise 0.1", () => acts.set("noise:0.1", "")), undo: button("Undo all", acts.undo),
		move: assign(button("Move bodies"), {disabled: true}), push: assign(button("Push bodies"), {disabled: true}), body: pick("Body that keys move or push", [], null),
		chips: make("p", "chips"), hundred: button("100 fresh trials", acts.test), behavior: button("Behavior", () => acts.summarize(100)), summary: make("div"), verify: button("Verify", acts.verify),
		configuration: make("pre"), earned: make("p"), status: make("p", "soft"),
	};
	const bar = (...names) => make("div", "bar", ...names.map((name) => own[name]));
	const panel = make("section", "", make("h2", "", "Live"), bar("generation", "trial", "robot", "fresh", "random"), make("p", "", "Change: ", own.part),
		bar("parts", "value", "apply", "cut"), bar("noise", "move", "push", "body", "undo"), own.chips, bar("hundred", "behavior", "verify"), own.earned, own.status, own.summary,
		acts.form.element, make("details", "", make("summary", "", "Configuration"), own.configuration));
	panel.id = "live";
	own.status.setAttribute("role", "status");
	own.behavior.title = "Time in each phase and success by start, in 100 fresh trials";
	own.summary.id = "summary";
	own.robot.replaceChildren(...options([["", "robot ..."], ...robots.map((name, i) => [i, name])]));
	own.robot.hidden = !robots[1];
	$("network").before(panel);
	return own;
}

// Formats a number of successes with the number of trials that broke down. Without any other trial, or without a criterion of
// success, there is no share.
function shareOf(successes, failed, of) {
	if (failed === of) return `all ${of} broke down`;
	return `${successes === null ? "no criterion of success" : `${successes} of ${of}`}${failed ? `, ${failed} broke down` : ""}`;
}

// Counts successes in a hundred fresh trials, intact and with changes, and caches them in `counted`. Ten are run in parallel, but
// with moved or pushed bodies each is run alone.
async function hundred(individual, changed, counted, say) {
	const found = [];
	const text = [];
	for (const change of changed ? [{lesion: ""}, changed] : [{lesion: ""}]) {
		const {lesion, moves, pushes} = change;
		const [key, whose] = [`${individual} ${JSON.stringify(change)}`, change === changed ? "with the change" : "intact"];
		const by = moves?.[0] || pushes?.[0] ? 1 : 10;
		for (let first = 0, successes = 0, failed = 0; !counted.has(key); first += by) {
			const request = by > 1 ? {do: "fresh", individual, lesion, config: change.config, seed: 1, first, count: by}
				: {do: "film", individual, trial: {fresh: {number: first, seed: 1}}, ...change};
			const answer = await answerOf(request, by > 1 ? undefined : "earned");
			const more = by > 1 ? answer.successes : answer.success;
			successes = more === null ? null : successes + more;
			failed += [answer.fitness].flat().filter((fitness) => fitness === null).length;
			say([...text, `${whose}: ${shareOf(successes, failed, first + by)} ...`].join("; "));
			if (first + by === 100) counted.set(key, [successes, failed]);
		}
		const [successes, failed] = counted.get(key);
		found.push(successes);
		text.push(`${whose}: ${shareOf(successes, failed, 100)}`);
	}
	say(text.join("; "));
	return found;
}

// Offers the parts of a controller, if it has any.
function offerParts(own, kinds) {
	const some = kinds.filter(({kind}) => kind !== "link").flatMap(({kind, names}) => names.map((name) => [`${kind}:${name}`, `${kind} ${name}`]));
	own.parts.replaceChildren(...options([["", "part ..."], ...some]));
	for (const one of [own.parts, own.apply, own.cut, own.noise, own.value, own.part.parentNode]) one.hidden = !kinds.length;
}

// The buttons that undo a change.
function chipsOf(state, show) {
	const chips = (kind) => [...state[kind]].map(([name, to]) => button(`${name}${to && ` = ${to}`} ×`, () => {
		state[kind] = new Map([...state[kind]].filter(([other]) => other !== name));
		show();
	}));
	const hands = ["moves", "pushes"].flatMap((kind) => state[kind].map((one) => button(`${one.what} at ${one.time.toFixed(2)} s ×`, () => (state[kind] = state[kind].filter((other) => other !== one), show()))));
	return [...chips("changes"), ...chips("settings"), ...hands];
}

const isHandled = ({moves, pushes}) => moves[0] || pushes[0];
const untold = ({what, time, ...rest}) => rest;
// The moves and pushes as a request has them.
const handsOf = ({moves, pushes}) => ({moves: moves.map(untold), pushes: pushes.map(untold)});

// The changes as a request has them, or none.
function changesOf(page, state) {
	const {changes, settings} = state;
	if (!changes.size && !settings.size && !isHandled(state)) return null;
	return {lesion: listOf(state), ...handsOf(state), config: settings.size ? configOf(page, state) : undefined};
}

// Updates the controls.
function tellControls(own, state, about) {
	const known = about.individuals[state.individual].trials;
	const told = list(about.trials, (i) => [i, known[i] ? `trial ${i}: ${earnedBy(known[i])}` : `trial ${i}`]);
	const {fresh} = state.trial;
	own.generation.replaceChildren(...options(about.individuals.map(({generation, name}, i) => [i, `generation ${generation}${name ?? ""}`])));
	own.generation.hidden = !about.individuals[1];
	own.trial.replaceChildren(...options(fresh ? [["", `fresh start ${fresh.number}`], ...told] : told));
	own.trial.value = fresh ? "" : state.trial.number;
	own.generation.value = state.individual;
	own.verify.disabled = !!fresh || !known.length || state.watched !== null;
	own.undo.disabled = !state.changes.size && !state.settings.size && !isHandled(state);
}

// Names the agent, the trial and the changes in the address, but no moved or pushed bodies.
function addressed(player, state, about, change) {
	const last = about.individuals.length - 1;
	const keyOf = ({individual, trial, changes, settings}) => JSON.stringify([individual, trial, [...changes], [...settings]]);
	Object.defineProperty(player, "address", {get() {
		const {individual: agent, trial: {fresh, number}} = state;
		return {...agent === last ? {} : {agent}, trial: fresh ? `fresh-${fresh.number}` : number, ...state.changes.size ? {change: listOf(state)} : {}, ...state.settings.size ? {set: [...state.settings].map((pair) => pair.join("=")).join(";")} : {}};
	}});
	player.choose = async (moment) => {
		const held = heldBy(moment, about, last);
		if (held && keyOf(held) !== keyOf(state)) await change(held);
		return !!held;
	};
}

// Summarizes fresh trials, with the changes if there are any.
async function behaviorOf(count, page, state, own, change) {
	const {about} = page.live;
	own.behavior.disabled = true;
	const request = {individual: state.individual, watched: state.watched, ...changesOf(page, state) ?? {lesion: ""}};
	// A mark opens a trial of this summary, also after other changes.
	const kept = {...state};
	const open = (number) => change({...kept, trial: {fresh: {number, seed: 1}}});
	const {generation, name = ""} = about.individuals[state.individual];
	const whose = about.individuals[1] ? `Generation ${generation}${name}. ` : "";
	const found = await summarized(count, request, whose, own.summary, open).catch((error) => own.summary.replaceChildren(error.message));
	own.behavior.disabled = false;
	return found;
}

// Runs fresh trials with the changes and without.
async function testOf(page, state, own, counted) {
	const tell = (text) => (own.earned.textContent = text);
	own.hundred.disabled = true;
	const found = await hundred(state.individual, changesOf(page, state), counted, tell).catch((error) => tell(error.message));
	own.hundred.disabled = false;
	return found;
}

// Returns a function that draws individuals. Each is the first of the run with another seed.
function drawing({config}) {
	const [own, withSeed] = seedOf(config);
	let seed = 0;
	return async () => {
		seed += 1 + (seed + 1 === own);
		const name = `, random of seed ${seed}`;
		const script = {config: withSeed(seed), individuals: [], newcomer: true};
		return [await firstWorker("once", {script, request: {do: "individual", individual: 0}}), name];
	};
}

// Adds individuals, with a name for each. Returns the place of the first.
async function included({individuals}, more, names, origin) {
	const place = individuals.length;
	for (const [i, individual] of more.entries()) {
		await answerOf({do: "add", individual});
		individuals.push({generation: individual.generation, individual: individual.individual, trials: [], name: names[i], origin});
	}
	return place;
}

// Runs a trial without changes, and with them if there are any.
async function runBoth(state, changes) {
	const {settings} = state;
	const intact = await answerOf({do: "film", ...asked(state), lesion: ""});
	const changed = changes && await answerOf({do: "film", ...asked(state), ...changes});
	if (settings.size) changed.film.name += `; with ${[...settings].map((pair) => pair.join(" = ")).join(", ")}`;
	return [intact, changed];
}

// Returns a function that is true while a new champion replaces nothing that was changed, chosen, or used in the last five seconds.
function idleOf(page, state) {
	let used = -5000;
	for (const kind of ["pointerdown", "pointermove", "keydown", "wheel"]) addEventListener(kind, () => (used = performance.now()), true);
	return () => performance.now() - used > 5000 && state.individual === state.newest && !changesOf(page, state)
		&& !document.querySelector(".setting.changed, #groups :focus, #settings :focus, #node :checked:nth-child(n + 2)");
}

// Attaches the panel. Returns a function that shows the whole trial.
function attach(page, state, whole, player, open) {
	const {about} = page.live;
	const counted = new Map();
	let answer, turn = 0, chosen = "";
	const set = (name, to) => {
		const before = {...state};
		state.changes = new Map(before.changes).set(name, to);
		return show(before);
	};
	const change = (what, steady) => {
		// A count of successes belongs to one agent.
		if (what.individual >= 0) own.earned.textContent = "";
		assign(state, what);
		return show(undefined, steady);
	};
	// A part that cannot be changed so is not changed.
	const settle = (changed) => {
		const [before, unknown] = [{...state}, [...changed.keys()].find((key) => !settings.some((setting) => setting.key === key))];
		if (unknown) return say(`There is no setting ${unknown}.`);
		state.settings = changed;
		return show(before);
	};
	const undo = () => (assign(state, {changes: new Map(), settings: new Map(), moves: [], pushes: []}), show());
	const fresh = () => change({trial: {fresh: {number: (state.trial.fresh?.number ?? -1) + 1, seed: 1}}});
	const test = () => testOf(page, state, own, counted);
	const {script} = page.live, draw = drawing(script), settings = settingsOf(script.config);
	const form = settingsForm(settings, settle);
	const own = controlsOf(page, {form, random: () => random(), set, change, undo, fresh, choose, test, summarize: (count) => summarize(count), verify, alter: (to) => chosen && set(chosen, to)});
	const say = (text) => (own.status.textContent = text);
	const summarize = (count) => behaviorOf(count, page, state, own, change);

	function choose(name) {
		chosen = name;
		own.part.textContent = name || "a node or link of the network";
		for (const one of ["apply", "cut", "value"]) own[one].disabled = !name;
	}

	function marks() {
		tellControls(own, state, about);
		own.chips.replaceChildren(...chipsOf(state, show));
		own.configuration.textContent = configOf(page, state);
	}

	// Runs the trial intact and with changes, on one clock.
	async function show(before = {...state}, steady = false) {
		const mine = ++turn, changes = changesOf(page, state), {pushes, settings: given} = state;
		marks();
		say("runs ...");
		try {
			const [intact, changed] = await runBoth(state, changes);
			if (mine !== turn) return;
			form.take(given);
			answer = intact;
			page.trials.splice(0, 2, ...[intact, changed].filter(Boolean).map((one, i) => trialOf(page, one, i, i ? pushes : [])));
			const {ended} = player;
			player.show(page.trials[0], page.trials[1], steady);
			if (steady && ended) player.replay();
			say(changed ? `With the change: ${earnedBy(changed)}.` : "");
		} catch (error) {
			// An invalid change is undone.
			assign(state, before);
			marks();
			say(error.message);
		}
	}

	// Shows the whole first trial, unless another one was chosen.
	async function begin() {
		say("runs ...");
		const found = answer = await whole();
		own.move.disabled = own.push.disabled = false;
		if (turn) return;
		page.trials[0] = trialOf(page, found, 0);
		player.show(page.trials[0]);
		say("");
	}

	// Compares the trial with that of the run.
	async function verify() {
		await whole();
		return say(verdictOf(state.trial, about.individuals[state.individual], answer));
	}

	// Shows the first of further individuals, with a name for each.
	const showMore = async (more, names, origin) => change({individual: state.newest = await included(about, more, names, origin)}, true);
	const random = () => draw().then(async ([individual, name]) => change({individual: await included(about, [individual], [name], "random")}), (error) => say(error.message));

	addressed(player, state, about, change);
	const {put, push} = movable(page, player, state, own, show, say);

	graphChosen = (node) => node && choose(partOf(node));
	answerOf({do: "names"}).then((kinds) => offerParts(own, kinds), (error) => say(error.message));
	choose("");
	marks();
	const {run, rows, mark} = evolutionOf(page, open, showMore, idleOf(page, state));
	const kept = keeping(page, state, about, mark, say, form.element);
	farsa.live = {evolve: run, rows, put: (move) => put(move, page.trials[0]), push: (force) => push(force, page.trials[0]), set, undo, start: (trial) => change({trial}), settle: (some) => settle(new Map(entries(some))), random, keep: kept.act, test, summarize, verify};
	return begin;
}
