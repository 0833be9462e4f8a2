// An agent that lives in the page: its trials are run by a module of WebAssembly in a worker, whole and with changes.

// What the worker does. It is handed over as text and knows nothing of this file.
function inWorker() {
	let own;
	const said = (length) => new TextDecoder().decode(new Uint8Array(own.memory.buffer, own.output(), length));
	const give = (text) => {
		const bytes = new TextEncoder().encode(text);
		const at = own.input(bytes.length);
		new Uint8Array(own.memory.buffer, at, bytes.length).set(bytes);
	};
	const acts = {
		async open({module, script}) {
			own = (await WebAssembly.instantiate(module)).exports;
			give(script);
			const wrong = said(own.open());
			if (wrong) throw new Error(wrong);
		},
		ask({request}) {
			give(JSON.stringify(request));
			return JSON.parse(said(own.answer()));
		},
	};
	onmessage = async ({data: {id, act, ...rest}}) => {
		try {
			postMessage({id, found: await acts[act](rest)});
		} catch (error) {
			postMessage({id, error: error.message});
		}
	};
}

// What is packed in the page, by `read` of a response.
function unpacked({gzip, bytes}, read) {
	const words = new DataView(new ArrayBuffer(4*ceil(gzip.length/5)));
	for (let at = 0; at < gzip.length; at += 5) {
		// Letters from `(` on; two of them stand for those that JSON and HTML would write longer.
		const word = list(5, (k) => gzip.charCodeAt(at + k)).reduce((word, c) => 85*word + (c === 125 ? 60 : c === 126 ? 92 : c) - 40, 0);
		words.setUint32(at/5*4, word);
	}
	const stream = new Blob([words.buffer.slice(0, bytes)]).stream().pipeThrough(new DecompressionStream("gzip"));
	return new Response(stream)[read]();
}

// An agent in a worker of its own; `ask` is answered in the order of asking.
async function agentOf(module, script) {
	const worker = new Worker(URL.createObjectURL(new Blob([`"use strict";(${inWorker})()`], {type: "text/javascript"})));
	const waiting = new Map();
	worker.onmessage = ({data: {id, found, error}}) => {
		const [done, failed] = waiting.get(id);
		waiting.delete(id);
		const wrong = error || found?.error;
		if (wrong) failed(new Error(wrong));
		else done(found);
	};
	let next = 0;
	const send = (act, rest) => new Promise((done, failed) => {
		waiting.set(next, [done, failed]);
		worker.postMessage({id: next++, act, ...rest});
	});
	await send("open", {module, script: JSON.stringify(script)});
	return {ask: (request) => send("ask", {request})};
}

// The trial of an answer, ready for the player.
function trialOf(page, {film}, index, pushes = []) {
	const trial = Object.assign(new Trial(film, index), {pushes, changed: index > 0});
	survey(trial, page.view === "top");
	return trial;
}

// Fills a live page with the first trial that it runs; what it gives is then attached to the player.
async function liveOf(page) {
	need(window.WebAssembly && window.Worker && window.DecompressionStream, "this browser has no WebAssembly");
	// A function that returns a vector.
	const vectors = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];
	need(WebAssembly.validate(new Uint8Array(vectors)), "this browser's WebAssembly has no SIMD, as all have since 2023");
	const {live} = page;
	const module = await WebAssembly.compile(await unpacked(live.module, "arrayBuffer"));
	const agent = await agentOf(module, live.script);
	const open = (standing) => agentOf(module, {...live.script, standing});
	// The trial of the run that earned most comes first.
	const told = live.about.individuals.at(-1).trials;
	const best = told.reduce((best, trial, i) => (trial.fitness > told[best].fitness ? i : best), 0);
	const state = {individual: live.about.individuals.length - 1, trial: {number: best}, changes: new Map(), moves: [], pushes: [], watched: null};
	const answer = await agent.ask({do: "film", ...asked(state), lesion: ""});
	page.trials = [trialOf(page, answer, 0)];
	return {attach: (player) => attach(page, agent, state, answer, player, open)};
}

const asked = ({individual, trial, watched}) => ({individual, trial, watched});
// As `farsa test --lesion` takes it.
const listOf = ({changes}) => [...changes].map(([part, value]) => (value === "" ? part : `${part}=${value}`)).join(",");
const bare = (title) => title.replace(/ \[[^\]]*\]$/, "");
const KINDS = ["sensor", "neuron", "output"];

// What a node or link of the drawing is called in a list of changes.
function partOf(chosen) {
	const name = ({layer, name}) => `${KINDS[layer]} ${bare(name)}`;
	return chosen.links ? `${KINDS[chosen.layer]}:${bare(chosen.name)}` : `link:${name(chosen.from)}-${name(chosen.to)}`;
}

