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
			const packed = Uint8Array.from(atob(module), (c) => c.charCodeAt(0));
			const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
			own = (await WebAssembly.instantiate(await new Response(stream).arrayBuffer())).instance.exports;
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

// The agent in its worker; `ask` is answered in the order of asking.
function agentOf({module, script}) {
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
	return {open: () => send("open", {module, script: JSON.stringify(script)}), ask: (request) => send("ask", {request})};
}

// The trial of an answer, ready for the player.
function trialOf(page, {film}, index) {
	const trial = new Trial(film, index);
	survey(trial, page.view === "top");
	return trial;
}

// Fills a live page with the first trial that it runs; what it gives is then attached to the player.
async function liveOf(page) {
	need(window.WebAssembly && window.Worker && window.DecompressionStream, "this browser has no WebAssembly");
	const {live} = page;
	const agent = agentOf(live);
	await agent.open();
	// The trial of the run that earned most comes first.
	const told = live.about.individuals.at(-1).trials;
	const best = told.reduce((best, trial, i) => (trial.fitness > told[best].fitness ? i : best), 0);
	const state = {individual: live.about.individuals.length - 1, trial: {number: best}, changes: new Map()};
	const answer = await agent.ask({do: "film", ...asked(state), lesion: ""});
	page.trials = [trialOf(page, answer, 0)];
	return {attach: (player) => attach(page, agent, state, answer, player)};
}

const asked = ({individual, trial}) => ({individual, trial});
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
const button = (text, act) => Object.assign(make("button", "", text), {onclick: act});
const earnedBy = ({fitness, success}) => `${success ? "success" : "no success"}, ${fitness === null ? "failed" : +fitness.toPrecision(4)}`;

function pick(label, some, act) {
	const list = make("select");
	list.setAttribute("aria-label", label);
	list.replaceChildren(...options(some));
	list.onchange = () => act(list.value);
	return list;
}

// The panel with its controls; `acts` are what they do.
function controlsOf({live: {about, script}}, acts) {
	const individuals = about.individuals.map(({generation}, i) => [i, `generation ${generation}`]);
	const value = Object.assign(make("input"), {type: "number", step: "any", placeholder: "value"});
	value.setAttribute("aria-label", "Value");
	const own = {
		generation: pick("Generation", individuals, (place) => acts.change({individual: +place})),
		trial: pick("Trial that is run", [], (number) => number !== "" && acts.change({trial: {number: +number}})),
		fresh: button("New start", acts.fresh), value, part: make("b", "", NONE), parts: pick("Part", [["", "part ..."]], acts.choose),
		apply: button("Change", () => acts.alter(value.value)), cut: button("Silence or cut", () => acts.alter("")),
		noise: button("Noise 0.1", () => acts.set("noise:0.1", "")), undo: button("Undo all", acts.undo),
		chips: make("p", "chips"), hundred: button("100 fresh trials", acts.test), verify: button("Verify", acts.verify),
		earned: make("p"), status: make("p", "soft"),
	};
	const bar = (...names) => make("div", "bar", ...names.map((name) => own[name]));
	const panel = make("section", "", make("h2", "", "Live"), bar("generation", "trial", "fresh"), make("p", "", "Change: ", own.part),
		bar("parts", "value", "apply", "cut"), bar("noise", "undo"), own.chips, bar("hundred", "verify"), own.earned, own.status,
		make("details", "", make("summary", "", "Configuration"), make("pre", "", script.config)));
	panel.id = "live";
	own.generation.hidden = !individuals[1];
	$("network").before(panel);
	return own;
}

// Gives a live page its panel.
function attach(page, agent, state, first, player) {
	const {about} = page.live;
	const counted = new Map();
	let [answer, turn, chosen] = [first, 0, ""];
	const set = (name, to) => {
		const before = state.changes;
		state.changes = new Map(before).set(name, to);
		return show(before);
	};
	const change = (what) => (Object.assign(state, what), show());
	const undo = () => (state.changes.clear(), show());
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
		const told = about.individuals[state.individual].trials.map((trial, i) => [i, `trial ${i}: ${earnedBy(trial)}`]);
		const {fresh} = state.trial;
		own.trial.replaceChildren(...options(fresh ? [["", `fresh start ${fresh.number}`], ...told] : told));
		own.trial.value = fresh ? "" : state.trial.number;
		own.generation.value = state.individual;
		own.verify.disabled = !!fresh;
		own.undo.disabled = !state.changes.size;
		own.chips.replaceChildren(...[...state.changes].map(([name, to]) => button(`${name}${to === "" ? "" : ` = ${to}`} ×`, () => (state.changes.delete(name), show()))));
	}

	// Runs the trial as it is, and with the changes beside it on one clock.
	async function show(before = state.changes) {
		const [mine, list] = [++turn, listOf(state)];
		marks();
		say("runs ...");
		try {
			const intact = await agent.ask({do: "film", ...asked(state), lesion: ""});
			const changed = list && await agent.ask({do: "film", ...asked(state), lesion: list});
			if (mine !== turn) return;
			answer = intact;
			page.trials.splice(0, 2, ...[intact, changed].filter(Boolean).map((one, i) => trialOf(page, one, i)));
			player.show(page.trials[0], page.trials[1]);
			player.ask();
			say(changed ? `With the change: ${earnedBy(changed)}.` : "");
		} catch (error) {
			// A change that is none is taken back.
			state.changes = before;
			marks();
			say(error.message);
		}
	}

	// Fresh trials with the changes and without, ten at a time.
	async function test() {
		const lists = ["", listOf(state)].filter((list, i) => !i || list);
		const keyOf = (list) => `${state.individual} ${list}`;
		own.hundred.disabled = true;
		const text = [];
		for (const list of lists) {
			const [key, whose] = [keyOf(list), list ? "with the change" : "whole"];
			for (let [first, successes] = [0, 0]; !counted.has(key); first += 10) {
				successes += (await agent.ask({do: "fresh", individual: state.individual, lesion: list, seed: 1, first, count: 10})).successes;
				own.earned.textContent = [...text, `${whose}: ${successes} of ${first + 10} ...`].join("; ");
				if (first === 90) counted.set(key, successes);
			}
			text.push(`${whose}: ${counted.get(key)} of 100`);
		}
		own.earned.textContent = text.join("; ");
		own.hundred.disabled = false;
		return lists.map((list) => counted.get(keyOf(list)));
	}

	// Whether the trial is that of the run.
	async function verify() {
		const {fresh, number} = state.trial;
		const found = fresh ? "A fresh start is no trial of the run" : compared(answer, about.individuals[state.individual].trials[number]);
		say(found);
		return found;
	}

	graphChosen = (node) => node && choose(partOf(node));
	agent.ask({do: "names"}).then((kinds) => {
		const some = kinds.filter(({kind}) => kind !== "link").flatMap(({kind, names}) => names.map((name) => [`${kind}:${name}`, `${kind} ${name}`]));
		own.parts.replaceChildren(...options([["", "part ..."], ...some]));
		// Of what has no controller nothing can be changed.
		for (const one of [own.parts, own.apply, own.cut, own.noise, own.undo, own.value, own.part.parentNode]) one.hidden = !kinds.length;
	}, (error) => say(error.message));
	choose("");
	marks();
	farsa.live = {set, undo, start: (trial) => change({trial}), test, verify};
}
