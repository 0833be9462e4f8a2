// The behavior in fresh trials: the time in each phase, and success by start.

// Colors of success, failure, and of trials without a criterion.
const SHOWN = {true: "#009e73", false: "#d55e00", null: "#0072b2"};

function drawn(tag, attributes, ...children) {
	const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
	for (const [name, value] of entries(attributes)) made.setAttribute(name, value);
	made.append(...children);
	return made;
}

const meanOf = (values) => values.reduce((sum, value) => sum + value, 0)/values.length;

// Mean time in each phase, and the number of trials that reach it.
function phasesOf(trials) {
	const {words = []} = trials[0];
	return words.map((word, i) => {
		const times = trials.map(({counts, step}) => counts[i]*step);
		return {word, seconds: meanOf(times), reached: times.filter((time) => time > 0).length};
	});
}

function phaseTable(phases, count) {
	const longest = max(...phases.map(({seconds}) => seconds)) || 1;
	const rows = phases.map(({word, seconds, reached}, i) => {
		const bar = make("i", "bar");
		bar.style.cssText = `width:${100*seconds/longest}%;background:${WORDS[i%WORDS.length]}`;
		return make("tr", "", make("td", "", word), make("td", "wide", bar), make("td", "", `${seconds.toFixed(2)} s`), make("td", "", `${reached} of ${count}`));
	});
	return make("table", "phases", rowOf("soft", "phase", "", "mean time", "reached"), ...rows);
}

// The first of the bodies whose starts differ most between trials, and the two axes along which it does, or null.
function startsOf(trials) {
	const spans = trials[0].bodies.map((_, body) => {
		const at = trials.map(({starts}) => starts[body]);
		return [0, 1, 2].map((i) => max(...at.map((p) => p[i])) - min(...at.map((p) => p[i])));
	});
	const far = spans.map((span) => hypot(...span));
	const body = far.findIndex((span) => span >= 0.5*max(...far));
	if (!(far[body] > 1e-3)) return null;
	const axes = [0, 1, 2].sort((a, b) => spans[body][b] - spans[body][a]).slice(0, 2).sort();
	return {body, axes, places: trials.map(({starts}) => axes.map((i) => starts[body][i]))};
}

// The starts as a map: circles for success, crosses for failure. A click opens the trial.
function startMap(trials, {body, axes, places}, open) {
	const ends = [0, 1].map((k) => [min(...places.map((p) => p[k])), max(...places.map((p) => p[k]))]);
	const scale = 200/max(...ends.map(([low, high]) => high - low));
	const [wide, tall] = ends.map(([low, high]) => (high - low)*scale + 24);
	const marks = trials.map(({number, success}, i) => {
		const [x, y] = [12 + (places[i][0] - ends[0][0])*scale, tall - 12 - (places[i][1] - ends[1][0])*scale];
		const line = success === false ? "M-4-4l8 8m0-8l-8 8" : "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z";
		const mark = drawn("path", {d: line, transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`, stroke: SHOWN[success], fill: success ? SHOWN[success] : "none"});
		mark.append(drawn("title", {}, `fresh trial ${number}${success === null ? "" : success ? ": success" : ": no success"}`));
		mark.onclick = () => open(number);
		return mark;
	});
	const svg = drawn("svg", {viewBox: `0 0 ${wide.toFixed(0)} ${tall.toFixed(0)}`, role: "img", "aria-label": "Success by start"}, ...marks);
	const along = axes.map((axis, k) => `${"xyz"[axis]} ${ends[k].map((end) => +end.toFixed(3)).join(" to ")} m`);
	return [make("p", "soft", `Start of ${trials[0].bodies[body]}: ${along.join(", ")}. ${trials[0].success === null ? "" : "Circles succeed, crosses do not. "}A click opens the trial.`), svg];
}

// Runs fresh trials, with the changes if there are any, and shows their summary in `place`.
async function summarized(count, request, whose, place, open) {
	const trials = [];
	for (let number = 0; number < count; number++) {
		const found = await answerOf({do: "film", ...request, trial: {fresh: {number, seed: 1}}}, "brief");
		trials.push({number, ...found});
		place.replaceChildren(make("p", "soft", `${number + 1} of ${count} trials ...`));
	}
	const successes = trials.filter(({success}) => success).length;
	const finished = trials.filter(({fitness}) => fitness !== null);
	const mean = meanOf(finished.map(({fitness}) => fitness));
	const share = trials[0].success === null ? "no criterion of success" : `success in ${successes} of ${count} fresh trials`;
	const failed = count - finished.length;
	const text = failed === count ? `all ${count} fresh trials broke down` : `${share}, mean fitness ${shortest(mean)}${failed ? `, ${failed} broke down` : ""}`;
	const [phases, starts] = [phasesOf(trials), startsOf(trials)];
	place.replaceChildren(
		make("p", "", `${whose}${request.lesion || request.moves ? "With the change" : "Intact"}: ${text}.`),
		...phases[0] ? [phaseTable(phases, count)] : [],
		...starts ? startMap(trials, starts, open) : [make("p", "soft", "All trials start alike.")],
	);
	return {successes, phases, trials};
}
