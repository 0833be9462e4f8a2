// What the page has evolved or changed is saved as a file, or in the folder of the laboratory that shows the page.

let keeper, keeperSays = () => {};
addEventListener("message", ({source, data}) => {
	if (source === window || source !== parent) return;
	if (data?.farsa === "laboratory") keeper = source;
	else if (data?.farsa === "kept") keeperSays(String(data.text));
});

// Passes a text on. The laboratory chooses the name of its file.
function keep(kind, name, text) {
	if (keeper) keeper.postMessage({farsa: "keep", kind, text}, "*");
	else save(name, new Blob([text], {type: "text/plain"}));
	return keeper ? "" : `${name} was saved.`;
}

const quotedWord = (word) => `'${word.replaceAll("'", "'\\''")}'`;

// The command that repeats a trial of the run. Throws where there is none.
function commandOf(state, {individuals}) {
	const {trial, settings, changes} = state;
	const {generation, individual: number, origin} = individuals[state.individual];
	const why = origin === "random" ? "of a random genome: save its genes" : origin ? "that was evolved here: save the run first"
		: settings.size ? "with other settings: save the configuration and the genes" : trial.fresh ? "from a fresh start alone" : "";
	if (why) throw new Error(`No command repeats a trial ${why}.`);
	const lesion = changes.size ? ` --lesion ${quotedWord(listOf(state))}` : "";
	const hands = isHandled(state) && JSON.stringify(handsOf(state));
	return `#!/bin/sh
# Repeats a trial of a page. The argument is the directory of its run.
farsa replay "\${1:?the directory of the run}" --generation ${generation} --individual ${number} --trial ${trial.number}${lesion}${hands ? " --changes /dev/stdin" : ""} --html trial.html${hands ? ` <<END
${hands}
END` : ""}
`;
}

const KEPT = [["genotype", "genes of this individual"], ["configuration", "configuration with the changes"], ["script", "command that repeats the trial"], ["run", "run with its new generations"]];

// The choice of what is saved, before an element. `evolved` identifies the state of the evolution, where there is one.
function keeping(page, state, about, evolved, say, next) {
	const {title, live: {script}} = page;
	const what = pick("What is saved", KEPT.filter(([kind]) => kind !== "run" || evolved), () => {});
	const texts = {
		async genotype() {
			const {generation, individual} = about.individuals[state.individual];
			return [`${title}-${generation}-${individual}.gen`, (await answerOf({do: "genotype", individual: state.individual})).text];
		},
		configuration() {
			if (isHandled(state)) throw new Error("A configuration cannot move or push bodies: save the command.");
			return [`${title}.changed.toml`, configOf(page, state)];
		},
		script: () => [`${title}.trial.sh`, commandOf(state, about)],
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
	next.before(make("div", "bar", what, assign(button("Save", () => act(what.value)), {id: "keep"})));
	return {act};
}
