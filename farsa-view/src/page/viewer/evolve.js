// Evolution in the page. Workers share each generation, and all report the same outcomes to their strategies.

// The fitness of generations as two lines, as wide as the panel.
function paintFitness(svg, rows) {
	const known = rows.filter((row) => !row.includes(null));
	const [first, last] = [known[0]?.[0], known.at(-1)?.[0]];
	const values = known.flatMap((row) => row.slice(1));
	const [low, high] = [min(...values), max(...values)];
	const at = (row, of) => `${(300*(row[0] - first)/(last - first || 1)).toFixed(1)},${(58 - 56*(row[of] - low)/(high - low || 1)).toFixed(1)}`;
	svg.replaceChildren(...["best", "mean"].map((name, i) => drawn("polyline", {class: name, points: known.map((row) => at(row, i + 1)).join(" ")})));
	entitled(svg, known.length ? `Fitness of generations ${first} to ${last}, from ${shortest(low)} to ${shortest(high)}` : "No fitness yet");
}

const shortest = (x) => (x === null ? "failed" : `${+x.toPrecision(4)}`);

const unpackedState = (standing) => new Response(unpacked(standing)).json();

// Identifies the state after the last generation.
async function markOf(script, standing, workers) {
	if (workers) return workers[0].ask({do: "state"});
	return firstWorker("once", {script: {...script, standing: await unpackedState(standing)}, request: {do: "state"}});
}

// Passes events of a run to `heard`. A page without an origin is shown by a laboratory, which sends them.
function hear(run, rows, status, heard) {
	if (origin === "null") {
		addEventListener("message", ({source, data}) => source === parent && heard[data?.farsa]?.(data.data));
		return parent.postMessage({farsa: "follows"}, "*");
	}
	const events = new EventSource(`events?run=${run}&from=${rows.length ? rows.at(-1)[0] + 1 : 0}`);
	events.onopen = () => (status.textContent = "Connected to the run.");
	events.onerror = () => (status.textContent = "The server does not answer. The page retries.");
	for (const name in heard) events.addEventListener(name, ({data}) => heard[name](JSON.parse(data)));
	// The directory holds another run, which has its own page.
	events.addEventListener("replaced", () => (events.close(), location.reload()));
}

// The panel of evolution. `open` creates an agent with a state, `show` shows named individuals. `idle` returns true if a new champion
// may replace the shown one.
function evolutionOf({live: {about, script, standing, served}}, open, show, idle) {
	const rows = [...about.history];
	const svg = drawn("svg", {viewBox: "0 0 300 60", preserveAspectRatio: "none", role: "img"});
	const said = make("p"), status = make("p", "soft");
	let workers, going, latest, shown;
	const own = {go: button("Continue evolution", toggle), champion: button("Show champion", champion), follow: button("Follow", () => setPressed(own.follow, !isPressed(own.follow)))};
	own.champion.disabled = true;
	own.follow.hidden = !served;
	setPressed(own.follow, origin === "null");
	const panel = make("section", "", make("h2", "", "Evolution"), svg, said, make("div", "bar", own.go, own.champion, own.follow), status);
	panel.id = "evolution";
	$("network").before(panel);
	panel.hidden = !rows.length && !standing;
	own.go.hidden = served || !standing;
	if (served) {
		hear(about.run, rows, status, {fitness, champions});
		follow();
	}
	else if (about.standstill) status.textContent = `Evolution cannot continue here: ${about.standstill}.`;

	// The best of each population.
	function champion() {
		shown = latest;
		const names = about.populations.map((name) => `: ${name}`);
		return show(latest, latest.map((_, i) => `${served ? ", new" : ", evolved here"}${names[i] ?? ""}`), served ? "" : "evolved");
	}

	// Shows each new champion while the page is idle.
	async function follow() {
		if (latest !== shown && isPressed(own.follow) && idle()) await champion();
		setTimeout(follow, 2000);
	}

	function tell() {
		paintFitness(svg, rows);
		const [number, best, mean] = rows.at(-1) ?? [];
		if (!rows.length) return said.replaceChildren("No generation is finished.");
		said.replaceChildren(`Generation ${number}: `, make("b", "best", `best ${shortest(best)}`), ", ", make("b", "mean", `mean ${shortest(mean)}`));
	}

	// Runs a generation: each worker evaluates a part, and all receive all outcomes.
	async function generation() {
		if (!workers) {
			const from = await unpackedState(standing);
			workers = await Promise.all(list(max(1, min(8, navigator.hardwareConcurrency || 1)), () => open(from)));
		}
		const before = performance.now();
		const shares = await Promise.all(workers.map(({ask}, part) => ask({do: "share", part, parts: workers.length})));
		const outcomes = shares.map((share) => share.outcomes);
		const [bred] = await Promise.all(workers.map(({ask}) => ask({do: "tell", outcomes})));
		const {generation, line: {row}} = bred;
		rows.push([generation, row[0], row[1]]);
		latest = bred.champions;
		own.champion.disabled = false;
		tell();
		status.textContent = `${((performance.now() - before)/1000).toFixed(2)} s per generation with ${workers.length} workers`;
		return bred;
	}

	// Continues for a number of generations, or until it is stopped.
	async function run(count = Infinity) {
		const mine = going = {};
		own.go.textContent = "Stop";
		const all = [];
		try {
			while (going === mine && all.length < count) {
				all.push(await generation());
				// An endless evolution does not collect results.
				if (count === Infinity) all.length = 0;
			}
		} catch (error) {
			status.textContent = error.message;
		}
		if (going === mine) going = null;
		own.go.textContent = "Continue evolution";
		own.go.disabled = false;
		return all;
	}

	function fitness(more) {
		rows.push(...more.filter(([number]) => number > (rows.at(-1)?.[0] ?? -1)));
		tell();
	}

	function champions(some) {
		const [{generation, individual}] = latest = some;
		if (about.individuals.some((one) => one.generation === generation && one.individual === individual)) shown = some;
		own.champion.disabled = false;
	}

	function toggle() {
		if (!going) return run();
		going = null;
		own.go.disabled = true;
		own.go.textContent = "Stops after this generation";
	}

	tell();
	return {run, rows, mark: standing && !served ? () => markOf(script, standing, workers) : null};
}
