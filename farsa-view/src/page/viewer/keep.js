// What the page has evolved or changed is saved as a file, or in the folder of the laboratory that shows the page.

let [keeper, keeperSays] = [null, () => {}];
window.addEventListener("message", ({source, data}) => {
	if (source === window || source !== window.parent) return;
	if (data?.farsa === "laboratory") keeper = source;
	else if (data?.farsa === "kept") keeperSays(String(data.text));
});

// Passes a text on. Only names and texts leave the page.
function keep(kind, name, text) {
	if (keeper) keeper.postMessage({farsa: "keep", kind, name, text}, "*");
	else save(name, new Blob([text], {type: "text/plain"}));
	return keeper ? "" : `${name} was saved.`;
}

const quotedWord = (word) => `'${word.replaceAll("'", "'\\''")}'`;

// The commands that repeat a trial. `genes` are needed where settings are changed.
function commandsOf({title, live: {script}}, {individual, trial, settings, moves, pushes, changes}, {individuals}, genes) {
	const {generation, individual: number, origin} = individuals[individual];
	const lesion = changes.size ? ` --lesion ${quotedWord(listOf({changes}))}` : "";
	const hands = moves.length + pushes.length;
	const lines = ["#!/bin/sh", "# Repeats a trial of a page. The argument is the directory of its run.", "set -eu", `run=\${1:-${quotedWord(`runs/${title}`)}}`];
	if (hands) lines.push(`# ${hands} bodies were moved or pushed by hand, which no command repeats.`);
	if (settings.size || origin === "random") {
		const [, experiment] = /^experiment = "(.*)"$/m.exec(script.config) ?? [];
		const [, condition] = /^condition = "(.*)"$/m.exec(script.config) ?? [];
		const file = /^definition = /m.test(script.config) ? ".toml" : "";
		const sets = [...settings].map(([key, value]) => ` --set ${quotedWord(`${key}=${value}`)}`).join("");
		lines.push("cat >genes.gen <<'GENES'", genes.trimEnd(), "GENES");
		lines.push(`farsa evaluate ${quotedWord(`${experiment}${file}`)}${condition ? ` --condition ${quotedWord(condition)}` : ""}${sets} --genes-file genes.gen --trials 100`);
		return `${lines.join("\n")}\n`;
	}
	if (origin === "evolved") lines.push(`farsa run --resume "$run" --generations ${generation + 1}`);
	const which = `--generation ${generation} --individual ${number}`;
	if (trial.fresh) lines.push("# The trial is the last of these.", `farsa test "$run" ${which} --seed ${trial.fresh.seed} --trials ${trial.fresh.number + 1}`);
	else lines.push(`farsa replay "$run" ${which} --trial ${trial.number}${lesion} --html trial.html`);
	return `${lines.join("\n")}\n`;
}

const KEPT = [["genotype", "genes of this individual"], ["configuration", "configuration with the changes"], ["script", "commands that repeat the trial"], ["run", "run with its new generations"]];

// The choice of what is saved. `evolved` identifies the state of the evolution, where there is one.
function keeping(page, state, about, evolved, say) {
	const {title, live: {script}} = page;
	const what = pick("What is saved", KEPT.filter(([kind]) => kind !== "run" || evolved), () => {});
	const genes = async () => (await answerOf({do: "genotype", individual: state.individual})).text;
	const texts = {
		async genotype() {
			return [`${title}-${about.individuals[state.individual].generation}-${about.individuals[state.individual].individual}.gen`, await genes()];
		},
		configuration: () => [`${title}.changed.toml`, configOf(page, state)],
		async script() {
			return [`${title}.trial.sh`, commandsOf(page, state, about, state.settings.size || about.individuals[state.individual].origin === "random" ? await genes() : "")];
		},
		async run() {
			const mark = await evolved();
			return [`${title}-${mark.generation}.run.json`, JSON.stringify({format: "farsa-saved-run", version: 1, ...mark, config: script.config})];
		},
	};
	keeperSays = say;
	async function act(kind) {
		try {
			const [name, text] = await texts[kind]();
			say(keep(kind, name, text));
			return {name, text};
		} catch (error) {
			say(error.message);
			return null;
		}
	}
	const one = Object.assign(button("Save", () => act(what.value)), {id: "keep"});
	return {element: make("div", "bar", what, one), act};
}