// What the page compares its own trial with: where it first differs from the run's, in words.
function compared({digests}, {stride, digests: run}) {
	const own = digests.filter((_, t) => (t + 1)%stride === 0 || t === digests.length - 1);
	const at = run.findIndex((digest, i) => digest !== own[i]);
	if (at < 0 && own.length === run.length) return `Equal to the run, bit by bit: ${digests.length} ticks, digest ${digests.at(-1).toString(16).padStart(8, "0")}`;
	return `Differs from the run at tick ${max(0, (at < 0 ? run.length : at)*stride)} or within ${stride} after it`;
}

const NONE = "a node or link of the network";
const button = (text, act = null) => Object.assign(make("button", "", text), {onclick: act});
const earnedBy = ({fitness, success}) => `${success ? "success" : "no success"}, ${fitness === null ? "failed" : +fitness.toPrecision(4)}`;

function pick(label, some, act) {
	const list = make("select");
	list.setAttribute("aria-label", label);
	list.replaceChildren(...options(some));
	list.onchange = () => act(list.value);
	return list;
}

// The panel with its controls; `acts` are what they do.
function controlsOf({live: {script}}, acts) {
	const value = Object.assign(make("input"), {type: "number", step: "any", placeholder: "value"});
	value.setAttribute("aria-label", "Value");
	const own = {
		generation: pick("Generation", [], (place) => acts.change({individual: +place})),
		trial: pick("Trial that is run", [], (number) => number !== "" && acts.change({trial: {number: +number}})),
		robot: pick("Robot that is recorded", [], (robot) => acts.change({watched: robot === "" ? null : +robot})),
		fresh: button("New start", acts.fresh), value, part: make("b", "", NONE), parts: pick("Part", [["", "part ..."]], acts.choose),
		apply: button("Change", () => acts.alter(value.value)), cut: button("Silence or cut", () => acts.alter("")),
		noise: button("Noise 0.1", () => acts.set("noise:0.1", "")), undo: button("Undo all", acts.undo),
		move: button("Move bodies"), push: button("Push bodies"),
		chips: make("p", "chips"), hundred: button("100 fresh trials", acts.test), verify: button("Verify", acts.verify),
		earned: make("p"), status: make("p", "soft"),
	};
	const bar = (...names) => make("div", "bar", ...names.map((name) => own[name]));
	const panel = make("section", "", make("h2", "", "Live"), bar("generation", "trial", "robot", "fresh"), make("p", "", "Change: ", own.part),
		bar("parts", "value", "apply", "cut"), bar("noise", "move", "push", "undo"), own.chips, bar("hundred", "verify"), own.earned, own.status,
		make("details", "", make("summary", "", "Configuration"), make("pre", "", script.config)));
	panel.id = "live";
	$("network").before(panel);
	return own;
}

// How many of a hundred fresh trials succeed with each list of changes, ten at a time; `counted` keeps what is known.
async function hundred(agent, individual, lists, counted, say) {
	const [text, keyOf] = [[], (list) => `${individual} ${list}`];
	for (const lesion of lists) {
		const [key, whose] = [keyOf(lesion), lesion ? "with the change" : "whole"];
		for (let [first, successes] = [0, 0]; !counted.has(key); first += 10) {
			successes += (await agent.ask({do: "fresh", individual, lesion, seed: 1, first, count: 10})).successes;
			say([...text, `${whose}: ${successes} of ${first + 10} ...`].join("; "));
			if (first === 90) counted.set(key, successes);
		}
		text.push(`${whose}: ${counted.get(key)} of 100`);
	}
	say(text.join("; "));
	return lists.map((list) => counted.get(keyOf(list)));
}

// The parts of a controller; of what has none nothing can be changed.
function offerParts(own, kinds) {
	const some = kinds.filter(({kind}) => kind !== "link").flatMap(({kind, names}) => names.map((name) => [`${kind}:${name}`, `${kind} ${name}`]));
	own.parts.replaceChildren(...options([["", "part ..."], ...some]));
	for (const one of [own.parts, own.apply, own.cut, own.noise, own.value, own.part.parentNode]) one.hidden = !kinds.length;
}

// What is changed, each to be taken back.
function chipsOf(state, show) {
	const lesions = [...state.changes].map(([name, to]) => button(`${name}${to === "" ? "" : ` = ${to}`} ×`, () => (state.changes.delete(name), show())));
	const hands = ["moves", "pushes"].flatMap((kind) => state[kind].map((one) => button(`${one.what} at ${one.time.toFixed(2)} s ×`, () => (state[kind] = state[kind].filter((other) => other !== one), show()))));
	return [...lesions, ...hands];
}

