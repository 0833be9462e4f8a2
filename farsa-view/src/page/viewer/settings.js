// The settings of the run as a form. Trials are run again with changed ones.

// The settings in the text of a configuration, each with the number of its line. Those of a strategy change no trial.
function settingsOf(config) {
	const found = [];
	let section = "", about = "", inDefinition;
	config.split("\n").forEach((line, at) => {
		const [, name, value] = /^([\w-]+) = (.*)$/.exec(line) ?? [];
		if (inDefinition) inDefinition = !line.endsWith("'''");
		else if (value === "'''") inDefinition = true;
		else if (line.startsWith("# ")) about = line.slice(2);
		else if (line.startsWith("[")) section = line.slice(1, -1);
		else if (name && section && !/^(evolution|strategy)\b/.test(section)) {
			const [, doc, allowed] = /^(.*) \[(.*)\]$/.exec(about) ?? [null, about, ""];
			found.push({key: `${section}.${name}`, section, name, value, at, doc, allowed});
		}
	});
	return found;
}

// A configuration with other values of some settings.
function configWith(config, settings, changed) {
	const lines = config.split("\n");
	for (const {key, name, at} of settings) if (changed.has(key)) lines[at] = `${name} = ${changed.get(key)}`;
	return lines.join("\n");
}

// The seed of a configuration, and a function that gives the configuration with another one. It follows a definition and precedes
// the sections.
function seedOf(config) {
	const [before, seed, after] = /^([\s\S]*?\nseed = )(\d+)(\n\n\[[\s\S]*)$/.exec(config)?.slice(1) ?? [];
	return [+seed, (other) => before + other + after];
}

// The row of a setting. A press of Enter applies all.
function settingRow({key, name, value, doc, allowed}, apply) {
	const field = allowed.startsWith("true or false") ? pick(key, [["true", "true"], ["false", "false"]], () => {}) : entitled(make("input"), key);
	field.value = value;
	field.spellcheck = false;
	const row = make("label", "setting", make("span", "", name), field, make("small", "soft", `${doc} [${allowed}]`));
	const mark = () => row.classList.toggle("changed", field.value.trim() !== value);
	// A handler that returns false would refuse the key.
	field.onkeydown = ({key}) => void (key === "Enter" && apply());
	field.addEventListener("input", mark);
	const set = (to) => ((field.value = to ?? value), mark());
	return {key, row, field, set, words: `${key} ${doc}`.toLowerCase(), given: () => field.value.trim(), value};
}

// The form. `act` receives the changed settings by their keys.
function settingsForm(settings, act) {
	const rows = settings.map((setting) => settingRow(setting, () => apply()));
	const given = () => new Map(rows.filter((one) => one.given() !== one.value).map((one) => [one.key, one.given()]));
	const apply = () => act(given());
	const groups = [...new Set(settings.map(({section}) => section))].map((section) =>
		make("details", "group", make("summary", "", section), ...rows.filter((_, i) => settings[i].section === section).map(({row}) => row)));
	const search = entitled(assign(make("input"), {type: "search", placeholder: "gravity, friction, noise ..."}), "Search settings");
	search.oninput = () => {
		const words = search.value.toLowerCase().split(/\s+/);
		for (const {row, words: own} of rows) row.hidden = !words.every((word) => own.includes(word));
		for (const group of groups) {
			group.hidden = ![...group.children].some((one) => one.matches(".setting:not([hidden])"));
			group.open = !!search.value.trim();
		}
	};
	const element = make("details", "", make("summary", "", "Settings"), search, ...groups,
		make("div", "bar", assign(button("Run with these settings", apply), {id: "apply"}), button("Original settings", () => act(new Map()))));
	element.id = "settings";
	element.hidden = !rows[0];
	return {element, take: (changed) => rows.forEach(({key, set}) => set(changed.get(key)))};
}