// Gives a live page its panel.
function attach(page, agent, state, first, player, open) {
	const {about} = page.live;
	const counted = new Map();
	let [answer, turn, chosen] = [first, 0, ""];
	const set = (name, to) => {
		const before = {...state};
		state.changes = new Map(before.changes).set(name, to);
		return show(before);
	};
	const change = (what) => (Object.assign(state, what), show());
	const undo = () => (state.changes.clear(), (state.moves = []), (state.pushes = []), show());
	const fresh = () => change({trial: {fresh: {number: (state.trial.fresh?.number ?? -1) + 1, seed: 1}}});
	const own = controlsOf(page, {set, change, undo, fresh, choose, test, verify, alter: (to) => chosen && set(chosen, to)});
	const say = (text) => (own.status.textContent = text);

	function choose(name) {
		chosen = name;
		own.part.textContent = name || NONE;
		for (const one of ["apply", "cut", "value"]) own[one].disabled = !name;
	}

	// The controls say what is chosen.
	function marks() {
		const known = about.individuals[state.individual].trials;
		const told = list(about.trials, (i) => [i, known[i] ? `trial ${i}: ${earnedBy(known[i])}` : `trial ${i}`]);
		const {fresh} = state.trial;
		own.generation.replaceChildren(...options(about.individuals.map(({generation, name}, i) => [i, `generation ${generation}${name ?? ""}`])));
		own.generation.hidden = !about.individuals[1];
		own.trial.replaceChildren(...options(fresh ? [["", `fresh start ${fresh.number}`], ...told] : told));
		own.trial.value = fresh ? "" : state.trial.number;
		own.generation.value = state.individual;
		own.verify.disabled = !!fresh || !known.length || state.watched !== null;
		own.undo.disabled = !state.changes.size && !state.moves[0] && !state.pushes[0];
		own.chips.replaceChildren(...chipsOf(state, show));
	}

	// Runs the trial as it is, and with the changes beside it on one clock.
	async function show(before = {...state}) {
		const [mine, list] = [++turn, listOf(state)];
		const moves = state.moves.map(({step, body, position, rotation}) => ({step, body, position, rotation}));
		const pushes = state.pushes.map(({steps, body, point, force}) => ({steps, body, point, force}));
		marks();
		say("runs ...");
		try {
			const intact = await agent.ask({do: "film", ...asked(state), lesion: ""});
			const changed = (list || moves[0] || pushes[0]) && await agent.ask({do: "film", ...asked(state), lesion: list, moves, pushes});
			if (mine !== turn) return;
			answer = intact;
			page.trials.splice(0, 2, ...[intact, changed].filter(Boolean).map((one, i) => trialOf(page, one, i, i ? pushes : [])));
			player.show(page.trials[0], page.trials[1]);
			player.ask();
			say(changed ? `With the change: ${earnedBy(changed)}.` : "");
		} catch (error) {
			// A change that is none is taken back.
			Object.assign(state, before);
			marks();
			say(error.message);
		}
	}

	// Fresh trials with the changes and without.
	async function test() {
		own.hundred.disabled = true;
		const lists = ["", listOf(state)].filter((list, i) => !i || list);
		const found = await hundred(agent, state.individual, lists, counted, (text) => (own.earned.textContent = text));
		own.hundred.disabled = false;
		return found;
	}

	// Whether the trial is that of the run.
	async function verify() {
		const {fresh, number} = state.trial;
		const told = about.individuals[state.individual].trials[number];
		const found = fresh ? "A fresh start is no trial of the run" : told ? compared(answer, told) : "The run has no trial of whom this page has evolved";
		say(found);
		return found;
	}

	// Shows the first of individuals that are not of the page, with a name for each.
	async function showMore(more, names) {
		const place = about.individuals.length;
		for (const [i, individual] of more.entries()) {
			await agent.ask({do: "add", individual});
			about.individuals.push({generation: individual.generation, trials: [], name: names[i]});
		}
		return change({individual: place, trial: {number: state.trial.number ?? 0}});
	}

	own.robot.replaceChildren(...options([["", "robot ..."], ...about.robots.map((name, i) => [i, name])]));
	own.robot.hidden = !about.robots[1];
	const {put, push} = movable(page, player, state, own, show, say);

	graphChosen = (node) => node && choose(partOf(node));
	agent.ask({do: "names"}).then((kinds) => offerParts(own, kinds), (error) => say(error.message));
	choose("");
	marks();
	const {run, rows} = evolutionOf(page, open, showMore);
	farsa.live = {evolve: run, rows, put: (move) => put(move, page.trials[0]), push: (force) => push(force, page.trials[0]), set, undo, start: (trial) => change({trial}), test, verify};
}
